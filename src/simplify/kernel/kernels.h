// SPDX-License-Identifier: MIT
#pragma once
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

/// The fastest implementation that this machine runs, and the one that any machine runs.
[[nodiscard]] SimplifyKernels simplify_kernels();
[[nodiscard]] SimplifyKernels portable_simplify_kernels();

}  // namespace meshbound
