// SPDX-License-Identifier: MIT
// Compiled with -mavx2 (src/CMakeLists.txt); only called where the processor has it.
#include "distance/kernel/search_kernel_impl.h"

namespace meshbound {

std::unique_ptr<SearchKernel> make_avx2_search_kernel(const Bvh::Data& target, const Goal& goal) {
  return std::make_unique<SearchKernelImpl>(target, goal);
}

}  // namespace meshbound
