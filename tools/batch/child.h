// SPDX-License-Identifier: MIT
#pragma once
#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mesh/descriptor.h"

namespace meshbound::tools {

/// How a child process has ended.
struct ChildEnd {
  int exit_code = -1;  ///< -1: ended by a signal, or unknown
  int signal = 0;      ///< that ended it; 0: none
  std::string fault;   ///< why nobody knows how it ended; empty: it is known
  bool was_late = false;
  std::string out, err;
  double seconds = 0, cpu_seconds = 0;
  std::uint64_t peak_memory = 0;  ///< bytes
};

/// A program that runs beside this one, with its standard output and error kept. It is ended with this process, however
/// that ends.
class Child {
 public:
  /// Starts `command`. `memory_limit` in bytes, 0: none; it is killed after `seconds`. From here on this process does
  /// not ignore SIGCHLD. Throws `IoError` when it cannot be started.
  Child(const std::vector<std::string>& command, std::uint64_t memory_limit, std::chrono::duration<double> seconds);
  Child(Child&& other) noexcept;
  Child& operator=(Child&& other) noexcept;
  ~Child();  ///< ends it

  /// Absent while it runs.
  [[nodiscard]] std::optional<ChildEnd> poll();

 private:
  using Clock = std::chrono::steady_clock;

  pid_t process_ = -1;
  Descriptor out_, err_;  ///< files in memory
  Clock::time_point start_, deadline_;
  bool was_late_ = false;
};

}  // namespace meshbound::tools
