// SPDX-License-Identifier: MIT
/// OpenMP where there is one thread: what the core asks of it. Pragmas of OpenMP are ignored by a compiler without it.
#pragma once

inline int omp_get_max_threads() { return 1; }
inline int omp_get_num_threads() { return 1; }
inline int omp_get_thread_num() { return 0; }
inline int omp_get_level() { return 0; }
inline int omp_in_parallel() { return 0; }
inline void omp_set_num_threads(int) {}
