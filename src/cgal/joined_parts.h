// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "cgal/collapse_run.h"
#include "cgal/parts.h"

namespace meshbound::cgal {

/// Runs all parts towards the goal, several at a time. `locked` is by vertex of the polygons that were cut, or empty.
/// What comes out is the same for any number of threads. Throws what a part throws, and what the progress of the
/// options does; that is called from the calling thread only.
[[nodiscard]] std::vector<FinishedPart> run_parts(const Cutting& cutting, const std::vector<bool>& locked,
                                                  const SimplifyOptions& options, const CollapseGoal& goal);

/// One mesh of all, joined at the seams, where no vertex has moved.
[[nodiscard]] JoinedParts join(std::vector<FinishedPart> parts, const Cutting& cutting,
                               const std::vector<bool>& locked);

}  // namespace meshbound::cgal
