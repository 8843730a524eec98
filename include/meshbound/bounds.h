// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <limits>

namespace meshbound {

/// An interval that contains a real number, in the units of the model. `lower <= value <= upper` holds in real
/// arithmetic: the rounding errors of the computation are included.
struct Bounds {
  double lower = 0;  ///< never above the value
  /// Never below the value; infinite where nothing is proven.
  double upper = std::numeric_limits<double>::infinity();
};

/// A point on the surface of a mesh.
struct SurfacePoint {
  /// Model units, in world coordinates where the model has a pose; on the triangle up to its own rounding.
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  std::uint32_t triangle = 0;  ///< index in the mesh as it was given
};

/// What realises a lower bound: a point of one mesh and the point of the other mesh that is closest to it.
struct Witness {
  SurfacePoint from;     ///< on the mesh that is searched
  SurfacePoint nearest;  ///< on the other one
  double distance = 0;   ///< the length between the two, rounded to nearest
};

/// Answer to "is the distance at most the tolerance?". `Within` is said only when `upper <= tolerance`, `Exceeds` only
/// when `lower > tolerance`; what a budget or the precision of doubles leaves open is `Undecided`.
enum class Verdict { Within, Exceeds, Undecided };

/// What an interval around a distance tells about a tolerance in the same unit. Nothing is within a tolerance that is
/// not a number.
[[nodiscard]] constexpr Verdict verdict_of(const Bounds& distance, double tolerance) {
  if (distance.upper <= tolerance) return Verdict::Within;
  return distance.lower > tolerance ? Verdict::Exceeds : Verdict::Undecided;
}

}  // namespace meshbound
