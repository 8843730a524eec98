// SPDX-License-Identifier: MIT
/// The one-sided Hausdorff distance between small soups, enclosed by exact lengths.
#pragma once
#include "meshbound/bounds.h"
#include "meshbound/triangle_mesh.h"
#include "reference/exact_distance.h"

namespace meshbound::fuzz {

/// Exact lengths with `lower <= h(A,B) <= upper`. A corner or the middle of an edge of A is a point of A. The distance
/// to one triangle is convex, so that on a triangle of A, or on each of the four that the middles of its edges make of
/// it, it is largest at a corner.
struct Enclosure {
  reference::ExactLength lower{0, 1, 0}, upper{0, 1, 0};
};

/// O(n m).
[[nodiscard]] Enclosure enclosure(const TriangleMesh& a, const TriangleMesh& b);

/// Throws `std::logic_error` where the bounds cannot be those of what is enclosed.
void check_bounds(const Bounds& bounds, const Enclosure& exact);

}  // namespace meshbound::fuzz
