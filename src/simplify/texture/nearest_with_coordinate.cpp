// SPDX-License-Identifier: MIT
#include "simplify/texture/nearest_with_coordinate.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "geometry/point_triangle.h"
#include "simplify/texture/weighted_points.h"

namespace meshbound {
namespace {

/// In multiples of the tolerance: coordinates so far outside of the box around a line are off it, whatever is rounded.
constexpr double clearly_off = 2;

}  // namespace

LineCoordinates::LineCoordinates(const CornerCoordinates& t) : is_one_(t[0] == t[1] && t[0] == t[2]), along_{0, 1, 2} {
  if (!is_one_)
    std::sort(along_.begin(), along_.end(), [&](std::uint8_t p, std::uint8_t q) {
      return std::pair(t[p].x(), t[p].y()) < std::pair(t[q].x(), t[q].y());
    });
  from_ = t[along_[0]];
  to_ = t[along_[2]];
  tolerance_ = rounding_of_coordinates * std::max(from_.norm(), to_.norm());
  turn_ = closest_share(from_, to_, t[along_[1]]);
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const auto [low, high] = std::minmax(from_[static_cast<Eigen::Index>(axis)], to_[static_cast<Eigen::Index>(axis)]);
    lowest_[axis] = low - clearly_off * tolerance_;
    highest_[axis] = high + clearly_off * tolerance_;
  }
}

std::optional<Vec3> LineCoordinates::nearest(const TriangleCorners& at, const Eigen::Vector2d& coordinate,
                                             Vec3 p) const {
  if (coordinate.x() < lowest_[0] || coordinate.x() > highest_[0] || coordinate.y() < lowest_[1] ||
      coordinate.y() > highest_[1])
    return std::nullopt;
  if (is_one_) {
    if (!((coordinate - from_).norm() <= tolerance_)) return std::nullopt;
    const CornerTriangle<double> corners{at[0], at[1] - at[0], at[2] - at[0]};
    return p - closest_on_triangle(corners, p).offset;
  }
  const double share = closest_share(from_, to_, coordinate), off = (from_ + share * (to_ - from_) - coordinate).norm();
  if (!(off <= tolerance_)) return std::nullopt;
  const Vec3 first = at[along_[0]], middle = at[along_[1]], last = at[along_[2]];
  const bool is_before = share < turn_ || turn_ == 1;
  const Vec3 across = first + share * (last - first),
             around = is_before ? first + (share / turn_) * (middle - first)
                                : middle + ((share - turn_) / (1 - turn_)) * (last - middle);
  return across + closest_share(across, around, p) * (around - across);
}

std::optional<Vec3> nearest_with_coordinate(const TriangleCorners& at, const CornerCoordinates& t,
                                            const Eigen::Vector2d& coordinate, Vec3 p) {
  return LineCoordinates(t).nearest(at, coordinate, p);
}

}  // namespace meshbound
