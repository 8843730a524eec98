// SPDX-License-Identifier: MIT
#pragma once
#include <meshbound.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <optional>

#include "cancel.h"

namespace meshbound::c_interface {

/// The flag and the progress function of one call. A progress function that asks to end the call ends this one only,
/// not others with the same `mb_cancel`. For the thread of the call, except that the flag may be read from anywhere.
class RunControl {
 public:
  /// Takes them from options of any kind that have `cancel`, `progress` and `user`.
  template <class Options>
  explicit RunControl(const Options& options) : RunControl(options.cancel, options.progress, options.user) {}
  RunControl(mb_cancel* cancel, mb_progress function, void* user);
  RunControl(const RunControl&) = delete;
  RunControl& operator=(const RunControl&) = delete;
  ~RunControl();

  [[nodiscard]] const std::atomic<bool>* flag() const { return flag_; }

  /// The progress function for the library; empty if the caller gave none. Must not outlive this.
  [[nodiscard]] std::function<void(double)> progress();

  /// To be called when the work is done: tells the caller's progress function 1 if it has not been told that, and
  /// throws `Interrupted` if the flag is set, so that no result of a cancelled call is handed out.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;

  void report(double fraction);
  void tell(double fraction);

  std::atomic<bool> own_ = false;
  CallFlag* taken_ = nullptr;  ///< from the caller's `mb_cancel`, for calls that have a progress function too
  std::atomic<bool>* flag_ = &own_;
  mb_progress progress_;
  void* user_;
  std::optional<Clock::time_point> told_at_;
  std::optional<double> told_;  ///< the last fraction
};

}  // namespace meshbound::c_interface
