// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Geometry>

#include "geometry/frame.h"
#include "geometry/vec3.h"
#include "meshbound/pose.h"

namespace meshbound {

/// Takes points from the working frame of one placed model into that of another.
struct Mapping {
  Vec3 rows[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};  ///< rotation times scale
  Vec3 translation;
  bool is_identity = true;
  /// Largest coordinate of the mapped model, at least 1: the M of numeric/rounding.h.
  double magnitude = 1;
  /// How much mapping may change a distance: rounding of the map and of its coefficients, and the deviation of the
  /// poses from rigid motions. Length in units of the target frame.
  double error = 0;

  [[nodiscard]] Vec3 operator()(const Vec3& p) const {
    if (is_identity) return p;
    return {dot(rows[0], p) + translation.x, dot(rows[1], p) + translation.y, dot(rows[2], p) + translation.z};
  }
};

/// From working coordinates of a model in `from` posed by `from_pose` to those of a model in `to` posed by `to_pose`.
/// Throws `InvalidInput` when a pose is not a rigid motion.
Mapping mapping_between(const Frame& from, const Pose& from_pose, const Frame& to, const Pose& to_pose);

}  // namespace meshbound
