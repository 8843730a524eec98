// SPDX-License-Identifier: MIT
/// What a mesh carries beside its triangles: texture coordinates, normals, materials and groups.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "meshbound/line_mesh.h"
#include "meshbound/triangle_mesh.h"

namespace meshbound {

struct SimplifiedLevel;

/// A value at each corner of each triangle; one value may be that of many corners.
struct CornerAttribute {
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

  std::vector<Eigen::Vector3d> values;  ///< texture coordinates u, v (and 0), or unit normals
  std::vector<Triangle> index;          ///< by triangle: the values of its corners, or `none`; empty: no such attribute

  [[nodiscard]] bool empty() const { return index.empty(); }
};

/// A name for each triangle.
struct TriangleLabels {
  std::vector<std::string> names;
  std::vector<std::uint32_t> index;  ///< by triangle: its name, or `CornerAttribute::none`; empty: there are no names

  [[nodiscard]] bool empty() const { return index.empty(); }
};

/// The attributes of a mesh, in the order of its triangles.
struct MeshAttributes {
  CornerAttribute texture_coordinates;
  CornerAttribute normals;
  TriangleLabels materials;                     ///< names of `usemtl` (OBJ)
  TriangleLabels groups;                        ///< whole statements `g ...` and `o ...` (OBJ)
  std::vector<std::string> material_libraries;  ///< file names of `mtllib` (OBJ)

  /// Whether there are none at all.
  [[nodiscard]] bool empty() const {
    return texture_coordinates.empty() && normals.empty() && materials.empty() && groups.empty() &&
           material_libraries.empty();
  }
};

/// The edges where a simplification must not mix what lies on both sides (`SimplifyOptions::feature_edges`): those
/// whose two triangles have different materials or, at one of the ends, different texture coordinates, and those that
/// do not have exactly two triangles. None where the mesh has neither materials nor texture coordinates. Vertices at
/// equal positions are one. Throws `InvalidInput` where the attributes are not those of as many triangles. O(n log n).
[[nodiscard]] std::vector<Edge> seams(const TriangleMesh& mesh, const MeshAttributes& attributes);

/// The attributes of a level of `original` that was made with its `seams` as feature edges.
///
/// Labels are those of `SimplifiedLevel::source_triangle`. A vertex on a line stands where the original has a vertex:
/// its texture coordinate on each side of the line is that of the original on this side. Any other vertex takes the
/// value that the original has at the closest point of the same chart, where a chart is what hangs together without
/// crossing a seam. Normals are taken at the closest point of the chart for each corner, a little inside its triangle,
/// so that sharp edges stay sharp. Values are a guide for the eye: nothing is proven of them.
///
/// Throws `InvalidInput` as `seams`. O(n log n).
[[nodiscard]] MeshAttributes transferred_attributes(const TriangleMesh& original, const MeshAttributes& attributes,
                                                    const SimplifiedLevel& level);

}  // namespace meshbound
