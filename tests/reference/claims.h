// SPDX-License-Identifier: MIT
/// What every result of the engine promises, as GoogleTest expectations.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "meshbound/distance.h"
#include "reference/exact_distance.h"

namespace meshbound::reference {

inline double largest_magnitude(const MeshView& mesh) {
  double largest = 0;
  for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
    for (const Eigen::Vector3d& corner : corners(mesh, i)) largest = std::max(largest, corner.cwiseAbs().maxCoeff());
  }
  return largest;
}

/// How far the position of a surface point may be off its triangle: it is rounded to doubles, and found by arithmetic
/// on centred coordinates that loses a few units in the last place.
inline double position_rounding(const MeshView& a, const MeshView& b) {
  constexpr double units = 64;
  return units * (std::numeric_limits<double>::epsilon() * std::max(largest_magnitude(a), largest_magnitude(b)) +
                  std::numeric_limits<double>::denorm_min());
}

/// How far the lower bound may stay below the witness: the slack of the engine's error model, far below any tolerance.
inline double bound_slack(const MeshView& a, const MeshView& b) {
  constexpr double units = 16384;
  return units / 64 * position_rounding(a, b);
}

/// The witness lies on both meshes, its second point is the nearest to its first, and together they realise `lower`.
inline void expect_witness(const MeshView& a, const MeshView& b, const OneSidedDistance& result) {
  const Witness& witness = result.witness;
  const double rounding = position_rounding(a, b);
  ASSERT_LT(witness.from.triangle, a.triangle_count());
  ASSERT_LT(witness.nearest.triangle, b.triangle_count());
  EXPECT_LE(exact_distance(witness.from.position, corners(a, witness.from.triangle)).compare(rounding), 0)
      << "the witness starts off its triangle";
  EXPECT_LE(exact_distance(witness.nearest.position, corners(b, witness.nearest.triangle)).compare(rounding), 0)
      << "the witness ends off its triangle";
  EXPECT_NEAR((witness.from.position - witness.nearest.position).stableNorm(), witness.distance, rounding);
  const double to_nearest = exact_distance(witness.from.position, b).approximate();
  EXPECT_NEAR(to_nearest, witness.distance, 2 * rounding) << "the witness ends at a point that is not the nearest";
  EXPECT_LE(result.bounds.lower, witness.distance + 2 * rounding) << "lower is not realised by the witness";
  EXPECT_GE(result.bounds.lower, witness.distance - bound_slack(a, b)) << "lower is far below its witness";
}

/// The interval meets another that holds the same number.
inline void expect_meets(const Bounds& bounds, const Bounds& truth) {
  EXPECT_LE(bounds.lower, bounds.upper);
  EXPECT_LE(bounds.lower, truth.upper) << "lower bound above the truth";
  EXPECT_GE(bounds.upper, truth.lower) << "upper bound below the truth";
}

}  // namespace meshbound::reference
