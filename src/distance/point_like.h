// SPDX-License-Identifier: MIT
#pragma once
#include "distance/one_sided.h"

namespace meshbound {

/// Beyond this many of B's sizes (A's coordinates in B's frame) squared distances would leave the range of the float
/// boxes, and B is a point to 12 digits.
inline constexpr double largest_magnitude = 0x1p40;

/// h(A, B) for a B that is a point, or tiny beside A or its distance from it: the furthest vertex of A from B's centre,
/// give or take B's radius. O(vertices of A).
OneSidedDistance distance_to_point_like(const OneSidedTask& task);

}  // namespace meshbound
