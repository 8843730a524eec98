// SPDX-License-Identifier: MIT
// mpirun -n N simplify_with_bound_mpi IN OUT --tolerance T: simplify_with_bound --memory over the ranks of MPI.
#include <CLI/CLI.hpp>

#include "common/memory.h"
#include "mpi/mpi_main.h"
#include "mpi/rank_workers.h"
#include "simplify/simplify_run.h"

int main(int argc, char** argv) {
  using namespace meshbound::tools;
  constexpr const char* name = "simplify_with_bound_mpi";
  return mpi_main(argc, argv, name, [&](meshbound::mpi::Communicator& ranks) {
    CLI::App app(
        "Simplifies a triangle mesh tile by tile over all ranks of mpirun and proves how far the result is from the "
        "original. The result is the one of simplify_with_bound --memory, for any number of ranks.",
        name);
    SimplifyArguments options;
    add_tile_arguments(app, options);
    return tool_main(app, argc, argv, [&] {
      RankWorkers workers(ranks, tile_setting(options));
      options.workers = &workers;
      options.drop_attributes = true;
      resolve_streams(options);
      if (!options.memory.empty()) workers.limit_memory(parse_memory("--memory", options.memory));
      return run_simplify(options);
    });
  });
}
