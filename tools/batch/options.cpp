// SPDX-License-Identifier: MIT
#include "batch/options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>

#include "common/whole_number.h"
#include "meshbound/error.h"

namespace meshbound::tools {
namespace {

/// Options that the process of a mesh does not get; each has a value, except --quiet.
constexpr std::array<std::string_view, 8> own_options{"--batch",        "--batch-merge", "--jobs",    "--shard",
                                                      "--memory-limit", "--output-dir",  "--threads", "--quiet"};

std::optional<std::uint64_t> from_environment(const char* name) {
  const char* const text = std::getenv(name);
  return text != nullptr ? whole_number(text) : std::nullopt;
}

std::uint64_t index_from_environment() {
  if (const auto task = from_environment("SLURM_ARRAY_TASK_ID")) {
    const std::uint64_t first = from_environment("SLURM_ARRAY_TASK_MIN").value_or(0);
    const std::uint64_t step = from_environment("SLURM_ARRAY_TASK_STEP").value_or(1);
    if (*task < first || step == 0 || (*task - first) % step != 0)
      throw InvalidInput("--shard auto: SLURM_ARRAY_TASK_ID " + std::to_string(*task) +
                         " is not reached from SLURM_ARRAY_TASK_MIN " + std::to_string(first) +
                         " in steps of SLURM_ARRAY_TASK_STEP " + std::to_string(step) + "; say --shard INDEX/COUNT");
    return (*task - first) / step;
  }
  if (const auto index = from_environment("JOB_COMPLETION_INDEX")) return *index;
  throw InvalidInput(
      "--shard auto: neither SLURM_ARRAY_TASK_ID nor JOB_COMPLETION_INDEX is set to a number; say --shard INDEX/COUNT");
}

}  // namespace

void add_batch_options(CLI::App& app, BatchOptions& options) {
  app.add_option("--batch", options.source,
                 "Instead of IN and OUT: simplify every mesh below a folder, or each of a list of files (a line each), "
                 "into --output-dir; the same command resumes a run that was ended");
  app.add_option("--batch-merge", options.merge,
                 "Instead of IN and OUT: make batch.csv and batch.html of the reports in this --output-dir of a batch");
  app.add_option("--jobs", options.jobs,
                 "With --batch: meshes to work on at once (default: --threads), which share the threads")
      ->check(CLI::Range(1, 1024));
  app.add_option("--shard", options.shard,
                 "With --batch: INDEX/COUNT, the share of the meshes to take, counted from 0; auto/COUNT takes the "
                 "index from SLURM_ARRAY_TASK_ID or JOB_COMPLETION_INDEX");
  app.add_option("--memory-limit", options.memory_limit,
                 "With --batch: memory that one mesh may take, such as 4G or 512M");
}

void check_batch_usage(const CLI::App& app, const BatchOptions& options) {
  const auto was_given = [&app](const char* name) {
    const CLI::Option* const option = app.get_option_no_throw(name);
    return option != nullptr && option->count() > 0;
  };
  if (options.is_wanted()) {
    for (const char* const name : {"IN", "OUT", "--levels", "--certificate", "--json", "--heatmap",
                                   "--heatmap-original", "--report", "--image", "--units", "--up", "--dry-run"})
      if (was_given(name))
        throw InvalidInput(std::string(name) +
                           " is for a single mesh; a batch writes to --output-dir, with a line of "
                           "JSON for each mesh in batch.jsonl: leave it out");
    return;
  }
  for (const char* const name : {"--jobs", "--shard", "--memory-limit"})
    if (was_given(name)) throw InvalidInput(std::string(name) + " goes with --batch only");
  for (const char* const name : {"IN", "OUT"})
    if (!was_given(name)) throw InvalidInput(std::string(name) + " is required (see --help)");
}

Shard parse_shard(const std::string& text) {
  if (text.empty()) return {};
  const std::size_t slash = text.find('/');
  const std::string_view first = std::string_view(text).substr(0, slash);
  std::optional<std::uint64_t> count;
  if (slash != std::string::npos)
    count = whole_number(std::string_view(text).substr(slash + 1));
  else if (first == "auto")
    count = from_environment("SLURM_ARRAY_TASK_COUNT");
  const auto index = first == "auto" ? index_from_environment() : whole_number(first);
  if (!index || !count || *index >= *count)
    throw InvalidInput("--shard " + text + ": give INDEX/COUNT with INDEX from 0 to COUNT - 1, such as 0/8");
  return {*index, *count};
}

std::vector<std::string> asset_options(const std::vector<std::string>& command) {
  std::vector<std::string> options;
  for (std::size_t i = 1; i < command.size(); ++i) {
    const std::string_view name = std::string_view(command[i]).substr(0, command[i].find('='));
    if (std::find(own_options.begin(), own_options.end(), name) == own_options.end())
      options.push_back(command[i]);
    else if (name.size() == command[i].size() && name != "--quiet")
      ++i;
  }
  return options;
}

}  // namespace meshbound::tools
