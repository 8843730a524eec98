// SPDX-License-Identifier: MIT
/// Boxes of children in a node: floats, rounded outward. Compiled once per instruction set.
#pragma once
#include <cstdint>
#include <limits>

#include "bvh/bvh_data.h"
#include "numeric/simd.h"

namespace meshbound {
inline namespace MESHBOUND_ISA {
/// Floats that are not above these numbers, by at most two steps below them. Without a branch, which would be guessed
/// wrong half the time.
inline Float4 rounded_down(const Double4& x) {
  const auto f = __builtin_convertvector(x, Float4);
  const Float4 size = f < 0 ? -f : f, step = size * 0x1p-23F + std::numeric_limits<float>::min();
  const auto is_above = __builtin_convertvector(__builtin_convertvector(f, Double4) > x, decltype(f < f));
  return f - (is_above ? step : Float4{});
}

/// Sets the box of a child; lane 3 of its corners is unused.
inline void set_child(BvhNode& node, std::uint32_t child, const Double4& box_lo, const Double4& box_hi) {
  const Float4 lo = rounded_down(box_lo), hi = -rounded_down(-box_hi);
  for (int axis = 0; axis < 3; ++axis) {
    node.lo[axis][child] = lo[axis];
    node.hi[axis][child] = hi[axis];
  }
}

inline void set_empty(BvhNode& node, std::uint32_t child) {
  for (int axis = 0; axis < 3; ++axis) {
    node.lo[axis][child] = std::numeric_limits<float>::infinity();
    node.hi[axis][child] = -std::numeric_limits<float>::infinity();
  }
}

}  // namespace MESHBOUND_ISA
}  // namespace meshbound
