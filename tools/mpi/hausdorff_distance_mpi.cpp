// SPDX-License-Identifier: MIT
// mpirun -n N hausdorff_distance_mpi A B: hausdorff_distance --memory over the ranks of MPI.
#include <CLI/CLI.hpp>

#include "common/memory.h"
#include "hausdorff/distance_run.h"
#include "mpi/mpi_main.h"
#include "mpi/rank_workers.h"

int main(int argc, char** argv) {
  using namespace meshbound::tools;
  constexpr const char* name = "hausdorff_distance_mpi";
  return mpi_main(argc, argv, name, [&](meshbound::mpi::Communicator& ranks) {
    CLI::App app(
        "Hausdorff distance between two triangle meshes as a proven interval [lower, upper], measured tile by tile "
        "over "
        "all ranks of mpirun. The result is the one of hausdorff_distance --memory, for any number of ranks.",
        name);
    Arguments arguments;
    add_tile_arguments(app, arguments);
    return tool_main(app, argc, argv, [&] {
      RankWorkers workers(ranks, {.tiles = {arguments.tile_triangles}});
      arguments.workers = &workers;
      resolve_streams(arguments);
      if (!arguments.memory.empty()) workers.limit_memory(parse_memory("--memory", arguments.memory));
      return run_distance(arguments);
    });
  });
}
