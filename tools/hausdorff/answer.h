// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <string>

#include "common/tile_workers.h"
#include "common/tool_main.h"
#include "hausdorff/question.h"
#include "meshbound/distance.h"

namespace meshbound::tools {

struct Answer {
  Bounds bounds;
  OneSidedDistance a_to_b;
  std::optional<OneSidedDistance> b_to_a;  ///< absent when only one side was asked for
  // What `conclude` makes of it:
  std::string verdict;
  Outcome outcome = Outcome::Converged;
  std::string reason;  ///< why a part of the question is still open; else empty
  ExitCode exit_code = ExitUndecided;
};

/// The answer without trees, for meshes with the same surface or a copy that has hardly moved; absent for others.
[[nodiscard]] std::optional<Answer> answer_without_trees(const Question& question, const TriangleMesh& a,
                                                         const TriangleMesh& b, Method method);

/// The answer for meshes on disk that are the same arrays, whose blocks are compared; absent for others, also for those
/// that the function above answers in memory.
[[nodiscard]] std::optional<Answer> answer_without_trees(const Question& question, const StoredMesh& a,
                                                         const StoredMesh& b, Method method);

/// The answer if the time is over before anything was searched.
[[nodiscard]] Answer unsearched_answer(const Question& question);

/// Decides, measures, or both. `options` give the method, the threads, the budget of all of it and what watches it.
[[nodiscard]] Answer answer_by_trees(const Question& question, const Bvh& a, const Bvh& b,
                                     const DistanceOptions& options);

/// Answers tile by tile as `answer_by_trees` does, without trees of whole meshes.
[[nodiscard]] Answer answer_in_tiles(const Question& question, const StoredMesh& a, const StoredMesh& b,
                                     const DistanceOptions& options, TileWorkers& workers);

/// Allows for the rounding of B's image and derives verdict, outcome, reason and exit code. A measurement is "done"
/// only when its interval is as narrow as was asked.
void conclude(Answer& answer, const Question& question);

}  // namespace meshbound::tools
