// SPDX-License-Identifier: MIT
/// Runs a built tool as a user would, through the shell, and keeps what it said.
#pragma once
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "temporary_folder.h"

namespace meshbound::testing_tools {

using test::TemporaryFolder;

struct ToolRun {
  int exit_code = -1;  ///< 124: ran into the timeout; 128 + n: ended by signal n
  std::string out;
  std::string err;
};

inline std::string content_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline std::string shell_quoted(const std::string& word) {
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

/// What the shell makes of `command`, killed after the timeout.
inline ToolRun run_shell(const std::string& command, int timeout_seconds = 120) {
  const TemporaryFolder folder;
  const std::string limited = "timeout -s KILL " + std::to_string(timeout_seconds) + " sh -c " + shell_quoted(command) +
                              " >" + shell_quoted(folder / "out") + " 2>" + shell_quoted(folder / "err") +
                              " </dev/null";
  const int status = std::system(limited.c_str());
  ToolRun run;
  run.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  run.out = content_of(folder / "out");
  run.err = content_of(folder / "err");
  return run;
}

/// The command line of a tool, for the shell. `exec` hands its signals and its exit code through.
inline std::string command_line(const std::string& tool, const std::vector<std::string>& arguments) {
  std::string command = "exec " + shell_quoted(tool);
  for (const std::string& argument : arguments) command += " " + shell_quoted(argument);
  return command;
}

inline ToolRun run_tool(const std::string& tool, const std::vector<std::string>& arguments, int timeout_seconds = 120) {
  return run_shell(command_line(tool, arguments), timeout_seconds);
}

inline std::ptrdiff_t line_count(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

}  // namespace meshbound::testing_tools
