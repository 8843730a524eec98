// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "texture/overlay.h"
#include "texture/overlay_numbers.h"

namespace meshbound {
namespace {

/// Squares of coordinates of an offset that is not shorter do not underflow so far that its length is off by more than
/// `Approximate::grown` has room for.
constexpr double min_distance = 0x1p-300;

}  // namespace

/// The derivative of a coordinate of the position by v is the area of the triangle with that coordinate in place of v,
/// over the area in the texture; by u it is that with the coordinate in place of u.
LiftedPlane::LiftedPlane(const TexturedTriangle& triangle)
    : from_(triangle.coordinates[0]), at_(triangle.corners[0]), error_(0) {
  const auto& uv = triangle.coordinates;
  const Approximate by_area = Approximate{1, 0} / doubled_area(uv[0], uv[1], uv[2]);
  const Eigen::Vector2d to_1 = uv[1] - from_, to_2 = uv[2] - from_;
  const Eigen::Array3d way_1 = triangle.corners[1] - at_, way_2 = triangle.corners[2] - at_;
  const auto set = [&](Eigen::Vector3d& way, const Eigen::Array3d& left, const Eigen::Array3d& right) {
    const Eigen::Array3d area = left - right;
    const Eigen::Array3d area_error = (left.abs() + right.abs()) * (8 * unit_roundoff) + Approximate::tiny;
    const Eigen::Array3d value = area * by_area.value;
    const Eigen::Array3d error = area.abs() * by_area.error + area_error * (std::fabs(by_area.value) + by_area.error) +
                                 (value.abs() * unit_roundoff + Approximate::tiny);
    way = value;
    error_ = std::max(error_, std::isnan(error.sum()) ? HUGE_VAL : error.maxCoeff() * Approximate::grown);
  };
  set(way_[0], way_1 * to_2.y(), way_2 * to_1.y());
  set(way_[1], way_2 * to_1.x(), way_1 * to_2.x());
}

/// The errors of the derivatives are at least 9 u of the largest one: an area has 8 u, and u is rounded with its
/// inverse. So half of the error below stands for what they may be off by, and the other half, 27 u of the way on the
/// plane on all axes together, for rounding: at most 4 u of that way on each axis, and 2 u of the way to the corner,
/// which is no longer than the two together. The rest, and the root of three squares, round by 8 u of the distance, for
/// which `grown` has room. Squares may underflow below 2^-300.
bool LiftedPlane::is_within(const TexturedTriangle& triangle, double limit) const {
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector2d step = triangle.coordinates[k] - from_;
    const double distance = std::max((triangle.corners[k] - at_ - way(step)).norm(), min_distance);
    if (!((distance + error(step)) * Approximate::grown <= limit)) return false;  // also where it is not a number
  }
  return true;
}

/// As above, with a way on each plane: the derivatives are off by as much, 1 of the 6 parts of `error` on each axis.
/// The ways round by 3 u and sums by 2 u of what they add up, and the offset of the corners, itself no longer than both
/// ways and the distance together, by 3 u: 8 u of the ways on each axis, less than another part, and 3 u of the
/// distance. On three axes two parts are less than 4.
Approximate distance_at(const LiftedPlane& p, const LiftedPlane& q, const Eigen::Vector2d& at) {
  const Eigen::Vector2d step_p = at - p.from_, step_q = at - q.from_;
  const Eigen::Vector3d offset = (p.at_ - q.at_) + p.way(step_p) - q.way(step_q);
  return {std::max(offset.norm(), min_distance), p.error(step_p) + q.error(step_q)};
}

double LiftedPlane::max_derivative() const {
  return (way_[0].cwiseAbs().sum() + way_[1].cwiseAbs().sum() + 6 * error_) * Approximate::grown;
}

}  // namespace meshbound
