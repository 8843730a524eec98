// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

namespace meshbound {

/// Finds the boxes that meet a box: a binary tree by halves along the longest axis. Immutable, safe to share.
class BoxTree {
 public:
  /// O(n log n).
  explicit BoxTree(std::vector<Eigen::AlignedBox3d> boxes);

  [[nodiscard]] const Eigen::AlignedBox3d& box(std::uint32_t index) const { return boxes_[index]; }

  /// Appends the indices of the boxes that meet `box`, in an order that depends on the boxes alone.
  void find(const Eigen::AlignedBox3d& box, std::vector<std::uint32_t>& found) const;

 private:
  void build(std::size_t node, std::size_t first, std::size_t last);
  void search(std::size_t node, std::size_t first, std::size_t last, const Eigen::AlignedBox3d& box,
              std::vector<std::uint32_t>& found) const;

  std::vector<Eigen::AlignedBox3d> boxes_;
  std::vector<std::uint32_t> order_;
  std::vector<Eigen::AlignedBox3d> nodes_;  ///< of [first, last) in order; node i has children 2i+1 and 2i+2
};

}  // namespace meshbound
