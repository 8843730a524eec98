// SPDX-License-Identifier: MIT
#pragma once
#include <chrono>

#include "meshbound/stop_token.h"

namespace meshbound {

/// Seconds from `start` until now.
[[nodiscard]] inline double seconds_since(StopToken::Clock::time_point start) {
  return std::chrono::duration<double>(StopToken::Clock::now() - start).count();
}

}  // namespace meshbound
