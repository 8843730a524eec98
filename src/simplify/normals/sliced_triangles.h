// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "simplify/cover/box_tree.h"
#include "simplify/normals/faced_triangle.h"

namespace meshbound {

/// Triangles in a tree of boxes, or slices of them where a tree of whole ones is of little use: the box of a needle
/// askew to the axes holds whatever lies near it, so where there are thousands of needles, their boxes hold any point.
/// Immutable, safe to share.
class SlicedTriangles {
 public:
  /// Expected O(n log n).
  explicit SlicedTriangles(std::span<const FacedTriangle> triangles);

  [[nodiscard]] std::uint32_t triangle(std::uint32_t slice) const { return slices_.triangles[slice]; }
  [[nodiscard]] const Eigen::AlignedBox3d& box(std::uint32_t slice) const { return slices_.boxes[slice]; }
  /// Appends the slices whose boxes meet a box.
  void find(const Eigen::AlignedBox3d& box, std::vector<std::uint32_t>& found) const { tree_.find(box, found); }

 private:
  struct Slices {
    std::vector<Eigen::AlignedBox3d> boxes;
    std::vector<std::uint32_t> triangles;  ///< that these are of
  };
  [[nodiscard]] static Slices slices_of(std::span<const FacedTriangle> triangles, bool is_whole);
  [[nodiscard]] bool are_many_boxes_at_points(std::span<const FacedTriangle> triangles) const;

  Slices slices_;
  BoxTree tree_;
};

}  // namespace meshbound
