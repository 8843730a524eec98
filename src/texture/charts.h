// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "simplify/cover/box_tree.h"
#include "simplify/cover/hubs.h"
#include "simplify/cover/placed_boxes.h"
#include "texture/overlay.h"

namespace meshbound {

/// The box of the texture coordinates of a triangle; the third side keeps materials apart.
[[nodiscard]] Eigen::AlignedBox3d box_in_texture(const TexturedTriangle& triangle);

/// The box of a triangle in space.
[[nodiscard]] Eigen::AlignedBox3d place_of(const TexturedTriangle& triangle);

/// The distance between boxes, 0 where they meet, up to rounding; also where its square overflows.
[[nodiscard]] double distance_between(const Eigen::AlignedBox3d& a, const Eigen::AlignedBox3d& b);

/// A triangle whose corners have the texture coordinates of the corners of A, which has an area in the texture.
struct ChartCopy {
  const ChartTriangle* triangle = nullptr;
  /// An upper bound of the texture deviation of A: of the distances between corners with the same texture coordinates,
  /// as the length of an offset that is linear over a triangle is largest at a corner.
  double upper = 0;
};

/// Triangles that may have texture coordinates of a triangle.
struct ChartCandidates {
  /// Those that seem to share more than an edge with it in the texture and to be within reach of it in space. Rounding
  /// decides about some. If there is a `copy`, only this one. Where the triangle has no area in the texture: all with
  /// an area that may have coordinates of it, and those without one whose boxes in space are within reach.
  std::vector<const ChartTriangle*> near;
  std::vector<const ChartTriangle*> others;  ///< set by `find_others`
  std::optional<ChartCopy> copy;             ///< the nearest one, if one is within reach
  std::vector<std::uint32_t> indices;        ///< scratch memory: numbers of triangles
};

/// The triangles of a mesh with a search tree over their texture coordinates. Immutable, safe to share.
class Charts {
 public:
  /// `mesh` must outlive this.
  explicit Charts(const TexturedMesh& mesh);

  [[nodiscard]] const TexturedMesh& mesh() const { return mesh_; }
  /// Units that all texture coordinates and positions of the mesh are multiples of.
  [[nodiscard]] const ExactUnits& units() const { return units_; }
  [[nodiscard]] const std::vector<ChartTriangle>& triangles() const { return triangles_; }

  /// Finds the near ones of the triangles that may overlap `a` in the texture: where charts overlap, or many triangles
  /// share a part of the texture, all may. Expected O(log n + k log k) for k whose boxes in the texture meet that of
  /// `a` and whose boxes in space are within reach of it.
  void find_candidates(const ChartTriangle& a, double reach, ChartCandidates& found) const;
  /// Whether the box in the texture of a triangle without an area there seems to meet that of `a`: true if it does.
  /// O(log n).
  [[nodiscard]] bool seems_to_meet_without_area(const ChartTriangle& a) const;
  /// Whether triangles may have the only texture coordinate of `a` and others besides. O(n).
  [[nodiscard]] bool may_have_among_others(const ChartTriangle& a) const;
  /// Sets `others` to those that are not near, by the last `find_candidates`. Expected O(log n + k) for k whose boxes
  /// in the texture meet that of `a`.
  void find_others(const ChartTriangle& a, ChartCandidates& found) const;

 private:
  void find_with_area(const ChartTriangle& a, std::vector<std::uint32_t>& found) const;
  void put_in_order(std::vector<std::uint32_t>& found) const;
  void find_in_texture(const ChartTriangle& a, std::vector<std::uint32_t>& found) const;
  void find_without_area(const Eigen::AlignedBox3d& box, const BoxTree& tree, std::vector<std::uint32_t>& found) const;
  void find_near_without_area(const ChartTriangle& a, double reach, ChartCandidates& found) const;

  const TexturedMesh& mesh_;
  ExactUnits units_;
  std::vector<ChartTriangle> triangles_;
  std::vector<Eigen::AlignedBox3d> places_;  ///< in space, by triangle
  Hubs hubs_;
  std::vector<std::uint32_t> rank_;  ///< by triangle, in the order of boxes in the texture; empty without hubs
  /// By triangle: boxes of those with an area in the texture that are not around a hub, empty ones for all others.
  std::optional<PlacedBoxes> with_area_;
  std::vector<std::uint32_t> without_area_;  ///< triangles
  /// Boxes of these, in the texture and in space.
  std::optional<BoxTree> without_area_in_texture_, without_area_in_space_;
};

/// Units that the texture coordinates and positions of both meshes are multiples of.
[[nodiscard]] ExactUnits common_units(const Charts& a, const Charts& b);

}  // namespace meshbound
