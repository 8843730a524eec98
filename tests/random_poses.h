// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <random>

namespace meshbound::test {

inline Eigen::Isometry3d translated(const Eigen::Vector3d& by) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = by;
  return pose;
}

/// Numbers, vectors and poses that are the same on every machine.
class RandomPoses {
 public:
  explicit RandomPoses(std::uint32_t seed) : engine_(seed) {}

  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_()) / 4294967296.0);
  }
  Eigen::Vector3d offset(double size) { return {uniform(-size, size), uniform(-size, size), uniform(-size, size)}; }
  /// A turn by up to `angle` and an offset of up to `size` in each coordinate from `around`.
  Eigen::Isometry3d pose(const Eigen::Vector3d& around, double size, double angle) {
    Eigen::Isometry3d pose = translated(around + offset(size));
    pose.rotate(Eigen::AngleAxisd(uniform(-angle, angle), offset(1).normalized()));
    return pose;
  }

 protected:
  std::mt19937 engine_;
};

}  // namespace meshbound::test
