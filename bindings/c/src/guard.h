// SPDX-License-Identifier: MIT
#pragma once
#include <meshbound.h>

#include <functional>

namespace meshbound::c_interface {

/// What `guarded` does. The argument is made by the caller, where no exception is caught yet: that must not allocate.
mb_status guarded_call(const std::function<void()>& work) noexcept;

/// Calls `work()` in the floating-point mode that the library needs. An exception becomes a status and the message of
/// the calling thread; none leaves this function.
template <class Work>
mb_status guarded(const Work& work) noexcept {
  return guarded_call(std::cref(work));  // a function made of a reference allocates nothing
}

/// Throws `InvalidInput`, naming the argument, where `pointer` is null.
void require(const void* pointer, const char* argument);

}  // namespace meshbound::c_interface
