// SPDX-License-Identifier: MIT
#pragma once
#include <functional>
#include <string>

#include "mpi/communicator.h"

namespace meshbound::tools {

/// `main` of a tool that runs on all ranks of MPI: calls `run` on rank 0, whose exit code all ranks return, while the
/// others do what it tells them (`serve`). A rank that fails alone says so in one line on stderr and ends all.
int mpi_main(int argc, char** argv, const std::string& tool, const std::function<int(mpi::Communicator&)>& run);

}  // namespace meshbound::tools
