// SPDX-License-Identifier: MIT
/// Compiled once per instruction set (numeric/isa.h).
#pragma once
#include <utility>

#include "geometry/triangle_corners.h"
#include "geometry/vec_lanes.h"
#include "numeric/rounding.h"
#include "numeric/simd.h"
#include "simplify/kernel/plane_kernel.h"

namespace meshbound {
inline namespace MESHBOUND_ISA {

inline Double4 load4(const double* lanes) { return *reinterpret_cast<const Double4*>(lanes); }
inline void store4(double* lanes, Double4 values) { *reinterpret_cast<Double4*>(lanes) = values; }

inline Double4 plane_at(const PlaneBlock& block, int plane, Double4 x, Double4 y, Double4 z) {
  return load4(block.x[plane]) * x + load4(block.y[plane]) * y + load4(block.z[plane]) * z + load4(block.offset[plane]);
}

inline Vec<Double4> corner_lanes(const TriangleCorners* t, std::size_t k) {
  return gather4(t[0][k], t[1][k], t[2][k], t[3][k]);
}

inline void store_plane(PlaneBlock& block, int plane, const Vec<Double4>& normal, const Vec<Double4>& through,
                        Mask4 used) {
  const Double4 none = broadcast4(0);
  store4(block.x[plane], select(used, normal.x, none));
  store4(block.y[plane], select(used, normal.y, none));
  store4(block.z[plane], select(used, normal.z, none));
  store4(block.offset[plane], select(used, -dot(normal, through), none));
}

/// A cross product of computed edges is off by at most 8u |ab| |ac| in length, so the unit normal turns by at most
/// 8u longest^2 / area and a side plane by twice that; at the distance of a point of the slab that is a displacement
/// of 24u (longest + tolerance) longest^2 / area in all. Beyond the slack, or at zero area, the planes are not used.
inline unsigned set_planes(PlaneBlock& block, const TriangleCorners* triangles, double tolerance, double slack) {
  const Vec<Double4> a = corner_lanes(triangles, 0), b = corner_lanes(triangles, 1), c = corner_lanes(triangles, 2);
  const Vec<Double4> ab = b - a, ac = c - a, bc = c - b, ca = a - c;
  const Vec<Double4> normal = cross(ab, ac);
  const Double4 area = square_root(dot(normal, normal));
  const Double4 ab_length = square_root(dot(ab, ab)), bc_length = square_root(dot(bc, bc)),
                ca_length = square_root(dot(ca, ca));
  const Double4 longest = maximum(maximum(ab_length, bc_length), ca_length);
  const Double4 displacement = broadcast4(24 * unit_roundoff) * (longest + broadcast4(tolerance)) * longest * longest;
  const Mask4 flat = displacement < broadcast4(slack) * area;
  const Double4 one = broadcast4(1);
  const Vec<Double4> unit = (one / area) * normal;
  store_plane(block, PlaneBlock::face, unit, a, flat);
  store_plane(block, PlaneBlock::sides, (one / ab_length) * cross(ab, unit), a, flat);
  store_plane(block, PlaneBlock::sides + 1, (one / bc_length) * cross(bc, unit), b, flat);
  store_plane(block, PlaneBlock::sides + 2, (one / ca_length) * cross(ca, unit), c, flat);
  return lane_bits(flat);
}

inline SlabBits test_slab(const PlaneBlock& block, Vec3 p, double tolerance, double squared_reach) {
  const Double4 px = broadcast4(p.x), py = broadcast4(p.y), pz = broadcast4(p.z);
  const auto at = [&](int plane) { return plane_at(block, plane, px, py, pz); };
  const Double4 height = at(PlaneBlock::face);
  const Double4 outside = maximum(maximum(at(1), at(2)), at(3));
  const Mask4 in_slab = (height <= broadcast4(tolerance)) & (height >= broadcast4(-tolerance));
  const Mask4 inner = outside <= broadcast4(0);
  const Mask4 near = outside * outside + height * height <= broadcast4(squared_reach);
  return {lane_bits(in_slab & inner), lane_bits(in_slab & ~inner & near)};
}

/// Lanes that are asked for the way back have the values at p and q swapped.
inline Reach reach_in_slabs(const PlaneBlock& block, unsigned lanes_of_p, unsigned lanes_of_q, Vec3 p, Vec3 q,
                            double tolerance, double rim) {
  const Mask4 back = mask_of_lanes(lanes_of_q);
  const auto from_and_to = [&](double at_p, double at_q) {
    const Double4 first = broadcast4(at_p), second = broadcast4(at_q);
    return std::pair(select(back, second, first), select(back, first, second));
  };
  const auto [px, qx] = from_and_to(p.x, q.x);
  const auto [py, qy] = from_and_to(p.y, q.y);
  const auto [pz, qz] = from_and_to(p.z, q.z);
  const Double4 one = broadcast4(1), none = broadcast4(0), far = broadcast4(rim), high = broadcast4(tolerance);
  Double4 share = one;
  for (int side = PlaneBlock::sides; side < PlaneBlock::planes; ++side) {
    const Double4 from = plane_at(block, side, px, py, pz), to = plane_at(block, side, qx, qy, qz);
    const Double4 leaves = select(from >= far, none, (far - from) / (to - from));
    share = select(to > far, minimum(leaves, share), share);
  }
  const Double4 from = plane_at(block, PlaneBlock::face, px, py, pz),
                to = plane_at(block, PlaneBlock::face, qx, qy, qz);
  const Double4 level = select(to > none, high, -high);
  share = select((to > high) | (to < -high), minimum((level - from) / (to - from), share), share);
  const auto largest = [&](Mask4 lanes) { return horizontal_maximum(maximum(select(lanes, share, none), none)); };
  return {largest(mask_of_lanes(lanes_of_p)), largest(back)};
}

}  // namespace MESHBOUND_ISA
}  // namespace meshbound
