// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <limits>

namespace meshbound {

/// An interval that contains a real number, in the units of the model. `lower <= value <= upper` holds in real
/// arithmetic: the rounding errors of the computation are included.
struct Bounds {
  double lower = 0;
  double upper = std::numeric_limits<double>::infinity();
};

/// A point on the surface of a mesh: on triangle `triangle`, up to the rounding of `position` itself.
struct SurfacePoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  std::uint32_t triangle = 0;
};

/// What realises a lower bound: a point of one mesh and the point of the other mesh that is closest to it.
/// `distance` is the length between the two, rounded to nearest.
struct Witness {
  SurfacePoint from;
  SurfacePoint nearest;
  double distance = 0;
};

/// Answer to "is the distance at most the tolerance?". `Within` is said only when `upper <= tolerance`, `Exceeds` only
/// when `lower > tolerance`; what a budget or the precision of doubles leaves open is `Undecided`.
enum class Verdict { Within, Exceeds, Undecided };

}  // namespace meshbound
