// SPDX-License-Identifier: MIT
/// Compiled once per instruction set (numeric/isa.h).
#pragma once
#include "numeric/simd.h"
#include "simplify/kernel/slab_kernel.h"

namespace meshbound {
inline namespace MESHBOUND_ISA {

inline Vec<Double4> broadcast_vector(Vec3 v) { return {broadcast4(v.x), broadcast4(v.y), broadcast4(v.z)}; }

inline SlabsSeen look_at_four(const SlabBlock& block, std::size_t first, const SlabView& view) {
  const auto lanes = [first](const double* values) { return *reinterpret_cast<const Double4*>(values + first); };
  const Vec<Double4> up = broadcast_vector(view.up);
  const Vec<Double4> normal{lanes(block.normal_x), lanes(block.normal_y), lanes(block.normal_z)};
  const Vec<Double4> q = Vec<Double4>{lanes(block.x), lanes(block.y), lanes(block.z)} - broadcast_vector(view.middle);
  const Double4 zero{}, one = broadcast4(1), rim = broadcast4(view.rim), limit = broadcast4(view.height_limit);
  const Double4 radius = lanes(block.radius), reach = radius + rim + rim;

  Double4 outside = dot(q, broadcast_vector(view.side[0])) - broadcast4(view.side_offset[0]);
  for (std::size_t k = 1; k < 3; ++k)
    outside = maximum(outside, dot(q, broadcast_vector(view.side[k])) - broadcast4(view.side_offset[k]));
  const Double4 up_q = dot(q, up), height = maximum(up_q, zero - up_q);
  const Double4 cosine = dot(normal, up);
  const Double4 sine = square_root(maximum(zero, one - cosine * cosine) + broadcast4(squared_sine_error));
  const Double4 extent = minimum(radius, radius * sine + lanes(block.half_thickness));
  const Vec<Double4> aside = q - up_q * up;
  const unsigned meets = lane_bits(outside <= reach) & lane_bits(height - extent <= limit + rim + rim);
  const unsigned within = lane_bits(height + extent + rim <= limit) & lane_bits(dot(aside, aside) > reach * reach);
  return {meets, meets & within};
}

/// Balls and heights carry errors that are less than the rim: a tree has 11 levels, and each adds less than 2^-49 of
/// the largest coordinate.
inline SlabsSeen look_at_slabs(const SlabBlock& block, const SlabView& view) {
  const SlabsSeen low = look_at_four(block, 0, view), high = look_at_four(block, 4, view);
  return {low.meets | high.meets << 4, low.within | high.within << 4};
}

}  // namespace MESHBOUND_ISA
}  // namespace meshbound
