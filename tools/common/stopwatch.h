// SPDX-License-Identifier: MIT
#pragma once
#include <chrono>
#include <utility>

namespace meshbound::tools {

class Stopwatch {
 public:
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  /// Seconds since the last lap.
  double lap() {
    const double now = seconds();
    return now - std::exchange(last_, now);
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  double last_ = 0;
};

}  // namespace meshbound::tools
