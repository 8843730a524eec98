// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

namespace meshbound {

/// Finds the boxes that meet a box: a tree of nodes that hold eight boxes each, halved along the longest axis. Boxes
/// are compared in single precision, relative to one in the middle of their order, so that a few far away do not make
/// this coarse. Subtraction and rounding keep the order of numbers: none is lost, and one that misses the box by less
/// than that rounding may be found as well. Immutable, safe to share.
class BoxTree {
 public:
  /// O(n log n). Coordinates are finite; nothing meets an empty box.
  explicit BoxTree(const std::vector<Eigen::AlignedBox3d>& boxes);

  /// Appends the indices of the boxes that meet `box`, in an order that depends on the boxes alone.
  void find(const Eigen::AlignedBox3d& box, std::vector<std::uint32_t>& found) const;

  /// Whether `find` would find any.
  [[nodiscard]] bool meets(const Eigen::AlignedBox3d& box) const;

 private:
  static constexpr std::size_t width = 8;
  static constexpr std::size_t max_levels = 11;  ///< 8^11 is more than there are indices

  struct Box {
    Eigen::Vector3f lo, hi;
  };
  struct Wanted;  ///< the box that is looked for
  /// Boxes by axis; those of unused lanes are not numbers, which meet nothing.
  struct Node {
    Node();
    void set(std::size_t lane, const Box& box);
    /// A bit for each lane whose box meets this one.
    [[nodiscard]] unsigned meeting(const Wanted& box) const;
    float lo[3][width], hi[3][width];
  };

  [[nodiscard]] Box rounded(const Eigen::AlignedBox3d& box) const;
  /// Calls `visit(node, lanes)` for the nodes of the lowest level with boxes that meet `box`, a bit of `lanes` for
  /// each, until it returns false.
  template <class Visit>
  void visit_meeting(const Eigen::AlignedBox3d& box, const Visit& visit) const;

  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  std::vector<std::uint32_t> order_;  ///< indices of the boxes
  /// By level: node i has the boxes 8 i to 8 i + 7 in order, or the boxes around these nodes of the level before.
  std::vector<std::vector<Node>> levels_;
};

}  // namespace meshbound
