// SPDX-License-Identifier: MIT
/// `simplify_with_bound --batch`: the options of a run over many files.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/tool_main.h"

namespace meshbound::tools {

struct BatchOptions {
  std::string source;  ///< a folder or a list of files; empty: no batch
  std::string merge;   ///< the folder of a batch whose reports are to be merged; empty: none
  int jobs = 0;        ///< 0: one for each processor
  std::string shard;   ///< as typed
  std::string memory_limit;

  [[nodiscard]] bool is_wanted() const { return !source.empty() || !merge.empty(); }
};

/// Adds --batch, --batch-merge, --jobs, --shard and --memory-limit.
void add_batch_options(CLI::App& app, BatchOptions& options);

/// Throws `InvalidInput` if an option for batches only was given without a batch or, in a batch, an option that names a
/// file of a single mesh.
void check_batch_usage(const CLI::App& app, const BatchOptions& options);

/// The share of the assets that a run takes: those whose number leaves `index` when divided by `count`.
struct Shard {
  std::uint64_t index = 0, count = 1;
};

/// "2/8": the third of eight. "auto/8": the index is that of a Slurm array (SLURM_ARRAY_TASK_ID, counted from
/// SLURM_ARRAY_TASK_MIN in steps of SLURM_ARRAY_TASK_STEP) or of a Kubernetes indexed job (JOB_COMPLETION_INDEX);
/// "auto" also takes the count of a Slurm array, SLURM_ARRAY_TASK_COUNT. Empty: one shard. Throws `InvalidInput`.
[[nodiscard]] Shard parse_shard(const std::string& text);

/// The part of the command line on which the result of a mesh depends: without the program, the options of the batch,
/// --output-dir, --threads and --quiet.
[[nodiscard]] std::vector<std::string> asset_options(const std::vector<std::string>& command);

}  // namespace meshbound::tools
