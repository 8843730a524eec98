// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "texture/overlay.h"
#include "texture/overlay_numbers.h"

namespace meshbound {
/// The derivative of a coordinate of the position by v is the area of the triangle with that coordinate in place of v,
/// over the area in the texture; by u it is that with the coordinate in place of u.
LiftedPlane::LiftedPlane(const TexturedTriangle& triangle)
    : from_(triangle.coordinates[0]), at_(triangle.corners[0]), error_(0) {
  const auto& uv = triangle.coordinates;
  const Approximate by_area = Approximate{1, 0} / doubled_area(uv[0], uv[1], uv[2]);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const auto with = [&](std::size_t k, Eigen::Index replaced) {
      Eigen::Vector2d point = uv[k];
      point[replaced] = triangle.corners[k][axis];
      return point;
    };
    for (const Eigen::Index replaced : {0, 1}) {
      const Approximate way = doubled_area(with(0, replaced), with(1, replaced), with(2, replaced)) * by_area;
      way_[static_cast<std::size_t>(replaced)][axis] = way.value;
      error_ = std::max(error_, std::isnan(way.error) ? HUGE_VAL : way.error);
    }
  }
}

/// The errors of the derivatives are at least 9 u of the largest one: an area has 8 u, and u is rounded with its
/// inverse. So half of the error below stands for what they may be off by, and the other half, 27 u of the way on the
/// plane on all axes together, for rounding: at most 4 u of that way on each axis, and 2 u of the way to the corner,
/// which is no longer than the two together. The rest, and the root of three squares, round by 8 u of the distance, for
/// which `grown` has room. Squares may underflow below 2^-300.
bool LiftedPlane::is_within(const TexturedTriangle& triangle, double limit) const {
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector2d step = triangle.coordinates[k] - from_;
    const Eigen::Vector3d offset = triangle.corners[k] - at_ - (step.x() * way_[0] + step.y() * way_[1]);
    const double distance = std::max(offset.norm(), 0x1p-300), error = 6 * (step.cwiseAbs().sum() * error_);
    if (!((distance + error) * Approximate::grown <= limit)) return false;  // also where something is not a number
  }
  return true;
}

}  // namespace meshbound
