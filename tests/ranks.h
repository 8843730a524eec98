// SPDX-License-Identifier: MIT
/// Starts programs over ranks of MPI on this machine, as many as asked for whatever its processors.
#pragma once
#include <string>
#include <vector>

#include "run_tool.h"

namespace meshbound::testing_tools {

/// The command line of mpirun, for the shell: no network, no other machines, also as root and in a container.
inline std::string over_ranks(int ranks, const std::string& program, const std::vector<std::string>& arguments) {
  std::string command =
      "export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_btl=self,vader "
      "OMPI_MCA_btl_vader_single_copy_mechanism=none OMPI_MCA_plm=isolated OMPI_MCA_ess_base_help_aggregate=0; exec " +
      shell_quoted(MPIRUN) + " --oversubscribe --bind-to none -n " + std::to_string(ranks) + " " +
      shell_quoted(program);
  for (const std::string& argument : arguments) command += " " + shell_quoted(argument);
  return command;
}

/// Whether mpirun says of ranks that ended as they should that one did not: Open MPI 4 does in one of a thousand or two
/// thousand runs, and then knows no more which process the rank was (open-mpi/ompi issue 7833).
inline bool is_misjudged(const ToolRun& run) {
  return run.exit_code == 1 && run.err.find("with PID 0 on") != std::string::npos;
}

/// Runs ranks again that were misjudged.
inline ToolRun run_ranks(int ranks, const std::string& program, const std::vector<std::string>& arguments,
                         int timeout_seconds = 200) {
  ToolRun run;
  int runs = 0;
  do {
    run = run_shell(over_ranks(ranks, program, arguments), timeout_seconds);
  } while (is_misjudged(run) && ++runs < 3);
  return run;
}

}  // namespace meshbound::testing_tools
