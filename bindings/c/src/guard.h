// SPDX-License-Identifier: MIT
#pragma once
#include <meshbound.h>

#include <functional>

namespace meshbound::c_interface {

/// Calls `work` in the floating-point mode that the library needs. An exception becomes a status and the message of the
/// calling thread; none leaves this function.
mb_status guarded(const std::function<void()>& work) noexcept;

/// Throws `InvalidInput`, naming the argument, where `pointer` is null.
void require(const void* pointer, const char* argument);

}  // namespace meshbound::c_interface
