// SPDX-License-Identifier: MIT
#pragma once
#include <meshbound.h>

#include <functional>

namespace meshbound::c_interface {

/// What `guarded` does. The argument is made by the caller, where no exception is caught yet: that must not allocate.
mb_status guarded_call(int threads, const std::function<void()>& work) noexcept;

/// Calls `work()`, which is asked for so many threads (0: as many as OpenMP has), in the floating-point mode that the
/// library needs. An exception becomes a status and the message of the calling thread; none leaves this function.
template <class Work>
mb_status guarded(int threads, const Work& work) noexcept {
  return guarded_call(threads, std::cref(work));  // a function made of a reference allocates nothing
}

template <class Work>
mb_status guarded(const Work& work) noexcept {
  return guarded(0, work);
}

/// Throws `InvalidInput`, naming the argument, where `pointer` is null.
void require(const void* pointer, const char* argument);

}  // namespace meshbound::c_interface
