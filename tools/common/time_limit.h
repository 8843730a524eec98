// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <limits>

#include "common/signals.h"
#include "common/stopwatch.h"
#include "common/tool_main.h"
#include "meshbound/stop_token.h"

namespace meshbound::tools {

/// Seconds that preparing an answer which is given at once may go on after the time limit: a limit of 0 asks for what
/// can be said without any search. Files that are read in so many seconds are read, however late it is.
inline constexpr double patience = 0.2;

/// Stops at a signal, and at the time limit, or `later` seconds after it. `watch` was started with the run.
[[nodiscard]] inline StopToken stop_of_run(const CommonOptions& options, const Stopwatch& watch, double later = 0) {
  const StopToken signals{.cancel = &interrupted()};
  return options.has_time_limit ? signals.until(watch.start(), options.time_limit + later) : signals;
}

/// Seconds of the time limit that are left, 0 after it, infinite without one.
[[nodiscard]] inline double seconds_left(const CommonOptions& options, const Stopwatch& watch) {
  return options.has_time_limit ? std::max(0.0, options.time_limit - watch.seconds())
                                : std::numeric_limits<double>::infinity();
}

/// The token for reading files from here on.
[[nodiscard]] inline StopToken stop_of_reading(const CommonOptions& options, const Stopwatch& watch) {
  return stop_of_run(options, watch, patience + std::max(0.0, watch.seconds() - options.time_limit));
}

}  // namespace meshbound::tools
