// SPDX-License-Identifier: MIT
#pragma once
#include <span>
#include <string>

#include "common/gated_output.h"
#include "meshbound/report.h"
#include "meshbound/simplify.h"
#include "simplify/arguments.h"

namespace meshbound::tools {

/// A finished run, as its summary in text tells it.
struct FinishedRun {
  const SimplifyArguments& options;
  const SimplifyReport& report;
  const SimplifyResult& result;
  std::span<const GatedOutput> outputs;   ///< of the levels that were asked for, then OUT
  std::span<const DecidedBy> decided_by;  ///< of the outputs
  bool is_ended_by_time = false;
  double diagonal = 0;   ///< of the original, model units
  std::string rounding;  ///< why nothing collapsed where rounding is to blame; empty: it is not
};

/// Prints the summary of a run whose outputs are within their tolerances on stdout.
void print_summary(const FinishedRun& run);

}  // namespace meshbound::tools
