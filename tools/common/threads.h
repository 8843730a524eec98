// SPDX-License-Identifier: MIT
#pragma once
#include <functional>

namespace meshbound::tools {

/// Starts the threads of OpenMP while memory is plentiful, and makes every parallel part of the process use them:
/// `wanted` of them (0: as many as OpenMP has by default), or as many as the machine lets the process start. OpenMP
/// itself would end the process at the first thread that it cannot start. Returns the number.
int start_threads(int wanted);

/// Calls both functions, each on a thread of its own if `threads` is 2 or more. Rethrows an exception of `first` before
/// one of `second`.
void run_both(int threads, const std::function<void()>& first, const std::function<void()>& second);

}  // namespace meshbound::tools
