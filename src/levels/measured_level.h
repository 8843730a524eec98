// SPDX-License-Identifier: MIT
/// What `simplify_with_bound` and `build_lod_chain` share: checking options and measuring a level.
#pragma once
#include "meshbound/bvh.h"
#include "meshbound/simplify.h"

namespace meshbound {

/// Throws `InvalidInput` for options out of range.
void check_options(const SimplifyOptions& options);

/// Measures the mesh of the level against the original with its `tree` and its feature `lines`, and sets the verdicts
/// on its tolerances.
void measure_level(const TriangleMesh& original, const Bvh& tree, std::span<const Edge> lines, SimplifiedLevel& level,
                   const SimplifyOptions& options);

}  // namespace meshbound
