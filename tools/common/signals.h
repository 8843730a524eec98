// SPDX-License-Identifier: MIT
#pragma once
#include <atomic>
#include <string>

#include "meshbound/stop_token.h"

namespace meshbound::tools {

/// From here on SIGINT, SIGTERM and SIGHUP, unless they are ignored, as under nohup, set the flag of `interrupted`, so
/// that the tool can say what it has proven and end. If it has not ended by itself `grace` seconds later, whatever it
/// is doing, its unfinished files are removed, one line that begins with `tool` goes to stderr, and the process exits
/// with `ExitBadInput`. Further signals change nothing.
void watch_interrupts(const std::string& tool);
inline constexpr double grace = 0.25;

/// Set by the first signal after `watch_interrupts`.
[[nodiscard]] const std::atomic<bool>& interrupted();
/// A token that stops at that signal.
[[nodiscard]] inline StopToken stop_at_signal() { return {.cancel = &interrupted()}; }

/// While one lives, a signal does not end the process from outside: for files that appear together. What blocks in here
/// has to look at the flag whenever a system call fails with EINTR, which then happens again and again.
class UninterruptedScope {
 public:
  UninterruptedScope();
  ~UninterruptedScope();
  UninterruptedScope(const UninterruptedScope&) = delete;
  UninterruptedScope& operator=(const UninterruptedScope&) = delete;
};

/// Writing past a limit on the size of files, or to a pipe that nobody reads, becomes an error like a full disk,
/// instead of the end of the process.
void ignore_write_signals();

}  // namespace meshbound::tools
