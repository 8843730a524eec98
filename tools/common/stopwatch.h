// SPDX-License-Identifier: MIT
#pragma once
#include <utility>

#include "meshbound/stop_token.h"

namespace meshbound::tools {

class Stopwatch {
 public:
  [[nodiscard]] double seconds() const { return seconds_since(start_); }
  [[nodiscard]] StopToken::Clock::time_point start() const { return start_; }
  /// Seconds since the last lap.
  double lap() {
    const double now = seconds();
    return now - std::exchange(last_, now);
  }

 private:
  StopToken::Clock::time_point start_ = StopToken::Clock::now();
  double last_ = 0;
};

}  // namespace meshbound::tools
