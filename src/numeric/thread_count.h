// SPDX-License-Identifier: MIT
#pragma once
#include <omp.h>

#include <algorithm>

namespace meshbound {

/// Threads that are started at most, however many an option asks for: more gain nothing, and the process might end
/// where the system has no room for their stacks.
inline constexpr int max_threads = 4096;

/// The number of threads for an option, of which 0 stands for as many as OpenMP has.
inline int thread_count(int wanted) { return wanted > 0 ? std::min(wanted, max_threads) : omp_get_max_threads(); }

}  // namespace meshbound
