// SPDX-License-Identifier: MIT
/// What all tools have in common: exit codes, options, and one line on stderr when something is wrong.
#pragma once
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "common/exit_code.h"
#include "meshbound/bounds.h"
#include "meshbound/io.h"

namespace CLI {
class App;
}

namespace meshbound::tools {

[[nodiscard]] ExitCode exit_code(Verdict verdict);

struct CommonOptions {
  int threads = 0;  ///< 0: as many as OpenMP has
  bool quiet = false;
  std::string progress = "auto";
  double time_limit = std::numeric_limits<double>::infinity();  ///< seconds of the whole run
  std::string json;  ///< file for the JSON document, "-" for stdout, empty for none
};

/// For options that name documents: what is wrong with the name of a mesh, which is likely to be one; else empty.
[[nodiscard]] std::string no_mesh_name(const std::string& path);

/// Adds --ascii and --single-precision.
void add_write_options(CLI::App& app, WriteOptions& options);

/// Adds --threads, --quiet, --progress, --time-limit, --json and --version.
void add_common_options(CLI::App& app, CommonOptions& options);

/// Puts command lines at the end of --help.
void add_examples(CLI::App& app, const std::vector<std::string>& command_lines);

/// Parses the command line and calls `run`, whose result is the exit code. A usage error or an exception becomes one
/// line on stderr and `ExitBadInput`, with the nearest options where one is unknown; a `Stopped` one gives
/// `ExitUndecided`; --help, --version and `--completion SHELL` print on stdout and give `ExitDone`.
int tool_main(CLI::App& app, int argc, const char* const* argv, const std::function<int()>& run);

}  // namespace meshbound::tools
