// SPDX-License-Identifier: MIT
/// Finds the plane that has a given number of items before it, by looking at all items in each of a few rounds.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "geometry/vec3.h"
#include "tiles/tile_cut.h"

namespace meshbound {

using CutAxes = std::array<Vec3, 3>;

/// Where an item lies along an axis, then its number: no two items have the same.
using CutKey = std::pair<double, std::uint32_t>;

[[nodiscard]] inline double along(const Vec3& axis, const Vec3& p) {
  return axis.x * p.x + axis.y * p.y + axis.z * p.z;
}
[[nodiscard]] inline CutKey key_of(const CutItem& item, const Vec3& axis) {
  return {along(axis, item.position), item.number};
}

/// How many items there are, what they weigh, and their box along the axes of a cut.
class CutExtent {
 public:
  explicit CutExtent(const CutAxes& axes) : axes_(&axes) {}
  void add(const CutItem& item) {
    const auto& [x, y, z] = *axes_;
    box_.extend(Eigen::Vector3d(along(x, item.position), along(y, item.position), along(z, item.position)));
    weight_ += item.weight;
    ++count_;
  }
  void clear() { *this = CutExtent(*axes_); }
  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] std::uint64_t weight() const { return weight_; }
  [[nodiscard]] const Vec3& longest_axis() const;

 private:
  const CutAxes* axes_;
  Eigen::AlignedBox3d box_;
  std::uint64_t weight_ = 0;
  std::size_t count_ = 0;
};

/// All of the items that it was given, while they are few; else some that are evenly spread over them.
class CutSample {
 public:
  /// `max_items`: at least 16.
  explicit CutSample(std::size_t max_items) : max_items_(max_items) {}
  void add(const CutItem& item);
  [[nodiscard]] std::size_t given() const { return given_; }
  [[nodiscard]] bool has_all() const { return step_ == 1; }
  [[nodiscard]] std::vector<CutItem>& items() { return items_; }

 private:
  std::size_t max_items_, given_ = 0;
  std::size_t step_ = 1;  ///< of so many that are given one is kept
  std::vector<CutItem> items_;
};

/// Items that are to be cut into two.
struct CutPart {
  CutExtent extent;             ///< of all of them
  std::vector<CutItem> sample;  ///< some of them, or none
};

/// The items before a plane come before `first_behind` along the axis.
struct CutPlane {
  Vec3 axis;
  CutKey first_behind;

  [[nodiscard]] bool has_behind(const CutItem& item) const { return !(key_of(item, axis) < first_behind); }
};

/// The search for the plane that has `rank` items of a part before it. A sample tells between which two keys it should
/// lie; where these were wrong, or too many items lie between them, the next round goes on from what was found.
class PlaneSearch {
 public:
  PlaneSearch(CutPart part, const CutAxes& axes, std::size_t rank);

  /// In each round all items of the part are added. At most `max_items` of them (at least 16) are kept.
  void begin_round(std::size_t max_items);
  void add(const CutItem& item) {
    const CutKey key = key_of(item, axis_);
    if (key < from_)
      before_.add(item);
    else if (key < to_)
      between_.add(item);
    else
      behind_.add(item);
  }
  /// The plane, if it has been found.
  [[nodiscard]] std::optional<CutPlane> end_round();
  /// The items before the plane that has been found, and those behind it.
  [[nodiscard]] std::pair<CutPart, CutPart> halves(const CutPlane& plane);

 private:
  Vec3 axis_;
  std::size_t rank_;
  std::vector<CutItem> sample_;
  CutKey low_, high_;          ///< the plane lies between these
  std::size_t below_ = 0;      ///< items before `low_`
  std::size_t within_;         ///< items from `low_` to `high_`
  CutKey from_, to_;           ///< where this round expects the plane
  CutExtent before_, behind_;  ///< this range
  CutSample between_{0};
};

}  // namespace meshbound
