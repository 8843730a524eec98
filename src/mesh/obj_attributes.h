// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "meshbound/io.h"

namespace meshbound {

/// Collects the attributes of an OBJ file, polygon by polygon; triangles are those of `MeshAssembler::add_polygon`.
class ObjAttributes {
 public:
  /// Adds a value of a `vt` or `vn` statement. The third number of a texture coordinate is not collected.
  void add_value(std::string_view keyword, const Eigen::Vector3d& value);
  /// Sets red, green, blue and opacity of a vertex, counted from 0.
  void add_colour(std::size_t vertex, const Eigen::Vector4d& colour);
  /// Takes a statement that says what the polygons after it belong to (`usemtl`, `g`, `o`, `s`) or names a library of
  /// materials (`mtllib`). Other keywords are ignored.
  void set_label(std::string_view keyword, std::string_view argument);

  void begin_polygon() { corners_.clear(); }
  /// Adds a corner of a polygon with indices as in the file: counted from 1, or negative and back from the last value;
  /// 0 for none.
  void add_corner(std::int64_t texture_coordinate, std::int64_t normal);
  void end_polygon();

  /// Returns what was collected, for a mesh with these triangles. What has been collected is subtracted from `dropped`.
  [[nodiscard]] MeshAttributes finish(const std::vector<Triangle>& triangles, DroppedAttributes& dropped);

 private:
  struct Labels {
    TriangleLabels all;
    std::unordered_map<std::string, std::uint32_t> number;
    std::uint32_t current = CornerAttribute::none;
    void set(std::string name);
  };
  struct Corner {
    std::int64_t texture_coordinate, normal;  ///< counted from 0; -1 for none
  };

  MeshAttributes attributes_;
  void take_colours(const std::vector<Triangle>& triangles);

  Labels materials_, objects_, groups_, smoothing_groups_;
  std::vector<std::uint32_t> colour_of_;  ///< by vertex, up to the last one that has a colour
  NamedAttribute colours_{.name = "COLOR_0", .width = 4};
  std::vector<Corner> corners_;
  std::size_t solid_texture_coordinates_ = 0;  ///< whose third number is not 0
};

}  // namespace meshbound
