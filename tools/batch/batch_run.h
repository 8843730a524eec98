// SPDX-License-Identifier: MIT
/// `simplify_with_bound --batch` and `--batch-merge`.
#pragma once
#include <string>

#include "batch/options.h"

namespace meshbound::tools {

/// Runs the tool itself on each mesh of the batch, a process for each, and appends a line of JSON for each to
/// batch.jsonl (batch_INDEX_of_COUNT.jsonl for a shard) in `output_dir`; a mesh that fails does not stop the others. A
/// mesh whose content and options have a line already, and whose result is unchanged, is skipped. `options` are those
/// of the batch, `common` those that each process gets as well. Without --shard the tables are written at the end.
/// Returns 0 when all are within the tolerance; else the first of 2 (some failed), 1 (some exceed it) and 3 (some are
/// undecided) that applies. Throws `InvalidInput`, `IoError`, and `Error` when it is interrupted.
[[nodiscard]] int run_batch(const BatchOptions& options, const CommonOptions& common, const std::string& output_dir);

}  // namespace meshbound::tools
