// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <string>

#include "common/length.h"
#include "common/tool_main.h"

namespace meshbound::tools {

/// The command line of penetration_depth.
struct PenetrationArguments {
  std::string a;
  std::string b;
  std::string transform_a;
  std::string transform_b;
  std::string error_bound;
  std::string tolerance;
  std::string output;
  CommonOptions common;
};

void add_arguments(CLI::App& app, PenetrationArguments& arguments);

/// The lengths of the command line as typed, parsed before any mesh is read.
struct PenetrationLengths {
  std::optional<Length> error_bound;
  std::optional<Length> tolerance;
};

/// Throws `InvalidInput` for lengths that are none, for an output that is no OBJ or PLY, and where a file would be
/// written that is read; `IoError` where one cannot be written to.
[[nodiscard]] PenetrationLengths check_arguments(const PenetrationArguments& arguments);

}  // namespace meshbound::tools
