// SPDX-License-Identifier: MIT
#pragma once
#include <meshbound.h>

#include <atomic>
#include <functional>

#include "meshbound/error.h"

/// The flag behind the opaque structure of C callers.
struct mb_cancel {
  std::atomic<bool> requested = false;
};

namespace meshbound::c_interface {

/// The flag and the progress function of one call. A progress function that asks to end the call sets the caller's
/// flag, or one of its own if the caller gave none.
class RunControl {
 public:
  /// Takes them from options of any kind that have `cancel`, `progress` and `user`.
  template <class Options>
  explicit RunControl(const Options& options)
      : flag_(options.cancel != nullptr ? &options.cancel->requested : &own_),
        progress_(options.progress),
        user_(options.user) {}
  RunControl(const RunControl&) = delete;
  RunControl& operator=(const RunControl&) = delete;

  [[nodiscard]] const std::atomic<bool>* flag() const { return flag_; }

  /// The progress function for the library; empty if the caller gave none. Must not outlive this.
  [[nodiscard]] std::function<void(double)> progress() {
    if (progress_ == nullptr) return {};
    return [this](double fraction) {
      if (progress_(fraction, user_) != 0) *flag_ = true;
    };
  }

  /// Throws `Interrupted` if the flag is set, so that no result of a cancelled call is handed out.
  void end_if_cancelled() const {
    if (*flag_) throw Interrupted("cancelled");
  }

 private:
  std::atomic<bool> own_ = false;
  std::atomic<bool>* flag_;
  mb_progress progress_;
  void* user_;
};

}  // namespace meshbound::c_interface
