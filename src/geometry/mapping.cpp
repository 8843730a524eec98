// SPDX-License-Identifier: MIT
#include "geometry/mapping.h"

#include <algorithm>
#include <cmath>

#include "geometry/affine.h"
#include "geometry/eigen_vec3.h"
#include "geometry/magnitude.h"
#include "meshbound/error.h"
#include "meshbound/pose.h"
#include "numeric/rounding.h"

namespace meshbound {
namespace {

/// Rotations that are composed in doubles drift from orthonormal by about u a step; a matrix further off than this is a
/// mistake (a scale, a shear), not drift.
constexpr double max_drift = 1e-9;

/// Spectral norm of R^T R - I, bounded by the Frobenius norm plus the rounding of its 9 entries (3 products each).
double drift_of(const Pose& pose) {
  require_affine(pose.matrix(), "a pose");
  if (pose.linear() == Eigen::Matrix3d::Identity()) return 0;
  const double drift = (pose.linear().transpose() * pose.linear() - Eigen::Matrix3d::Identity()).norm();
  if (!(drift <= max_drift))
    throw InvalidInput(
        "a pose is not a rigid motion: its columns are not orthonormal; apply it to the vertices instead");
  return drift + 32 * unit_roundoff;
}

bool same_pose(const Pose& a, const Pose& b) { return a.matrix() == b.matrix(); }

/// The mapping between two models under one and the same pose: only their frames differ.
Mapping shift_and_scale(const Frame& from, const Frame& to, double drift) {
  Mapping map;
  const double scale = std::ldexp(1.0, from.exponent - to.exponent);
  map.translation = to.to_working(from.center);
  map.is_identity = scale == 1 && largest_magnitude_of(map.translation) == 0;
  map.rows[0] = {scale, 0, 0};
  map.rows[1] = {0, scale, 0};
  map.rows[2] = {0, 0, scale};
  map.magnitude = std::max(1.0, scale + largest_magnitude_of(map.translation));
  const bool exact = largest_magnitude_of(map.translation) == 0;
  map.error = (exact ? 0 : to.rounding_of(from.center) + 8 * unit_roundoff * map.magnitude) + 8 * drift * map.magnitude;
  return map;
}

}  // namespace

Mapping mapping_between(const Frame& from, const Pose& from_pose, const Frame& to, const Pose& to_pose) {
  check_floating_point_model();
  const double drift = drift_of(from_pose) + drift_of(to_pose);
  if (same_pose(from_pose, to_pose)) return shift_and_scale(from, to, drift);
  const Eigen::Matrix3d back = to_pose.linear().transpose();
  const Eigen::Matrix3d rotation = back * from_pose.linear();
  const Eigen::Vector3d offset = from_pose * to_eigen(from.center) - to_pose.translation();
  const Eigen::Vector3d moved = back * offset - to_eigen(to.center);
  Mapping map;
  map.is_identity = false;
  const double scale = std::ldexp(1.0, from.exponent - to.exponent);
  for (int row = 0; row < 3; ++row)
    map.rows[row] = {scale * rotation(row, 0), scale * rotation(row, 1), scale * rotation(row, 2)};
  map.translation = {std::ldexp(moved.x(), -to.exponent), std::ldexp(moved.y(), -to.exponent),
                     std::ldexp(moved.z(), -to.exponent)};
  map.magnitude = std::max(1.0, 2 * scale + largest_magnitude_of(map.translation));
  // Largest intermediate of the translation, target units: each of its at most 12 roundings costs u times that.
  const double reach = from_pose.translation().cwiseAbs().maxCoeff() + to_pose.translation().cwiseAbs().maxCoeff() +
                       2 * largest_magnitude_of(from.center) + 2 * largest_magnitude_of(to.center);
  const double total = map.magnitude + 2 * std::ldexp(reach, -to.exponent);
  // What underflows in model units, each time by half of 2^-1074: some 12 products, those of `offset` turned once more.
  map.error = (64 * unit_roundoff + 8 * drift) * total + std::ldexp(0x1p-1070, -to.exponent);
  return map;
}

}  // namespace meshbound
