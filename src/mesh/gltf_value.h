// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "mesh/mesh_source.h"

namespace meshbound {

/// JSON that keeps the order of its keys, so that what is passed through stays as it was written.
using GltfJson = nlohmann::ordered_json;

/// A value in the JSON of a glTF file, with the path that leads to it for messages ("meshes[2].primitives[0].mode").
/// Members that read it throw `InvalidInput` where it is not of the kind they ask for. Refers to the file's JSON.
class GltfValue {
 public:
  GltfValue(const MeshSource& source, const GltfJson& json, std::string path = "");

  [[nodiscard]] const GltfJson& json() const { return json_; }
  /// The member of an object; nothing where there is none.
  [[nodiscard]] std::optional<GltfValue> find(const char* key) const;
  [[nodiscard]] GltfValue at(const char* key) const;
  /// The number of items of an array member; 0 where there is no such member.
  [[nodiscard]] std::size_t count(const char* key) const;
  [[nodiscard]] std::size_t size() const;  ///< of an array
  [[nodiscard]] GltfValue item(std::size_t i) const;

  [[nodiscard]] std::size_t integer() const;  ///< not negative, at most 2^53
  [[nodiscard]] std::size_t integer_or(const char* key, std::size_t otherwise) const;
  /// An integer below `count`; for messages, `what` says what is counted.
  [[nodiscard]] std::size_t index(std::size_t count, const char* what) const;
  [[nodiscard]] double number() const;  ///< finite
  [[nodiscard]] std::string text() const;
  [[nodiscard]] bool flag_or(const char* key, bool otherwise) const;

  [[noreturn]] void fail(const std::string& defect) const;

 private:
  const MeshSource* source_;
  const GltfJson& json_;
  std::string path_;
};

}  // namespace meshbound
