// SPDX-License-Identifier: MIT
#include "distance/searcher.h"

#include "distance/cell_walker.h"
#include "numeric/rounding.h"

namespace meshbound {

std::unique_ptr<Searcher> make_portable_searcher(const Bvh::Data& target, const Goal& goal);
std::unique_ptr<Searcher> make_avx2_searcher(const Bvh::Data& target, const Goal& goal);

std::unique_ptr<Searcher> make_searcher(const Bvh::Data& target, const Goal& goal) {
#if defined(MESHBOUND_HAS_AVX2)
  if (__builtin_cpu_supports("avx2")) return make_avx2_searcher(target, goal);
#endif
  return make_portable_searcher(target, goal);
}

double search_slack(double magnitude, double model_error) {
  const double computed = (primal_error + dual_error + deepest_cut * cut_error) * magnitude;
  return (computed + model_error) * (1 + 4 * unit_roundoff);
}

}  // namespace meshbound
