// SPDX-License-Identifier: MIT
/// What a mesh carries beside its triangles: texture coordinates, normals, colours, materials, groups and whatever else
/// a file says of corners and triangles.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "meshbound/line_mesh.h"
#include "meshbound/triangle_mesh.h"

namespace meshbound {

struct GltfDocument;
struct SimplifiedLevel;

/// A value at each corner of each triangle; one value may be that of many corners.
struct CornerAttribute {
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();  ///< index of a missing value

  std::vector<Eigen::Vector3d> values;  ///< texture coordinates u, v (and 0), or unit normals
  std::vector<Triangle> index;          ///< by triangle: the values of its corners, or `none`; empty: no such attribute

  /// Whether the mesh lacks the attribute.
  [[nodiscard]] bool empty() const { return index.empty(); }
};

/// Which numbers can be texture coordinates.
enum class TexturePrecision : std::uint8_t {
  Double,
  Float,        ///< u and v are floats (PLY whose properties are floats)
  FloatFromTop  ///< u and 1 - v are floats (glTF, whose v grows downwards)
};

/// Texture coordinates u, v as an argument or a result, aligned as a double whatever the flags (see `Pose`).
/// `Eigen::Vector2d` converts to it and back by itself.
using TextureCoordinate = Eigen::Matrix<double, 2, 1, Eigen::DontAlign>;

/// The nearest texture coordinate of this precision; one that has it stays as it is.
[[nodiscard]] TextureCoordinate rounded_to(TexturePrecision precision, const TextureCoordinate& coordinate);

/// How the value of an attribute at a point inside a triangle follows from those at the corners.
enum class Interpolation : std::uint8_t {
  Linear,     ///< the values of the three corners, weighted by the barycentric coordinates of the point
  Direction,  ///< the same for the first three numbers, scaled to length 1; a fourth one is that of the nearest corner
  Nearest     ///< the value of the nearest corner, for numbers that have no mean, such as the indices of joints
};

/// Values of any width at the corners of triangles, under the name that the file gives them.
struct NamedAttribute {
  std::string name = {};  ///< a semantic of glTF, such as "COLOR_0" (colours of every format) or "TEXCOORD_1"; a
                          ///< property of PLY; "targets/2/POSITION" for the third morph target of glTF
  std::size_t width = 1;  ///< numbers in a value; colours: 3 or 4, from 0 to 1
  Interpolation interpolation = Interpolation::Linear;  ///< between the corners of a triangle
  bool has_seams = true;                                ///< edges where the values of both sides differ are seams
  std::vector<double> values = {};                      ///< `width` numbers for each value
  std::vector<Triangle> index = {};  ///< by triangle: the values of its corners, or `CornerAttribute::none`
};

/// A name for each triangle.
struct TriangleLabels {
  std::vector<std::string> names;    ///< each once
  std::vector<std::uint32_t> index;  ///< by triangle: its name, or `CornerAttribute::none`; empty: there are no names

  /// Whether the mesh has no such names.
  [[nodiscard]] bool empty() const { return index.empty(); }
};

/// The attributes of a mesh, in the order of its triangles.
struct MeshAttributes {
  CornerAttribute texture_coordinates;  ///< v grows upwards, as in OBJ; that of glTF, which grows downwards, is 1 - v
  TexturePrecision texture_precision = TexturePrecision::Double;  ///< of the file they are read from or made for
  CornerAttribute normals;                                        ///< in the frame of the mesh
  TriangleLabels materials;                                       ///< names of `usemtl` (OBJ) and of materials (glTF)
  TriangleLabels objects;                                         ///< what follows `o` (OBJ); names of meshes (glTF)
  TriangleLabels groups;                                          ///< what follows `g` (OBJ)
  TriangleLabels smoothing_groups;                                ///< what follows `s` (OBJ)
  std::vector<std::string> material_libraries;                    ///< file names of `mtllib` (OBJ)
  std::vector<NamedAttribute> named;                              ///< all others, each name once
  /// What else the glTF file holds from which the mesh was read, for the writer of glTF; null: another format.
  std::shared_ptr<const GltfDocument> document;
  std::vector<std::uint32_t> part;  ///< by triangle: the part of `document` it belongs to; empty without a document

  /// Whether there are none at all.
  [[nodiscard]] bool empty() const {
    return texture_coordinates.empty() && normals.empty() && materials.empty() && objects.empty() && groups.empty() &&
           smoothing_groups.empty() && material_libraries.empty() && named.empty() && document == nullptr;
  }
};

/// The edges where a simplification must not mix what lies on both sides (`SimplifyOptions::feature_edges`): those
/// whose two triangles have different materials, parts, objects, groups or smoothing groups or, at one of the ends,
/// different texture coordinates or values of a named attribute that has seams; and, where the mesh has texture
/// coordinates, materials, parts or several objects, groups or smoothing groups, those that do not have exactly two
/// triangles in one layer (see `looks`). Vertices at equal positions are one. Throws
/// `InvalidInput` where the attributes are not those of as many triangles. O(n log n).
[[nodiscard]] std::vector<Edge> seams(const TriangleMesh& mesh, const MeshAttributes& attributes);

/// `SimplifyOptions::looks`: triangles with the same corners look alike where they show the same side and have the same
/// material, part, object, group and values at their corners. Empty where no two triangles have the same corners, and
/// where the mesh has neither texture coordinates nor materials nor parts nor several objects, groups or smoothing
/// groups, as a scan: the first one of all stays then. Throws as `seams`. O(n log n).
[[nodiscard]] std::vector<std::uint32_t> looks(const TriangleMesh& mesh, const MeshAttributes& attributes);

/// The attributes of a level of `original` that was made with its `seams` as feature edges.
///
/// Labels are those of `SimplifiedLevel::source_triangle`. A vertex on a line stands where the original has a vertex:
/// its values on each side of the line are those of the original on this side. Any other vertex takes the values that
/// the original has at the closest point of the same chart, where a chart is what hangs together without crossing a
/// seam. Normals are taken at the closest point of the chart for each corner, a little inside its triangle, so that
/// sharp edges stay sharp; corners around a vertex share their mean where they are nearly alike. Where every vertex of
/// the level stands at its source, as with `CollapsePlacements::Subset`, each corner takes all its values from one
/// corner of the original, so that levels can share a vertex buffer. Values are a guide for the eye: nothing is proven
/// of them.
///
/// Throws `InvalidInput` as `seams`. O(n log n).
[[nodiscard]] MeshAttributes transferred_attributes(const TriangleMesh& original, const MeshAttributes& attributes,
                                                    const SimplifiedLevel& level);

/// Where a glTF document places parts by nodes, the vertices of a level as the file will have them: each is rounded to
/// the floats that are written in the frame of its node, and one that parts of several nodes share is doubled. Without
/// a document the level as it is. `attributes` are those of its triangles. O(n log n).
[[nodiscard]] SimplifiedLevel placed_as_written(SimplifiedLevel level, const MeshAttributes& attributes);

/// How far `placed_as_written` may move a vertex that lies about where those of `mesh` lie, model units: a bound of the
/// rounding to floats in the frames of the nodes. 0 without a document and where no node moves anything. O(n).
[[nodiscard]] double placement_rounding(const TriangleMesh& mesh, const MeshAttributes& attributes);

}  // namespace meshbound
