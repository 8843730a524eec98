// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>
#include <string>
#include <vector>

namespace meshbound::bench {

struct ChildResult {
  enum class Status { Done, TimedOut, Failed };
  Status status = Status::Failed;
  std::vector<double> values;  ///< what the work returned, when Done
  std::string error;           ///< why it Failed
  double peak_bytes = 0;       ///< largest resident set of the child, its share of the parent's pages included
};

/// Runs `work` in a child process that is killed once it has used `cpu_seconds` of processor time, all of its threads
/// together, or ten times as much of the clock. It sees the parent's memory as it is now. The parent must be single
/// threaded and must not have used OpenMP, whose threads do not survive the fork.
[[nodiscard]] ChildResult run_in_child(double cpu_seconds, const std::function<std::vector<double>()>& work);

}  // namespace meshbound::bench
