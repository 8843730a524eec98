// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "texture/overlay.h"
#include "texture/overlay_numbers.h"

namespace meshbound {
namespace {

Approximate difference(double x, double y) { return Approximate{x, 0} - Approximate{y, 0}; }

}  // namespace

/// With p, q the ways in the texture from the first corner to the others, and r, s those in space, the derivatives are
/// (q.v r - p.v s) / (p x q) by u and (p.u s - q.u r) / (p x q) by v.
LiftedPlane::LiftedPlane(const TexturedTriangle& triangle)
    : from_(triangle.coordinates[0]), at_(triangle.corners[0]), error_(0) {
  const auto& uv = triangle.coordinates;
  const auto by_area = Approximate{1, 0} / doubled_area(uv[0], uv[1], uv[2]);
  const auto along = [&](std::size_t corner, Eigen::Index axis) { return difference(uv[corner][axis], uv[0][axis]); };
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const Approximate r = difference(triangle.corners[1][axis], at_[axis]),
                      s = difference(triangle.corners[2][axis], at_[axis]);
    const std::array<Approximate, 2> by = {(along(2, 1) * r - along(1, 1) * s) * by_area,
                                           (along(1, 0) * s - along(2, 0) * r) * by_area};
    for (std::size_t k = 0; k < 2; ++k) {
      way_[k][axis] = by[k].value;
      error_ = std::max(error_, std::isnan(by[k].error) ? HUGE_VAL : by[k].error);
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
