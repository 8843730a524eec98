// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>

namespace meshbound::tools {

/// Prints what --dry-run says on stdout: about how much memory and time a run would take, by what runs at 0.1% took on
/// the meshes of the benchmark (docs/benchmarks.md). `tolerance` and `diagonal` in model units.
void print_estimate(std::size_t faces, double tolerance, double diagonal);

}  // namespace meshbound::tools
