// SPDX-License-Identifier: MIT
#include "mpi/mpi_main.h"

#include <cstdio>
#include <exception>
#include <new>

#include "common/exit_code.h"
#include "common/memory.h"
#include "common/omp_spin.h"
#include "common/signals.h"
#include "common/standard_streams.h"
#include "mpi/rank_workers.h"

namespace meshbound::tools {
namespace {

/// The exit code, or none where this rank cannot go on together with the others.
std::optional<int> run_rank(mpi::Communicator& ranks, const std::string& tool,
                            const std::function<int(mpi::Communicator&)>& run) {
  if (ranks.rank() == 0) {
    const int code = run(ranks);
    if (has_lost_step()) return std::nullopt;
    // Everything is said and written. Once another rank has returned a code that is not 0, mpirun sends this one
    // SIGTERM.
    static const UninterruptedScope ending;
    dismiss(ranks, code);
    return code;
  }
  try {
    return serve(ranks);
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "%s: rank %d: %s\n", tool.c_str(), ranks.rank(), out_of_memory(tool).c_str());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: rank %d: %s\n", tool.c_str(), ranks.rank(), error.what());
  }
  return std::nullopt;
}

}  // namespace

int mpi_main(int argc, char** argv, const std::string& tool, const std::function<int(mpi::Communicator&)>& run) {
  occupy_standard_streams();
  limit_omp_spin();
  ignore_write_signals();
  int provided = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
  std::optional<int> code;
  {
    mpi::Communicator ranks(MPI_COMM_WORLD);
    code = run_rank(ranks, tool, run);
    if (!code) MPI_Abort(MPI_COMM_WORLD, ExitBadInput);
  }
  MPI_Finalize();
  return *code;
}

}  // namespace meshbound::tools
