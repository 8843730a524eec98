// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "mesh/mesh_source.h"

namespace meshbound {

enum class PlyFormat { Ascii, LittleEndian, BigEndian };
enum class PlyType { Int8, UInt8, Int16, UInt16, Int32, UInt32, Float32, Float64 };

/// Bytes that a value takes in a binary file.
[[nodiscard]] std::size_t size_of(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type;  ///< of the value, or of each item of a list
  bool is_list = false;
  PlyType count_type{};  ///< lists only
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
  std::size_t declared_at = 0;  ///< byte offset of its line in the header
};

struct PlyHeader {
  PlyFormat format = PlyFormat::Ascii;
  std::vector<PlyElement> elements;
  std::size_t texture_files = 0;  ///< named by comments "TextureFile NAME", which MeshLab writes
  std::size_t end = 0;            ///< byte offset of the first byte after the header
};

/// Parses the header (http://paulbourke.net/dataformats/ply/). Throws `InvalidInput` with the line of the defect. Does
/// not yet compare the counts with the size of the file.
[[nodiscard]] PlyHeader read_ply_header(const MeshSource& source);

}  // namespace meshbound
