// SPDX-License-Identifier: MIT
#pragma once
#include <string>

#include "meshbound/report.h"

namespace meshbound::tools {

/// Prints what hausdorff_distance says to people on stdout; `profile` adds the statistics that the paper reports in its
/// Table 2 and Fig. 9.
void print_report(const DistanceReport& report, bool profile);

/// The line that a log needs of an answer that is no success, "FAIL 0.0433 > 0.04 at (-0.988 19.617 2.367), triangle
/// 12370" (of A, where it does not say "of B") or "UNDECIDED ...: why", without a newline; empty for a success.
[[nodiscard]] std::string closing_line(const DistanceReport& report);

}  // namespace meshbound::tools
