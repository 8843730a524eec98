// SPDX-License-Identifier: MIT
#pragma once
#include <meshbound.h>

#include <atomic>

namespace meshbound::c_interface {

/// What ends one call: a request of the caller, or the call's own progress function.
struct CallFlag {
  std::atomic<bool> is_taken = true;  ///< by a call that has not returned
  std::atomic<bool> is_set = false;
  CallFlag* next = nullptr;
};

}  // namespace meshbound::c_interface

/// What is behind the opaque structure of C callers. Calls that can end by themselves too have a flag of their own, so
/// that ending one does not end the others; these flags are kept here, for a request to set all of them.
struct mb_cancel {
  mb_cancel() = default;
  mb_cancel(const mb_cancel&) = delete;
  mb_cancel& operator=(const mb_cancel&) = delete;
  ~mb_cancel();

  /// A flag for one call, set if there is a request already. The call gives it back by `is_taken = false`. Any thread.
  [[nodiscard]] meshbound::c_interface::CallFlag& take_flag();

  /// Sets all flags. Any thread and signal handlers: it neither locks nor allocates.
  void request();

  std::atomic<bool> requested = false;

 private:
  /// The last flag made; the others hang on it. None goes before this object does, so that `request` can walk along
  /// them at any time.
  std::atomic<meshbound::c_interface::CallFlag*> flags_ = nullptr;
};
