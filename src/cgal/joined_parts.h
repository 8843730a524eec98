// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "cgal/collapse_run.h"
#include "cgal/parts.h"
#include "cgal/proven_parts.h"

namespace meshbound::cgal {

/// Runs all parts towards the goal, several at a time. `locked` is by vertex of the polygons that were cut, or empty.
/// What comes out is the same for any number of threads. Throws what a part throws, and what the progress of the
/// options does; that is called from the calling thread only.
[[nodiscard]] std::vector<FinishedPart> run_parts(const Cutting& cutting, const std::vector<bool>& locked,
                                                  const SimplifyOptions& options, const CollapseGoal& goal);

/// The same, but their first collapses only, by an estimate.
[[nodiscard]] std::vector<FinishedPart> estimate_parts(const Cutting& cutting, const std::vector<bool>& locked,
                                                       const SimplifyOptions& options, const CollapseGoal& goal);
/// The same of a mesh that was proven.
[[nodiscard]] std::vector<FinishedPart> run_parts(const ProvenCutting& cutting, const SimplifyOptions& options,
                                                  const CollapseGoal& goal);

/// One mesh of all, joined at the seams, where no vertex has moved. `quadrics` are those of vertices on seams, by
/// vertex of the polygons that were cut; where there are none, those of the parts add up.
[[nodiscard]] JoinedParts join(std::vector<FinishedPart> parts, const Cutting& cutting, const std::vector<bool>& locked,
                               std::span<const Quadric> quadrics = {});
[[nodiscard]] JoinedParts join(std::vector<FinishedPart> parts, const ProvenCutting& cutting);

}  // namespace meshbound::cgal
