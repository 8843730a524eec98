// SPDX-License-Identifier: MIT
#pragma once
#include "meshbound/distance.h"

namespace meshbound {

/// Beyond this many of B's sizes (A's coordinates in B's frame) squared distances would leave the range of the float
/// boxes, and B is a point to 12 digits.
inline constexpr double max_magnitude = 0x1p40;

/// h(A, B) for a B that is a point, or tiny beside A or its distance from it: the furthest vertex of A from a vertex of
/// B, give or take B's diagonal. All but the outcome and the time, which depend on what was asked. O(vertices of A).
[[nodiscard]] OneSidedDistance distance_to_point_like(const PlacedModel& a, const PlacedModel& b);

}  // namespace meshbound
