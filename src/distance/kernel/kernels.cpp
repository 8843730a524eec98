// SPDX-License-Identifier: MIT
// The choice among the kernels of a search, by processor.
#include "distance/kernel/search_kernel.h"
#include "numeric/rounding.h"
#include "numeric/vector_code.h"

namespace meshbound {

std::unique_ptr<SearchKernel> make_portable_search_kernel(const Bvh::Data& target, const Goal& goal);
std::unique_ptr<SearchKernel> make_avx2_search_kernel(const Bvh::Data& target, const Goal& goal);

std::unique_ptr<SearchKernel> make_search_kernel(const Bvh::Data& target, const Goal& goal) {
#if defined(MESHBOUND_HAS_AVX2)
  if (uses_avx2()) return make_avx2_search_kernel(target, goal);
#endif
  return make_portable_search_kernel(target, goal);
}

void set_slack(Goal& goal, double magnitude, double model_error) {
  goal.slack = ((primal_error + dual_error) * magnitude + model_error) * (1 + 4 * unit_roundoff);
  goal.cut_slack = cut_error * magnitude;
  goal.magnitude = magnitude;
}

}  // namespace meshbound
