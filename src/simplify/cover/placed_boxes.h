// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "simplify/cover/box_tree.h"

namespace meshbound {

/// Boxes in a texture, each with a box in space. Where charts overlap or many triangles share a part of the texture,
/// they are found by both at once; elsewhere by those in the texture alone. Immutable, safe to share.
class PlacedBoxes {
 public:
  /// Nothing meets one whose box in the texture is empty. Coordinates are finite. O(n log n).
  PlacedBoxes(const std::vector<Eigen::AlignedBox3d>& in_texture, const std::vector<Eigen::AlignedBox3d>& in_space);

  /// Appends the indices of those that may meet both boxes, in the order of `in_texture()`: all that do, and where few
  /// boxes share a part of the texture, also those that meet only the one in the texture.
  void find(const Eigen::AlignedBox3d& in_texture, const Eigen::AlignedBox3d& in_space,
            std::vector<std::uint32_t>& found) const;

  [[nodiscard]] const BoxTree& in_texture() const { return in_texture_; }
  /// Whether many boxes share a part of the texture.
  [[nodiscard]] bool is_crowded() const { return in_both_.has_value(); }

  using BoxOfBoth = BoxTreeOf<6>::AlignedBox;

 private:
  BoxTree in_texture_;
  /// Times 2 to this, boxes in the texture are about as large as those in space: a tree is halved along the longest of
  /// all axes.
  int exponent_ = 0;
  // These are set where many boxes share a part of the texture.
  std::optional<BoxTreeOf<6>> in_both_;
  std::vector<std::uint32_t> rank_;  ///< by box: its place in the order of `in_texture_`
};

}  // namespace meshbound
