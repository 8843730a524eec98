// SPDX-License-Identifier: GPL-3.0-or-later
/// What `simplify_with_bound` and the chain of levels have in common.
#pragma once
#include <chrono>

#include "cgal/decimation.h"

namespace meshbound::cgal {

[[nodiscard]] inline double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Throws `InvalidInput` for options out of range.
void check_options(const SimplifyOptions& options);

/// Mesh and counts of the decimation as it stands.
void take_state(const Decimation& decimation, SimplifiedLevel& level);

/// Measures the mesh of the level against the original, of which `tree` is, and decides about its tolerances.
void measure_level(const TriangleMesh& original, const Bvh& tree, SimplifiedLevel& level,
                   const SimplifyOptions& options);

}  // namespace meshbound::cgal
