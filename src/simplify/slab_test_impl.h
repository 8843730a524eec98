// SPDX-License-Identifier: MIT
/// Compiled once per instruction set.
#pragma once
#include "numeric/simd.h"
#include "simplify/plane_block.h"

namespace meshbound {
inline namespace MESHBOUND_ISA {

inline Double4 load4(const double* lanes) { return *reinterpret_cast<const Double4*>(lanes); }

inline SlabBits test_slab(const PlaneBlock& block, Vec3 p, double tolerance, double squared_reach) {
  const Double4 px = broadcast4(p.x), py = broadcast4(p.y), pz = broadcast4(p.z);
  const auto at = [&](int plane) {
    return load4(block.x[plane]) * px + load4(block.y[plane]) * py + load4(block.z[plane]) * pz +
           load4(block.offset[plane]);
  };
  const Double4 height = at(0);
  const Double4 outside = maximum(maximum(at(1), at(2)), at(3));
  const Mask4 in_slab = (height <= broadcast4(tolerance)) & (height >= broadcast4(-tolerance));
  const Mask4 inner = outside <= broadcast4(0);
  const Mask4 near = outside * outside + height * height <= broadcast4(squared_reach);
  return {lane_bits(in_slab & inner), lane_bits(in_slab & ~inner & near)};
}

}  // namespace MESHBOUND_ISA
}  // namespace meshbound
