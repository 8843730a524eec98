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

bool LiftedPlane::is_within(const TexturedTriangle& triangle, double limit) const {
  double squared = 0, error = 0;  // the largest
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector2d step = triangle.coordinates[k] - from_;
    const Eigen::Vector3d there = triangle.corners[k] - at_, by_u = step.x() * way_[0], by_v = step.y() * way_[1];
    const double squared_here = (there - (by_u + by_v)).squaredNorm();
    // Steps, products, sums and differences round by at most 5 u of these sizes, for which 8 u have room.
    const double size = (there.cwiseAbs() + by_u.cwiseAbs() + by_v.cwiseAbs()).sum();
    const double error_here = 3 * (step.cwiseAbs().sum() * error_) + size * (8 * unit_roundoff);
    if (!(squared_here < 0x1p1000 && error_here < 0x1p500)) return false;  // also where either is not a number
    squared = std::max(squared, squared_here);
    error = std::max(error, error_here);
  }
  // A sum of three squares and its root round by 4 u of the root, for which `grown` has room, unless squares underflow.
  const double distance = std::max(std::sqrt(squared), 0x1p-300);
  return (distance + error) * Approximate::grown <= limit;
}

}  // namespace meshbound
