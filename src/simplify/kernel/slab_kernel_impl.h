// SPDX-License-Identifier: MIT
/// Compiled once per instruction set (numeric/isa.h).
#pragma once
#include "geometry/vec_lanes.h"
#include "numeric/simd.h"
#include "simplify/kernel/slab_kernel.h"

namespace meshbound {
inline namespace MESHBOUND_ISA {

inline SlabsSeen look_at_four(const SlabBlock& block, std::size_t first, const SlabView& view) {
  const auto lanes = [first](const double* values) { return *reinterpret_cast<const Double4*>(values + first); };
  const Vec<Double4> up = broadcast4(view.up);
  const Vec<Double4> normal{lanes(block.normal_x), lanes(block.normal_y), lanes(block.normal_z)};
  const Vec<Double4> q = Vec<Double4>{lanes(block.x), lanes(block.y), lanes(block.z)} - broadcast4(view.middle);
  const Double4 zero{}, one = broadcast4(1), rim = broadcast4(view.rim), limit = broadcast4(view.height_limit);
  const Double4 radius = lanes(block.radius), reach = radius + rim + rim;

  Double4 outside = dot(q, broadcast4(view.side[0])) - broadcast4(view.side_offset[0]);
  for (std::size_t k = 1; k < 3; ++k)
    outside = maximum(outside, dot(q, broadcast4(view.side[k])) - broadcast4(view.side_offset[k]));
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

inline void look_at_vertices(const Vec3* vertices, std::span<const std::uint32_t> indices, const SlabView& view,
                             std::uint64_t* seen) {
  using Bits4 = std::uint64_t __attribute__((vector_size(32)));
  const Vec<Double4> middle = broadcast4(view.middle), up = broadcast4(view.up);
  const std::array side{broadcast4(view.side[0]), broadcast4(view.side[1]), broadcast4(view.side[2])};
  const Double4 zero{}, rim = broadcast4(view.rim), limit = broadcast4(view.height_limit);
  for (std::size_t first = 0; first < indices.size(); first += 4) {
    const auto at = [&](std::size_t k) -> const Vec3& {
      return vertices[indices[first + k < indices.size() ? first + k : first]];
    };
    const Vec<Double4> q = gather4(at(0), at(1), at(2), at(3)) - middle;
    const Double4 h = dot(q, up);
    Bits4 bits{};
    const auto set = [&bits](Mask4 where, std::uint64_t bit) { bits |= reinterpret_cast<const Bits4&>(where) & bit; };
    set(maximum(h, zero - h) > limit, VertexSeen::too_high);
    set(h > limit + rim, VertexSeen::above);
    set(h < zero - limit - rim, VertexSeen::below);
    for (unsigned k = 0; k < 3; ++k) {
      const Double4 along = dot(q, side[k]);
      set(along - broadcast4(view.side_offset[k]) > rim, VertexSeen::first_side << k);
      set(along > rim, VertexSeen::first_beyond_middle << k);
      set(along < zero - rim, VertexSeen::first_before_middle << k);
    }
    *reinterpret_cast<Bits4*>(seen + first) = bits;
  }
}

}  // namespace MESHBOUND_ISA
}  // namespace meshbound
