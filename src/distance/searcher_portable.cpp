// SPDX-License-Identifier: MIT
#include "distance/searcher_impl.h"

namespace meshbound {

std::unique_ptr<Searcher> make_portable_searcher(const Bvh::Data& target, const Goal& goal) {
  return std::make_unique<SearcherImpl>(target, goal);
}

}  // namespace meshbound
