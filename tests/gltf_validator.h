// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "datasets.h"
#include "run_tool.h"

namespace meshbound::test {

/// What Khronos' validator says of files of glTF: a line for each error, then "N errors". Nothing where node or the
/// validator is not on this machine; datasets/fetch brings the latter.
inline std::optional<std::string> gltf_errors(const std::vector<std::string>& files) {
  const auto validator = dataset("npm/gltf-validator/index.js");
  if (!validator || testing_tools::run_shell("node --version").exit_code != 0) return std::nullopt;
  std::vector<std::string> arguments = {std::string(MESHBOUND_SOURCE_DIR) + "/tests/validate_gltf.js",
                                        validator->parent_path()};
  arguments.insert(arguments.end(), files.begin(), files.end());
  return testing_tools::run_tool("node", arguments).out;
}

}  // namespace meshbound::test
