// SPDX-License-Identifier: MIT
#pragma once
#include <vector>

#include "simplify/kernel/deviation_kernel.h"
#include "simplify/kernel/plane_kernel.h"
#include "simplify/kernel/sample_kernel.h"
#include "simplify/kernel/slab_kernel.h"

namespace meshbound {

/// The inner loops of the simplifier, compiled once per instruction set from the sources `*_kernel_impl.h`. All
/// implementations give the same results to the bit.
struct SimplifyKernels {
  SampleKernel samples;
  DeviationKernel deviations;
  PlaneKernel planes;
  SlabKernel slabs;
};

/// All that this machine runs, the fastest ones first and the portable ones last.
[[nodiscard]] std::vector<SimplifyKernels> all_simplify_kernels();
[[nodiscard]] SimplifyKernels simplify_kernels();  ///< the fastest ones

}  // namespace meshbound
