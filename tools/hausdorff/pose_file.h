// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "meshbound/pose.h"

namespace meshbound::tools {

/// The poses of a file: a line of 16 numbers for each, row-major, rigid; empty lines and lines that begin with '#' are
/// skipped. Throws `IoError` when it cannot be read, `InvalidInput`, naming the line, when that is no rigid motion, and
/// when there is no pose.
[[nodiscard]] std::vector<Pose> read_poses(const std::string& path);

}  // namespace meshbound::tools
