// SPDX-License-Identifier: MIT
/// Lengths in exact arithmetic: squares of distances as fractions of integers, and the doubles next to their roots.
#pragma once
#include <gmpxx.h>

#include <array>

#include "meshbound/bounds.h"
#include "penetration/exact_point.h"

namespace meshbound {

/// numerator / denominator, the denominator positive; not reduced.
struct SquaredLength {
  mpz_class numerator, denominator;
};

[[nodiscard]] bool operator<(const SquaredLength& a, const SquaredLength& b);

/// From p to the segment between q and r, which may be equal.
[[nodiscard]] SquaredLength squared_distance_to_segment(const ExactPoint& p, const ExactPoint& q, const ExactPoint& r);

/// From p to a triangle, which may be a segment or a point.
[[nodiscard]] SquaredLength squared_distance_to_triangle(const ExactPoint& p, const std::array<ExactPoint, 3>& corners);

/// The doubles around the root of `squared` in units of 2^`unit`: both are the root where it is a double.
[[nodiscard]] Bounds root_bounds(const SquaredLength& squared, int unit);

}  // namespace meshbound
