// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <limits>

#include "numeric/rounding.h"

namespace meshbound {

/// A point inside a triangle as doubles hold it: mostly beside the surface. Bounds of the distance of `position` are
/// those of a point of the triangle once `widened` by `error`.
struct RoundedPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  double error = 0;  ///< from the nearest point of the triangle at most, in the unit of the coordinates
};

/// The point (1 - v - w) a + v b + w c for v, w >= 0 with v + w <= 1 + 2u, which holds where the computed 1 - v - w or
/// the computed v + w says that the point is inside.
///
/// Error, with coordinates of magnitude at most M: a point of the triangle is within 2u 2 sqrt(3) M < 7uM of the exact
/// combination. In each coordinate the first weight adds 2uM, the products at most uM together and the two sums 2uM:
/// 5uM, or less than 9uM as a length. `cut_error`, 16uM, is the sum of both; twice that has room for terms of u^2.
/// Three products that underflow add less than four of the smallest numbers to the length.
[[nodiscard]] inline RoundedPoint rounded_point(const std::array<Eigen::Vector3d, 3>& corners, double v, double w) {
  const auto& [a, b, c] = corners;
  const double largest = std::max({a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff(), c.cwiseAbs().maxCoeff()});
  constexpr double underflow = 4 * std::numeric_limits<double>::denorm_min();
  return {(1 - v - w) * a + v * b + w * c, 2 * cut_error * largest + underflow};
}

}  // namespace meshbound
