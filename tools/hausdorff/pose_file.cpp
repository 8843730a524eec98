// SPDX-License-Identifier: MIT
#include "hausdorff/pose_file.h"

#include <cmath>
#include <filesystem>
#include <fstream>

#include "common/affine_argument.h"
#include "meshbound/error.h"

namespace meshbound::tools {
namespace {

/// What the engine accepts too: written with 10 digits or more, a rotation is one.
constexpr double max_drift = 1e-9;

Pose parse_pose(const std::string& where, const std::string& line) {
  const AffineMap map = parse_affine_numbers(where, line);
  const Eigen::Matrix3d gram = map.linear().transpose() * map.linear();
  if (!((gram - Eigen::Matrix3d::Identity()).norm() <= max_drift))
    throw InvalidInput(where + ": not a rigid motion: the columns of its 3 x 3 part are not orthonormal to 9 digits");
  Pose pose;
  pose.matrix() = map.matrix();
  return pose;
}

}  // namespace

std::vector<Pose> read_poses(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file || std::filesystem::is_directory(path)) throw IoError("--poses: cannot read " + path);
  std::vector<Pose> poses;
  std::size_t number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    const std::size_t first = line.find_first_not_of(" \t\r");
    if (first == std::string::npos || line[first] == '#') continue;
    poses.push_back(parse_pose("--poses: " + path + " line " + std::to_string(number), line));
  }
  if (file.bad()) throw IoError("--poses: cannot read " + path);
  if (poses.empty()) throw InvalidInput("--poses: " + path + " has no pose; give a line of 16 numbers for each step");
  return poses;
}

}  // namespace meshbound::tools
