// SPDX-License-Identifier: MIT
/// `simplify_with_bound --batch` and `--batch-merge`.
#pragma once
#include <string>

#include "batch/options.h"

namespace meshbound::tools {

/// Runs the tool itself on each mesh of the batch, a process for each, and keeps a line of JSON for each in
/// batch.jsonl (batch_INDEX_of_COUNT.jsonl for a shard) in `output_dir`; a mesh that fails does not stop the others.
/// One whose content and options have a line already, and whose result is there unchanged, is left alone. `options` are
/// those of the batch, `common` those that a mesh's process gets too. Without --shard the tables are written in the
/// end. Returns 0 when all are within the tolerance; else 2, 1 or 3 where some failed, exceed it or are undecided, the
/// first of these that there is. Throws `InvalidInput`, `IoError`, and `Error` when it is interrupted.
[[nodiscard]] int run_batch(const BatchOptions& options, const CommonOptions& common, const std::string& output_dir);

}  // namespace meshbound::tools
