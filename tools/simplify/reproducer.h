// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <optional>
#include <vector>

#include "common/gated_output.h"
#include "simplify/arguments.h"

namespace meshbound::tools {

/// What a run had made of its arguments when a result was rejected.
struct RejectedRun {
  std::vector<double> tolerances;  ///< of all results, model units, ascending
  double rejected_tolerance = 0;   ///< of the result that was rejected, model units
  std::optional<double> target_ratio;
};

/// Writes the folder OUT.reproducer: the original, the mesh that was rejected, and everything that led from one to the
/// other; of standard input nothing is kept. Returns the folder. Throws `IoError` and
/// `std::filesystem::filesystem_error`.
std::filesystem::path save_reproducer(const SimplifyArguments& arguments, const GatedOutput& rejected,
                                      const RejectedRun& run);

}  // namespace meshbound::tools
