// SPDX-License-Identifier: MIT
/// Culling on B: the bounds of h(T, B) for a triangle T of A, from one traversal for its three corners. Paper, Lemma 2,
/// Eq. 10-13 and Algorithm 2. Compiled once per instruction set.
#pragma once
#include <algorithm>
#include <limits>

#include "distance/paper/group_bounds.h"
#include "geometry/triangle_corners.h"

namespace meshbound {

inline namespace MESHBOUND_ISA {

/// The twelve distances between three corners and a block of four triangles.
inline void test_block(const Bvh::Data& data, std::uint32_t block, const TriangleCorners& corners,
                       GroupBounds& bounds) {
  const CornerTriangle<Double4> t = triangles_of_block(data, block);
  const std::uint32_t first = block * block_width, last = data.triangle_count() - 1;
  Double4 squared[3];
  for (int k = 0; k < 3; ++k) squared[k] = closest_on_triangle(t, broadcast4(corners[k])).squared_distance;
  const Double4 farthest = maximum(squared[0], maximum(squared[1], squared[2]));
  for (std::uint32_t lane = 0; lane < block_width; ++lane) {
    const std::uint32_t slot = std::min(first + lane, last);
    for (int k = 0; k < 3; ++k)
      if (squared[k][lane] < bounds.nearest[k].squared) bounds.nearest[k] = {squared[k][lane], slot};
    if (farthest[lane] < bounds.upper.squared) bounds.upper = {farthest[lane], slot};
  }
}

/// Visits the blocks of B whose box lies within a distance of the box of T, which `on_block` may lower. With the upper
/// bound of h(T, B) as that distance it is the culling condition of section 4.2: where d(T, BV) exceeds it, no triangle
/// can change a bound.
template <class OnBlock>
void visit_near_triangle(const Bvh::Data& data, const TriangleCorners& corners, double limit_squared,
                         QueryCounters& counters, OnBlock&& on_block) {
  const auto [a, b, c] = corners;
  const Vec3 lo{std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y}), std::min({a.z, b.z, c.z})};
  const Vec3 hi{std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y}), std::max({a.z, b.z, c.z})};
  ++counters.queries;
  visit_near(data, FloatQuery(lo, hi), limit_squared, counters, [&](std::uint32_t block) {
    counters.triangles += block_width;
    return on_block(block);
  });
}

/// Improves `bounds` by all of B; returns early, with the nearest triangles incomplete, once the upper bound is within
/// `enough_squared`.
inline void group_traversal(const Bvh::Data& data, const TriangleCorners& corners, double enough_squared,
                            GroupBounds& bounds, QueryCounters& counters) {
  if (bounds.upper.squared <= enough_squared) return;
  visit_near_triangle(data, corners, bounds.upper.squared, counters, [&](std::uint32_t block) {
    test_block(data, block, corners, bounds);
    return bounds.upper.squared <= enough_squared ? -1.0 : bounds.upper.squared;
  });
}

}  // namespace MESHBOUND_ISA
}  // namespace meshbound
