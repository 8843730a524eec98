// SPDX-License-Identifier: MIT
// hausdorff_distance A B: the Hausdorff distance between two meshes as a proven interval, or the decision whether it is
// at most a tolerance.
#include <CLI/CLI.hpp>
#include <optional>

#include "common/tile_workers.h"
#include "hausdorff/distance_run.h"

int main(int argc, char** argv) {
  using namespace meshbound::tools;
  CLI::App app(
      "Hausdorff distance between two triangle meshes as a proven interval [lower, upper] with witnesses, "
      "rounding included.",
      "hausdorff_distance");
  Arguments arguments;
  add_arguments(app, arguments);
  return tool_main(app, argc, argv, [&arguments] {
    std::optional<LocalTileWorkers> workers;
    if (!arguments.memory.empty())
      arguments.workers = &workers.emplace(TileSetting{.tiles = {arguments.tile_triangles}});
    resolve_streams(arguments);
    return run_distance(arguments);
  });
}
