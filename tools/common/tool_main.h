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
  int threads = 0;  ///< that were started; 0 until the command line is parsed
  bool quiet = false;
  std::string progress = "auto";
  double time_limit = std::numeric_limits<double>::infinity();  ///< seconds of the whole run
  std::string json;  ///< file for the JSON document, "-" for stdout, empty for none

  /// Whether a summary is printed on stdout.
  [[nodiscard]] bool prints_summary() const { return !quiet && json != "-"; }
};

/// For options that name documents: what is wrong with the name of a mesh, which is likely to be one; else empty.
[[nodiscard]] std::string no_mesh_name(const std::string& path);

/// Adds --ascii and --single-precision.
void add_write_options(CLI::App& app, WriteOptions& options);

/// Adds --json.
void add_json_option(CLI::App& app, std::string& json);

/// Adds --threads, --quiet, --progress, --time-limit, --json and --version.
void add_common_options(CLI::App& app, CommonOptions& options);

/// What a tool says that has `closing_line` for a log, empty for a success: with --quiet that line, on stderr; else
/// what `print` prints, unless stdout is for the JSON document.
void tell(const CommonOptions& options, const std::string& closing_line, const std::function<void()>& print);

/// Puts command lines at the end of --help.
void add_examples(CLI::App& app, const std::vector<std::string>& command_lines);

/// Parses the command line and calls `run`, whose result is the exit code. A usage error or an exception becomes one
/// line on stderr and `ExitBadInput`, with the nearest options where one is unknown; a `Stopped` one gives
/// `ExitUndecided`; --help, --version and `--completion SHELL` print on stdout and give `ExitDone`.
int tool_main(CLI::App& app, int argc, const char* const* argv, const std::function<int()>& run);

}  // namespace meshbound::tools
