// SPDX-License-Identifier: MIT
// simplify_with_bound IN OUT --tolerance T: as few triangles as possible, never further than T from the original.
#include <CLI/CLI.hpp>
#include <optional>

#include "common/tile_workers.h"
#include "simplify/simplify_run.h"

int main(int argc, char** argv) {
  using namespace meshbound::tools;
  CLI::App app("Simplifies a triangle mesh and proves how far the result is from the original.", "simplify_with_bound");
  SimplifyArguments options;
  add_simplify_arguments(app, options);
  return tool_main(app, argc, argv, [&] {
    std::optional<LocalTileWorkers> workers;
    if (!options.memory.empty()) {
      options.workers = &workers.emplace(tile_setting(options));
      options.drop_attributes = true;
    }
    refuse_folder(options.input);
    check_batch_usage(app, options.batch);
    if (!options.batch.source.empty()) check_lengths(options);
    if (options.batch.is_wanted()) return run_batch(options.batch, options.common, options.output_dir);
    resolve_streams(options);
    return run_simplify(options);
  });
}
