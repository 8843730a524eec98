// SPDX-License-Identifier: MIT
/// Compiled once per instruction set (numeric/isa.h).
#pragma once
#include "simplify/kernel/deviation_kernel_impl.h"
#include "simplify/kernel/kernels.h"
#include "simplify/kernel/plane_kernel_impl.h"
#include "simplify/kernel/sample_kernel_impl.h"
#include "simplify/kernel/slab_kernel_impl.h"

namespace meshbound {
inline namespace MESHBOUND_ISA {

inline SimplifyKernels kernels_of_this_instruction_set() {
  return {{offsets, distances, add_deviations},
          {linearise, weighted_sums, largest_along},
          {set_planes, test_slab, reach_in_slabs},
          {look_at_slabs, look_at_vertices}};
}

}  // namespace MESHBOUND_ISA
}  // namespace meshbound
