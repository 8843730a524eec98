// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>

#include "geometry/triangle_corners.h"
#include "geometry/vec3.h"

namespace meshbound {

/// The planes of four triangles, lane by lane: [0] through the triangle, [1] to [3] through its sides, outward.
struct alignas(32) PlaneBlock {
  static constexpr int lanes = 4, planes = 4;
  static constexpr int face = 0, sides = 1;  ///< indices of planes
  double x[planes][lanes], y[planes][lanes], z[planes][lanes], offset[planes][lanes];
};

/// Where a point lies relative to four triangles, a bit for each lane. Points that are not in the slab of `tolerance`
/// around the triangle's plane have neither bit.
struct SlabBits {
  unsigned inside;   ///< in the slab, on the inner side of all three sides
  unsigned outside;  ///< in the slab, outside a side by less than the tolerance, as far as the planes can tell
};

/// Shares of a way and of the way back.
struct Reach {
  double forth = 0, back = 0;
};

/// What is asked of a block of planes, see `SimplifyKernels`.
struct PlaneKernel {
  /// Makes the planes of four triangles. Returns the lanes where they are accurate: where they are displaced by less
  /// than `slack`, a length, at any point that is within `tolerance` of the triangle. The planes of the others are 0.
  unsigned (*set)(PlaneBlock& block, const TriangleCorners* triangles, double tolerance, double slack);

  /// `squared_reach` is the square of the tolerance and of the room for the inaccuracy of the planes.
  SlabBits (*test)(const PlaneBlock& block, Vec3 p, double tolerance, double squared_reach);

  /// How far one can go from p towards q before one is higher than `tolerance` above a triangle or further than `rim`
  /// beyond a side of it: the largest share of the way among the triangles of `lanes_of_p`, and of the way back from q
  /// among those of `lanes_of_q`. A guess.
  Reach (*reach)(const PlaneBlock& block, unsigned lanes_of_p, unsigned lanes_of_q, Vec3 p, Vec3 q, double tolerance,
                 double rim);
};

}  // namespace meshbound
