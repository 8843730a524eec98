// SPDX-License-Identifier: MIT
#include "meshbound/floating_point_scope.h"

#include <omp.h>

#include <algorithm>

namespace meshbound {

// Flush-to-zero and the rounding mode are part of the floating-point environment of <cfenv>. The OpenMP of clang gives
// the calling thread at the end of a parallel region the environment that it had at its beginning, and the threads of
// the next region that of the calling thread. So that is set outside of regions.

FloatingPointScope::FloatingPointScope(int threads) {
  std::fenv_t own;
  std::fegetenv(&own);
  threads = std::max(threads, omp_get_max_threads());
  before_.assign(static_cast<std::size_t>(threads), own);  // OpenMP may give fewer than asked for
#pragma omp parallel num_threads(static_cast <int>(before_.size()))
  {
    std::fegetenv(&before_[static_cast<std::size_t>(omp_get_thread_num())]);
    std::fesetenv(FE_DFL_ENV);
  }
  std::fesetenv(FE_DFL_ENV);
}

FloatingPointScope::~FloatingPointScope() {
#pragma omp parallel num_threads(static_cast <int>(before_.size()))
  std::fesetenv(&before_[static_cast<std::size_t>(omp_get_thread_num())]);
  std::fesetenv(&before_[0]);
}

}  // namespace meshbound
