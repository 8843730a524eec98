// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>

#include "common/signals.h"
#include "common/stopwatch.h"
#include "common/tool_main.h"
#include "meshbound/stop_token.h"

namespace meshbound::tools {

/// Seconds that preparing an answer which is given at once may go on after the time limit: a limit of 0 asks for what
/// can be said without any search. Files that are read in so many seconds are read, however late it is.
inline constexpr double patience = 0.2;

/// The time of a run of a tool, from its construction on, and when the run is to end.
class RunClock : public Stopwatch {
 public:
  explicit RunClock(const CommonOptions& options) : time_limit_(options.time_limit) {}

  /// Seconds of this share of the time limit that are left, 0 after it, infinite without one.
  [[nodiscard]] double seconds_left(double share = 1) const { return std::max(0.0, share * time_limit_ - seconds()); }
  /// Stops at a signal, and at the time limit, or `later` seconds after it.
  [[nodiscard]] StopToken stop(double later = 0) const { return stop_at_signal().until(start(), time_limit_ + later); }
  /// For reading files from here on.
  [[nodiscard]] StopToken stop_of_reading() const { return stop(patience + std::max(0.0, seconds() - time_limit_)); }

 private:
  double time_limit_;
};

}  // namespace meshbound::tools
