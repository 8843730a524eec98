// SPDX-License-Identifier: MIT
#pragma once
#include <time.h>

namespace meshbound::bench {

/// Seconds on a clock of the processor, such as CLOCK_PROCESS_CPUTIME_ID or CLOCK_THREAD_CPUTIME_ID; 0 where there is
/// no such clock any more.
inline double processor_seconds(clockid_t clock) {
  timespec now{};
  if (::clock_gettime(clock, &now) != 0) return 0;
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace meshbound::bench
