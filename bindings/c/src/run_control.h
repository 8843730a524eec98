// SPDX-License-Identifier: MIT
#pragma once
#include <meshbound.h>

#include <atomic>
#include <functional>

#include "meshbound/error.h"

/// The flag that C callers see as an opaque structure.
struct mb_cancel {
  std::atomic<bool> requested = false;
};

namespace meshbound::c_interface {

/// The flag and the progress function of one call. A progress function that ends the call sets the caller's flag, or
/// one of its own where the caller has none.
class RunControl {
 public:
  /// For options of any kind that have `cancel`, `progress` and `user`.
  template <class Options>
  explicit RunControl(const Options& options)
      : flag_(options.cancel != nullptr ? &options.cancel->requested : &own_),
        progress_(options.progress),
        user_(options.user) {}
  RunControl(const RunControl&) = delete;
  RunControl& operator=(const RunControl&) = delete;

  [[nodiscard]] const std::atomic<bool>* flag() const { return flag_; }

  /// What the library calls; empty without a progress function. Must not outlive this.
  [[nodiscard]] std::function<void(double)> progress() {
    if (progress_ == nullptr) return {};
    return [this](double fraction) {
      if (progress_(fraction, user_) != 0) *flag_ = true;
    };
  }

  /// Throws `Interrupted` where the flag is set: results of a cancelled call are not handed out.
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
