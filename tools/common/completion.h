// SPDX-License-Identifier: MIT
#pragma once
#include <string>

namespace CLI {
class App;
}

namespace meshbound::tools {

/// A script by which bash, zsh or fish completes the options of a tool, the values of those that have a fixed set of
/// them, and files. Throws `InvalidInput` for another shell.
[[nodiscard]] std::string completion_script(const CLI::App& app, const std::string& shell);

}  // namespace meshbound::tools
