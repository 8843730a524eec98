// SPDX-License-Identifier: MIT
#pragma once
#include "common/progress.h"
#include "common/run_clock.h"
#include "common/signals.h"
#include "common/tool_main.h"

namespace meshbound::tools {

/// Sets the threads, the signals, the remaining time and the progress bar of a computation in a run; `bar` must outlive
/// it. `Options` are `DistanceOptions` or `PenetrationOptions`.
template <class Options>
void set_run_limits(Options& options, const CommonOptions& common, const RunClock& clock, ProgressBar& bar) {
  options.threads = common.threads;
  options.cancel = &interrupted();
  options.progress = bar.callback();
  options.budget.seconds = clock.seconds_left();
}

}  // namespace meshbound::tools
