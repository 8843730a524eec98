// SPDX-License-Identifier: MIT
/// Texture coordinates of a mesh under decimation, and samples of the original that show how far the texture moves.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "geometry/triangle_corners.h"
#include "meshbound/triangle_mesh.h"
#include "simplify/cover/box_tree.h"
#include "simplify/cover/hubs.h"
#include "simplify/cover/placed_boxes.h"
#include "simplify/mesh/array_mesh.h"
#include "simplify/mesh/feature_lines.h"
#include "simplify/mesh/sample_lists.h"

namespace meshbound {

/// Texture coordinates of the corners of a triangle; NaN where it has none.
using CornerCoordinates = std::array<Eigen::Vector2d, 3>;

/// Twice the area in the texture, as computed: negative where the corners go round clockwise, NaN where there are no
/// coordinates.
[[nodiscard]] inline double doubled_area(const CornerCoordinates& t) {
  const Eigen::Vector2d u = t[1] - t[0], v = t[2] - t[0];
  return u.x() * v.y() - u.y() * v.x();
}

/// The triangles of the original, found by a texture coordinate. Immutable, safe to share.
class Atlas {
 public:
  /// `materials` by triangle; empty: all are the same. O(n log n).
  Atlas(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles,
        std::vector<CornerCoordinates> coordinates, std::vector<std::uint32_t> materials);

  [[nodiscard]] const CornerCoordinates& coordinates(std::uint32_t triangle) const { return coordinates_[triangle]; }
  /// The point of the triangle with this coordinate, which may be rounded off it; nothing if there is none.
  [[nodiscard]] std::optional<Vec3> point(std::uint32_t triangle, const Eigen::Vector2d& coordinate) const;
  [[nodiscard]] std::uint32_t material(std::uint32_t triangle) const {
    return materials_.empty() ? 0 : materials_[triangle];
  }
  /// The squared distance from `p` of a point of the original with this coordinate and material that is farther away
  /// than `limit`; 0 if there is none. `found` is scratch memory. Expected O(log n) for few such points within the
  /// limit.
  [[nodiscard]] double squared_distance_of_far_point(const Eigen::Vector2d& coordinate, std::uint32_t material, Vec3 p,
                                                     double limit, std::vector<std::uint32_t>& found) const;
  /// The squared distance from `p` to the nearest point of the original with this coordinate and material; 0 if there
  /// is none. Where all of them are farther away than `limit`, it need not be the nearest one. Triangles with a single
  /// coordinate do not count: they are compared as surfaces. `found` is scratch memory. Expected O(log n) for few such
  /// points within the limit, however many there are beyond.
  [[nodiscard]] double squared_distance(const Eigen::Vector2d& coordinate, std::uint32_t material, Vec3 p, double limit,
                                        std::vector<std::uint32_t>& found) const;

 private:
  [[nodiscard]] double squared_distance_to_lines(const Eigen::Vector2d& coordinate, std::uint32_t material, Vec3 p,
                                                 double limit, std::vector<std::uint32_t>& found) const;
  [[nodiscard]] TriangleCorners corners(std::uint32_t triangle) const;
  [[nodiscard]] std::optional<Vec3> point_inside(std::uint32_t triangle, const Eigen::Vector2d& coordinate) const;
  template <class Accept>
  [[nodiscard]] double squared_distance_of_some_point(const Eigen::Vector2d& coordinate, std::uint32_t material, Vec3 p,
                                                      std::vector<std::uint32_t>& found, const Accept& accept) const;
  [[nodiscard]] std::vector<TexturedTriangle> as_textured() const;
  void find_around_hubs(const Eigen::Vector2d& coordinate, std::uint32_t material,
                        std::vector<std::uint32_t>& found) const;

  const std::vector<Vec3>& vertices_;
  const std::vector<Triangle>& triangles_;
  std::vector<CornerCoordinates> coordinates_;
  std::vector<std::uint32_t> materials_;
  Hubs hubs_;
  std::optional<PlacedBoxes> with_area_;  ///< the triangles with an area in the texture that are not around a hub
  std::optional<PlacedBoxes> on_lines_;   ///< those whose texture coordinates lie on a line; absent without any
};

/// The texture of a mesh under decimation: coordinates at its corners, and samples of the original, each assigned to
/// the face that has its coordinate. It guides decimation and proves nothing. Threads may change what belongs to faces
/// of different regions at once.
class TextureMap {
 public:
  /// A point of the original.
  struct Sample {
    Vec3 at;
    Eigen::Vector2d coordinate;
    bool is_on_line = false;
  };

  /// `start` is the original, triangle by triangle, as `triangle_of_face` says; edges where coordinates or materials
  /// differ are `lines`. Samples are the vertices, one for each side of a line, and points between them on edges longer
  /// than `spacing`. O(n).
  TextureMap(Atlas atlas, const ArrayMesh& start, const FeatureLines& lines,
             const std::vector<std::uint32_t>& triangle_of_face, const std::vector<Vec3>& vertices,
             const std::vector<Triangle>& triangles, double spacing);

  [[nodiscard]] const Atlas& atlas() const { return atlas_; }
  [[nodiscard]] const Eigen::Vector2d& at(Corner corner) const { return coordinates_[corner]; }
  [[nodiscard]] CornerCoordinates of(std::uint32_t face) const {
    return {coordinates_[3 * face], coordinates_[3 * face + 1], coordinates_[3 * face + 2]};
  }
  void set(Corner corner, const Eigen::Vector2d& coordinate) { coordinates_[corner] = coordinate; }
  void restore(std::uint32_t face, const CornerCoordinates& before) {
    for (std::size_t k = 0; k < 3; ++k) coordinates_[3 * face + k] = before[k];
  }
  /// The chart of a face: faces connected without crossing a line have one chart. `no_index` for a face without
  /// coordinates.
  [[nodiscard]] std::uint32_t chart(std::uint32_t face) const { return chart_[face]; }
  [[nodiscard]] std::uint32_t material(std::uint32_t face) const { return material_[face]; }

  [[nodiscard]] const Sample& sample(std::uint32_t s) const { return samples_[s]; }

  SampleLists lists;  ///< samples may only be given to faces of their chart
  double limit = 0;   ///< largest distance that the texture may move at a sample, model units

 private:
  void number_charts(const ArrayMesh& start, const FeatureLines& lines);
  void take_vertices(const ArrayMesh& start, const FeatureLines& lines);
  void take_edges(const ArrayMesh& start, const FeatureLines& lines, double spacing);
  void add_sample(std::uint32_t face, Vec3 at, const Eigen::Vector2d& coordinate, bool is_on_line);

  Atlas atlas_;
  std::vector<Eigen::Vector2d> coordinates_;     ///< by corner
  std::vector<std::uint32_t> chart_, material_;  ///< by face
  std::vector<Sample> samples_;
};

/// Barycentric coordinates of a point in a triangle of the texture; nothing where that has no area.
[[nodiscard]] std::optional<std::array<double, 3>> weights_at(const CornerCoordinates& corners,
                                                              const Eigen::Vector2d& coordinate);
/// As `weights_at`; nothing where the triangle does not cover the point.
[[nodiscard]] std::optional<std::array<double, 3>> weights_inside(const CornerCoordinates& corners,
                                                                  const Eigen::Vector2d& coordinate);

/// The box of a triangle in the texture, with the material as third coordinate; empty for one without an area there.
[[nodiscard]] Eigen::AlignedBox3d box_in_texture(const CornerCoordinates& corners, std::uint32_t material);

}  // namespace meshbound
