// SPDX-License-Identifier: MIT
#pragma once
#include <atomic>
#include <exception>
#include <mutex>
#include <utility>

namespace meshbound {

/// Carries an exception out of an OpenMP region, where it must not escape: what runs there under `guard` loses its
/// exception to this object, and `rethrow` after the region throws the one that came first. Memory may run out in any
/// thread.
class FirstError {
 public:
  template <class Work>
  void guard(Work&& work) noexcept {
    try {
      std::forward<Work>(work)();
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!error_) error_ = std::current_exception();
      has_error_ = true;
    }
  }

  /// Whether something has been thrown already, so that loops can end early.
  [[nodiscard]] bool has_error() const { return has_error_; }

  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  std::mutex mutex_;
  std::exception_ptr error_;
  std::atomic<bool> has_error_ = false;
};

}  // namespace meshbound
