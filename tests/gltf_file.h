// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace meshbound::test {

using GltfJson = nlohmann::ordered_json;

/// A glTF file that a test puts together by hand. Buffer views and accessors are added in order, numbered from 0.
struct GltfFile {
  GltfJson json = {{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", {0}}}}}};
  std::string bytes;

  /// A buffer view with these values; `stride` 0 leaves the key out.
  template <class T>
  std::size_t add_view(const std::vector<T>& values, std::size_t stride = 0) {
    bytes.resize((bytes.size() + 3) / 4 * 4);
    GltfJson view = {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", values.size() * sizeof(T)}};
    if (stride != 0) view["byteStride"] = stride;
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    json["bufferViews"].push_back(view);
    return json["bufferViews"].size() - 1;
  }

  std::size_t add_accessor(GltfJson accessor) {
    json["accessors"].push_back(std::move(accessor));
    return json["accessors"].size() - 1;
  }

  /// An accessor of its own view.
  template <class T>
  std::size_t add(const std::vector<T>& values, int component, const std::string& type, std::size_t width) {
    return add_accessor({{"bufferView", add_view(values)},
                         {"componentType", component},
                         {"count", values.size() / width},
                         {"type", type}});
  }
  std::size_t add_floats(const std::vector<float>& values, std::size_t width) {
    static const char* const types[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
    return add(values, 5126, types[width - 1], width);
  }
  std::size_t add_positions(const std::vector<float>& values) {
    const std::size_t number = add_floats(values, 3);
    GltfJson& accessor = json["accessors"][number];
    for (std::size_t k = 0; k < 3; ++k) {
      float min = values[k], max = values[k];
      for (std::size_t i = k; i < values.size(); i += 3) min = std::min(min, values[i]), max = std::max(max, values[i]);
      accessor["min"].push_back(min);
      accessor["max"].push_back(max);
    }
    return number;
  }
  std::size_t add_indices(const std::vector<std::uint16_t>& values) { return add(values, 5123, "SCALAR", 1); }

  [[nodiscard]] std::string glb() const {
    GltfJson complete = json;
    if (!bytes.empty()) complete["buffers"] = {{{"byteLength", bytes.size()}}};
    std::string text = complete.dump(), data = bytes;
    text.resize((text.size() + 3) / 4 * 4, ' ');
    data.resize((data.size() + 3) / 4 * 4);
    std::string file = "glTF" + word(2) + word(static_cast<std::uint32_t>(28 + text.size() + data.size()));
    file += word(static_cast<std::uint32_t>(text.size())) + "JSON" + text;
    return file + word(static_cast<std::uint32_t>(data.size())) + std::string("BIN\0", 4) + data;
  }

  void write(const std::filesystem::path& path) const { std::ofstream(path, std::ios::binary) << glb(); }

  static std::string word(std::uint32_t value) {
    std::string bytes;
    for (int k = 0; k < 4; ++k) bytes += static_cast<char>((value >> (8 * k)) & 0xff);
    return bytes;
  }
};

/// The JSON and the binary chunk of a GLB file.
struct GlbContent {
  GltfJson json;
  std::string bytes;
};

inline GlbContent glb_content(const std::string& file) {
  const auto word = [&](std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t k = 0; k < 4; ++k) value |= std::uint32_t{static_cast<std::uint8_t>(file.at(at + k))} << (8 * k);
    return value;
  };
  const std::size_t text = word(12);
  GlbContent content{GltfJson::parse(file.substr(20, text)), ""};
  if (20 + text < file.size()) content.bytes = file.substr(28 + text, word(20 + text));
  return content;
}

}  // namespace meshbound::test
