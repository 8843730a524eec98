// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>

#include "geometry/vec3.h"

namespace meshbound {

/// The planes of four triangles, lane by lane: [0] through the triangle, [1] to [3] through its sides, outward.
struct alignas(32) PlaneBlock {
  static constexpr int lanes = 4, planes = 4;
  double x[planes][lanes], y[planes][lanes], z[planes][lanes], offset[planes][lanes];

  void set(int lane, int plane, Vec3 normal, Vec3 through) {
    x[plane][lane] = normal.x;
    y[plane][lane] = normal.y;
    z[plane][lane] = normal.z;
    offset[plane][lane] = -dot(normal, through);
  }
  /// Signed distance of p from a plane.
  [[nodiscard]] double at(int lane, int plane, Vec3 p) const {
    return x[plane][lane] * p.x + y[plane][lane] * p.y + z[plane][lane] * p.z + offset[plane][lane];
  }
};

/// Bits of the four lanes: in the slab of `tolerance` around the triangle's plane and, of these,
struct SlabBits {
  unsigned inside;   ///< on the inner side of all three sides
  unsigned outside;  ///< outside by less than the tolerance, as far as the planes can tell
};

/// `squared_reach` is the square of the tolerance and of the room for the inaccuracy of the planes.
using SlabTest = SlabBits (*)(const PlaneBlock& block, Vec3 p, double tolerance, double squared_reach);

/// The test for this machine: AVX2 or portable, with the same results.
[[nodiscard]] SlabTest slab_test();

}  // namespace meshbound
