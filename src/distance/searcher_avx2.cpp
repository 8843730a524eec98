// SPDX-License-Identifier: MIT
// Compiled with -mavx2 (src/CMakeLists.txt); only called where the processor has it.
#include "distance/searcher_impl.h"

namespace meshbound {

std::unique_ptr<Searcher> make_avx2_searcher(const Bvh::Data& target, const Goal& goal) {
  return std::make_unique<SearcherImpl>(target, goal);
}

}  // namespace meshbound
