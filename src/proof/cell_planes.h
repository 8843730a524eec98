// SPDX-License-Identifier: MIT
/// The cell of a triangle of B, by which the engine and the certificate cut pieces of A: three half-spaces, each
/// through an edge and along the bisector of the normals on both sides of it. Compiled once per instruction set.
#pragma once
#include <algorithm>
#include <cmath>

#include "bvh/nearest.h"
#include "proof/piece.h"

namespace meshbound {
inline namespace MESHBOUND_ISA {

/// Lane k: the plane {x : normal . x = offset} through the edge from corner k to k + 1, with its unit normal pointing
/// outward, 0 where the edge has no direction. Lane 3 is unused.
struct CellPlanes {
  Vec<Double4> normal;
  Double4 offset;

  /// The distances of the corners of a piece from a plane that is pushed outward.
  [[nodiscard]] CornerDistances distances(const Piece& piece, int edge, double outward) const {
    return distances_from_plane(piece, {normal.x[edge], normal.y[edge], normal.z[edge]}, offset[edge] + outward);
  }
};

/// Whether a triangle without a normal is a segment: its corner c is at one of the ends of its longest edge.
[[nodiscard]] inline bool is_segment(const std::array<float, 3>& normal, const CornerTriangle<double>& t) {
  if (normal[0] != 0 || normal[1] != 0 || normal[2] != 0) return false;
  return squared_length(t.ac) == 0 || squared_length(t.ac - t.ab) == 0;
}

/// Lane k: what the plane through the edge from corner k to k + 1 runs along, beside the edge: the sum of the normals
/// on both sides of it.
inline Vec<Double4> bisectors(const Bvh::Data& b, std::uint32_t slot) {
  const auto& own = b.normals[slot];
  Vec<Double4> bisector{broadcast4(own[0]), broadcast4(own[1]), broadcast4(own[2])};
  for (int edge = 0; edge < 3; ++edge) {
    const Neighbour neighbour = b.neighbours[slot][static_cast<std::size_t>(edge)];
    if (neighbour.slot == no_slot) continue;
    const auto& other = b.normals[neighbour.slot];
    const double sign = neighbour.flipped != 0 ? -1 : 1;
    const Vec3 sum{own[0] + sign * other[0], own[1] + sign * other[1], own[2] + sign * other[2]};
    // Nearly folded back: the sum is rounding noise, and the plane across the triangle's own edge serves.
    if (squared_length(sum) < 1e-3) continue;
    bisector.x[edge] = sum.x;
    bisector.y[edge] = sum.y;
    bisector.z[edge] = sum.z;
  }
  return bisector;
}

/// The cell of triangle t of B at `slot`. That of a segment lies between the planes across it at its ends.
inline CellPlanes cell_planes(const Bvh::Data& b, std::uint32_t slot, const CornerTriangle<double>& t) {
  const Vec3 bc = t.ac - t.ab, from_b = t.a + t.ab, from_c = t.a + t.ac;
  const Vec<Double4> from{
      {t.a.x, from_b.x, from_c.x, 0}, {t.a.y, from_b.y, from_c.y, 0}, {t.a.z, from_b.z, from_c.z, 0}};
  CellPlanes planes;
  if (is_segment(b.normals[slot], t)) {
    const Vec3 middle = (1.0 / 3) * (t.ab + t.ac), to_b = t.ab - middle, to_c = t.ac - middle;
    planes.normal = {Double4{-middle.x, to_b.x, to_c.x, 0}, Double4{-middle.y, to_b.y, to_c.y, 0},
                     Double4{-middle.z, to_b.z, to_c.z, 0}};
  } else {
    const Vec<Double4> along{{t.ab.x, bc.x, -t.ac.x, 0}, {t.ab.y, bc.y, -t.ac.y, 0}, {t.ab.z, bc.z, -t.ac.z, 0}};
    planes.normal = cross(along, bisectors(b, slot));
  }
  const Double4 norm = square_root(squared_length(planes.normal));
  planes.normal = select(norm > 0.0, 1.0 / norm, Double4{}) * planes.normal;
  planes.offset = dot(planes.normal, from);
  return planes;
}

/// How far the cell of a piece's candidate t may be pushed outward so that most parts inside are still within the
/// target. A part at height h over the plane of t may lie sqrt(target^2 - h^2) sideways of t. Where two edges of t meet
/// at 30 degrees, pushing both planes by s moves the corner of the cell by s / sin(15 degrees) < 4 s: hence one quarter
/// of that room. Of shares between 0.1 and 0.85 it was the fastest for the engine on eight pairs. What still fails is
/// cut by the cell itself, where only the height counts.
[[nodiscard]] inline double outward_slack(const Bvh::Data& b, const Piece& piece, const CornerTriangle<double>& t,
                                          double accepted_squared) {
  const auto& n = b.normals[piece.slot];
  const CornerDistances heights =
      distances_from_plane(piece, {n[0], n[1], n[2]}, n[0] * t.a.x + n[1] * t.a.y + n[2] * t.a.z);
  const double highest = std::max(heights.max, -heights.min), room = accepted_squared - highest * highest;
  return room > 0 ? 0.25 * std::sqrt(room) : 0;
}

/// Corners this near to a plane, in units of the working frame, lie on it: cutting there would give parts without area.
inline constexpr double plane_noise = 1e-13;

}  // namespace MESHBOUND_ISA
}  // namespace meshbound
