// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <cmath>

#include "bvh/nearest.h"
#include "proof/piece.h"

namespace meshbound {

/// A plane {x : normal . x = offset} with an outward unit normal, 0 where the edge has no direction.
struct CellPlane {
  Vec3 normal;
  double offset = 0;
};

/// Through the edge from corner `edge` to the next, along the bisector of the normals on both sides: the cell of the
/// triangle is inside its three planes.
inline CellPlane cell_plane(const Bvh::Data& b, std::uint32_t slot, const CornerTriangle<double>& t, std::size_t edge) {
  const Vec3 corners[3] = {t.a, t.a + t.ab, t.a + t.ac};
  const Vec3 from = corners[edge], along = corners[(edge + 1) % 3] - from;
  const auto& own = b.normals[slot];
  Vec3 bisector{own[0], own[1], own[2]};
  const Neighbour neighbour = b.neighbours[slot][edge];
  const auto& other = b.normals[neighbour.slot];
  const double sign = neighbour.flipped != 0 ? -1 : 1;
  const Vec3 sum = bisector + sign * Vec3{other[0], other[1], other[2]};
  // Nearly folded back, the sum is rounding noise, and the plane across the triangle's own edge serves.
  if (squared_length(sum) >= 1e-3) bisector = sum;
  CellPlane plane;
  plane.normal = cross(along, bisector);
  const double norm = length(plane.normal);
  plane.normal = (norm > 0 ? 1 / norm : 0.0) * plane.normal;
  plane.offset = dot(plane.normal, from);
  return plane;
}

/// How far the cell may be pushed outward so that most parts inside are still near enough
/// (distance/kernel/cell_walker.h).
inline double outward_slack(const Bvh::Data& b, const Piece& piece, double accepted_squared) {
  const auto& n = b.normals[piece.slot];
  const Vec3 a = triangle_at(b, piece.slot).a;
  const PlaneSides heights = sides_of(piece, {n[0], n[1], n[2]}, n[0] * a.x + n[1] * a.y + n[2] * a.z);
  const double highest = std::max(heights.max, -heights.min), room = accepted_squared - highest * highest;
  return room > 0 ? 0.5 * std::sqrt(room) : 0;
}

}  // namespace meshbound
