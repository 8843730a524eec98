// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <atomic>
#include <chrono>
#include <limits>

#include "meshbound/error.h"

namespace meshbound {

/// Thrown where a computation ends by its `StopToken` before it has anything to return.
class Stopped : public Error {
  using Error::Error;
};

/// When a long computation ends early: at a point in time, or once a flag is set by another thread or a signal handler.
/// The default never stops. A look takes about 25 ns, so a loop of shorter steps looks once in a few of them. Any
/// number of threads may ask the same token.
struct StopToken {
  using Clock = std::chrono::steady_clock;  ///< never set back

  Clock::time_point deadline = Clock::time_point::max();  ///< the largest one: none
  const std::atomic<bool>* cancel = nullptr;              ///< may be null; must outlive the computation

  /// Whether the flag is set.
  [[nodiscard]] bool cancelled() const { return cancel != nullptr && cancel->load(std::memory_order_relaxed); }
  /// Whether the flag is set or the deadline has passed.
  [[nodiscard]] bool stopped() const {
    return cancelled() || (deadline != Clock::time_point::max() && Clock::now() >= deadline);
  }
  /// Throws `Stopped`.
  void check() const {
    if (stopped()) throw Stopped(cancelled() ? "cancelled" : "the time limit came");
  }
  /// Until the deadline: infinite without one, 0 from then on.
  [[nodiscard]] double seconds_left() const {
    if (deadline == Clock::time_point::max()) return std::numeric_limits<double>::infinity();
    return std::max(0.0, std::chrono::duration<double>(deadline - Clock::now()).count());
  }
  /// A token with this flag and the time that lies `seconds` after `from` as its deadline: `from` itself where they are
  /// negative or not a number, none where they are infinite.
  [[nodiscard]] StopToken until(Clock::time_point from, double seconds) const {
    StopToken token = *this;
    constexpr double no_limit = 1e9;  // seconds; about 30 years, and no overflow
    if (!(seconds > 0))
      token.deadline = from;
    else if (seconds < no_limit)
      token.deadline = from + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
    else
      token.deadline = Clock::time_point::max();
    return token;
  }
};

/// Seconds from `start` until now.
[[nodiscard]] inline double seconds_since(StopToken::Clock::time_point start) {
  return std::chrono::duration<double>(StopToken::Clock::now() - start).count();
}

}  // namespace meshbound
