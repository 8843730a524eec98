// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace meshbound::tools {

/// A path on the command line, or one that a tool derives from it.
struct NamedPath {
  std::string role;  ///< the argument as the help names it: "IN", "--json"
  std::filesystem::path path;
};

/// Throws `InvalidInput`, one line, when writing an output would replace an input, a file that a glTF input is read
/// together with, or another output. Files are compared, not names: through symbolic links, as hard links of one file,
/// and where nothing is there yet by folder and name. Devices, FIFOs, "-" and "" replace nothing. To be called before
/// any work.
void require_distinct_files(const std::vector<NamedPath>& inputs, const std::vector<NamedPath>& outputs);

}  // namespace meshbound::tools
