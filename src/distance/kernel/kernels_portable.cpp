// SPDX-License-Identifier: MIT
#include "distance/kernel/search_kernel_impl.h"

namespace meshbound {

std::unique_ptr<SearchKernel> make_portable_search_kernel(const Bvh::Data& target, const Goal& goal) {
  return std::make_unique<SearchKernelImpl>(target, goal);
}

}  // namespace meshbound
