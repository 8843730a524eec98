// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

namespace meshbound {

/// Finds the boxes that meet a box: a binary tree by halves along the longest axis, with a few boxes in each leaf.
/// Immutable, safe to share.
class BoxTree {
 public:
  /// O(n log n).
  explicit BoxTree(std::vector<Eigen::AlignedBox3d> boxes);

  /// Appends the indices of the boxes that meet `box`, in an order that depends on the boxes alone.
  void find(const Eigen::AlignedBox3d& box, std::vector<std::uint32_t>& found) const;

 private:
  void build(const std::vector<Eigen::AlignedBox3d>& boxes, std::size_t node, std::size_t first, std::size_t last);
  void search(std::size_t node, std::size_t first, std::size_t last, const Eigen::AlignedBox3d& box,
              std::vector<std::uint32_t>& found) const;

  std::vector<std::uint32_t> order_;        ///< indices by leaf
  std::vector<Eigen::AlignedBox3d> boxes_;  ///< in this order
  std::vector<Eigen::AlignedBox3d> nodes_;  ///< of [first, last) in order; node i has children 2i+1 and 2i+2
};

}  // namespace meshbound
