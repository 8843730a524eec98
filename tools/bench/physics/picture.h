// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "meshbound/mesh_view.h"
#include "meshbound/pose.h"

namespace meshbound::bench {

using Colour = std::array<std::uint8_t, 3>;

/// A picture of triangles and lines, seen from a point, with a depth buffer.
class Picture {
 public:
  /// From `eye` towards `target`, z up; the field of view is 40 degrees.
  Picture(int width, int height, const Eigen::Vector3d& eye, const Eigen::Vector3d& target);

  void add(const MeshView& mesh, const Pose& pose, const Colour& colour);
  /// Drawn over everything that is behind it or in front of it.
  void add_line(const Eigen::Vector3d& from, const Eigen::Vector3d& to, const Colour& colour);
  /// As PNG, not compressed. Throws `std::runtime_error` when it cannot be written.
  void write(const std::filesystem::path& path) const;

 private:
  [[nodiscard]] Eigen::Vector3d project(const Eigen::Vector3d& p) const;
  void set(int x, int y, const Colour& colour);

  int width_, height_;
  Eigen::Vector3d eye_;
  Eigen::Matrix3d to_view_;
  std::vector<Colour> pixels_;
  std::vector<float> depth_;
};

}  // namespace meshbound::bench
