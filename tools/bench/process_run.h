// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace meshbound::bench {

struct ProcessRun {
  bool in_time = true;
  int exit_code = 0;       ///< when in time
  double cpu_seconds = 0;  ///< user and system, all threads, loading included
};

/// Runs a program to its end, or kills it after `limit` seconds of the clock; what it prints goes to the file `output`.
/// `arguments` begins with its path. Throws `std::runtime_error` when it cannot be started or is ended by a signal.
[[nodiscard]] ProcessRun run_process(const std::vector<std::string>& arguments, const std::filesystem::path& output,
                                     double limit);

}  // namespace meshbound::bench
