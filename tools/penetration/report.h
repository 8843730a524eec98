// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <string>

#include "common/exit_code.h"
#include "meshbound/penetration_depth.h"
#include "meshbound/report.h"

namespace meshbound::tools {

/// What penetration_depth says: schema "meshbound/penetration/1".
struct PenetrationReport {
  Provenance provenance;
  std::string verdict;                ///< "done", "within", "exceeds" or "undecided"
  std::string reason;                 ///< why it is undecided, or why a depth is not as narrow as wanted; else empty
  std::string contact;                ///< "none", "touching" or "overlapping"
  std::optional<double> error_bound;  ///< absent where only a decision was wanted
  std::optional<double> tolerance;
  MeshReport a, b;
  std::optional<double> displacement_a, displacement_b;  ///< rounding of maps that are no rigid motions
  PenetrationDepth result;
  struct Seconds {
    double read = 0;   ///< both files
    double check = 0;  ///< that both are closed, and their trees
    double query = 0;  ///< volumes and depths
    double write = 0;  ///< the parts
    double total = 0;
  } seconds;
  int threads = 1;
};

/// Fills `verdict` and `reason` from the volumes, and returns the exit code that goes with them.
ExitCode conclude(PenetrationReport& report);

[[nodiscard]] std::string to_json(const PenetrationReport& report);

/// For people, on stdout.
void print_report(const PenetrationReport& report);

/// The line that a log needs where the verdict is no success, without a newline; else empty.
[[nodiscard]] std::string closing_line(const PenetrationReport& report);

}  // namespace meshbound::tools
