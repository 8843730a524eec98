// SPDX-License-Identifier: MIT
#include "simplify/texture/nearest_with_coordinate.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "geometry/point_triangle.h"
#include "simplify/texture/weighted_points.h"

namespace meshbound {
namespace {

/// The first, the middle and the last corner along the line.
std::array<std::size_t, 3> order_along_line(const CornerCoordinates& t) {
  std::array<std::size_t, 3> order = {0, 1, 2};
  std::sort(order.begin(), order.end(), [&](std::size_t p, std::size_t q) {
    return std::pair(t[p].x(), t[p].y()) < std::pair(t[q].x(), t[q].y());
  });
  return order;
}

}  // namespace

std::optional<Vec3> nearest_with_coordinate(const TriangleCorners& at, const CornerCoordinates& t,
                                            const Eigen::Vector2d& coordinate, Vec3 p) {
  if (t[0] == t[1] && t[0] == t[2]) {
    if (!((coordinate - t[0]).norm() <= rounding_of_coordinates * t[0].norm())) return std::nullopt;
    const CornerTriangle<double> corners{at[0], at[1] - at[0], at[2] - at[0]};
    return p - closest_on_triangle(corners, p).offset;
  }
  const auto [first, middle, last] = order_along_line(t);
  const double share = closest_share(t[first], t[last], coordinate),
               off = (t[first] + share * (t[last] - t[first]) - coordinate).norm();
  if (!(off <= rounding_of_coordinates * std::max(t[first].norm(), t[last].norm()))) return std::nullopt;
  const double turn = closest_share(t[first], t[last], t[middle]);
  const bool is_before = share < turn || turn == 1;
  const Vec3 across = at[first] + share * (at[last] - at[first]),
             around = is_before ? at[first] + (share / turn) * (at[middle] - at[first])
                                : at[middle] + ((share - turn) / (1 - turn)) * (at[last] - at[middle]);
  return across + closest_share(across, around, p) * (around - across);
}

}  // namespace meshbound
