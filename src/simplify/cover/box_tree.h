// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace meshbound {

/// Finds the boxes that meet a box: a tree of nodes that hold eight boxes each, halved along the longest axis. Boxes
/// are compared in single precision, relative to one in the middle of their order, so that a few far away do not make
/// this coarse. Subtraction and rounding keep the order of numbers: none is lost, and one that misses the box by less
/// than that rounding may be found as well. Immutable, safe to share.
///
/// There are trees of three axes, and of six for boxes in a texture and in space at once (`PlacedBoxes`).
template <int axes>
class BoxTreeOf {
 public:
  using AlignedBox = Eigen::AlignedBox<double, axes>;
  using Point = Eigen::Matrix<double, axes, 1>;
  class Search;

  /// O(n log n). Coordinates are finite; nothing meets an empty box.
  explicit BoxTreeOf(const std::vector<AlignedBox>& boxes);

  /// Appends the indices of the boxes that meet `box`, in an order that depends on the boxes alone.
  void find(const AlignedBox& box, std::vector<std::uint32_t>& found) const;

  /// Whether `find` would find any.
  [[nodiscard]] bool meets(const AlignedBox& box) const;

  /// Calls `visit` with the indices of the boxes within a reach of `point`, nearer ones first as a rule. It returns the
  /// square of the reach from then on, or `end_of_visit`. A box that is further away by less than rounding may be
  /// visited as well.
  template <class Visit>
  void visit_near(const Point& point, double squared_reach, const Visit& visit) const {
    if (order_.empty()) return;
    const auto visit_index = [&](std::size_t box) { squared_reach = visit(order_[box]); };
    visit_near((point - origin_).template cast<float>(), squared_reach, levels_.size() - 1, 0, visit_index);
  }

  static constexpr double end_of_visit = -1;

  /// The indices of all boxes: `find` keeps this order.
  [[nodiscard]] const std::vector<std::uint32_t>& order() const { return order_; }

 private:
  static constexpr std::size_t width = 8;
  static constexpr std::size_t max_levels = 11;  ///< 8^11 is more than there are indices

  using Corner = Eigen::Matrix<float, axes, 1>;
  struct Box {
    Corner lo, hi;
  };
  /// A lane of a node, and a lower bound of the square of the distance of its box.
  struct NearLane {
    float squared = 0;
    std::size_t lane = 0;
  };
  struct NearLanes {
    std::array<NearLane, width> lanes;
    std::size_t count = 0;
  };
  struct Wanted;  ///< the box that is looked for
  /// Boxes by axis; those of unused lanes are not numbers, which meet nothing.
  struct Node {
    Node();
    void set(std::size_t lane, const Box& box);
    /// A bit for each lane whose box meets this one.
    [[nodiscard]] unsigned meeting(const Wanted& box) const;
    /// The lanes of boxes that may be nearer to `point` than the reach, the nearest first.
    [[nodiscard]] NearLanes near(const Corner& point, double squared_reach) const;
    float lo[axes][width], hi[axes][width];
  };

  [[nodiscard]] Box rounded(const AlignedBox& box) const;
  template <class Visit>
  void visit_near(const Corner& point, const double& squared_reach, std::size_t level, std::size_t node,
                  const Visit& visit) const {
    const NearLanes near = levels_[level][node].near(point, squared_reach);
    for (std::size_t i = 0; i < near.count && near.lanes[i].squared <= squared_reach; ++i) {
      const std::size_t box = width * node + near.lanes[i].lane;
      if (level == 0)
        visit(box);
      else
        visit_near(point, squared_reach, level - 1, box, visit);
    }
  }

  Point origin_ = Point::Zero();
  std::vector<std::uint32_t> order_;  ///< indices of the boxes
  /// By level: node i has the boxes 8 i to 8 i + 7 in order, or the boxes around these nodes of the level before.
  std::vector<std::vector<Node>> levels_;
};

using BoxTree = BoxTreeOf<3>;

/// A search that can be ended early: finds the same boxes as `find` in the same order.
template <int axes>
class BoxTreeOf<axes>::Search {
 public:
  /// `tree` must outlive this.
  Search(const BoxTreeOf& tree, const AlignedBox& box);

  /// The index of the next box; absent if there is none.
  [[nodiscard]] std::optional<std::uint32_t> next();

 private:
  friend class BoxTreeOf;
  [[nodiscard]] bool next_node(const Wanted& wanted);

  const BoxTreeOf& tree_;
  Box box_;
  std::array<unsigned, max_levels> open_{};         ///< by level: lanes of a node that are left
  std::array<std::size_t, max_levels> first_lane_;  ///< and the number of its first lane
};

extern template class BoxTreeOf<3>;
extern template class BoxTreeOf<6>;

}  // namespace meshbound
