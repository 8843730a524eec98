// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "deviation/camera.h"
#include "deviation/rounded_point.h"
#include "meshbound/mesh_view.h"

namespace meshbound::tools {

/// Which triangle of a mesh each pixel of a picture shows.
class SurfaceImage {
 public:
  /// O(triangles + pixels that they cover).
  SurfaceImage(const TriangleMesh& mesh, const Camera& camera, int width, int height);

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  /// The triangle at a pixel, or `no_index` where there is no surface. 0 <= x < `width()`, 0 <= y < `height()`, here
  /// and below.
  [[nodiscard]] std::uint32_t triangle(int x, int y) const { return triangles_[index(x, y)]; }
  /// The barycentric coordinates, in its triangle, of the point at the middle of a pixel that has a triangle.
  [[nodiscard]] Eigen::Vector3d weights(int x, int y) const;
  /// That point, model units.
  [[nodiscard]] RoundedPoint point(int x, int y) const;
  /// Whether a pixel is at the border between two triangles, or at that of the surface.
  [[nodiscard]] bool is_edge(int x, int y) const;
  /// Number of pixels that have a triangle.
  [[nodiscard]] std::size_t covered() const;

 private:
  void draw(std::uint32_t triangle);
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }

  const TriangleMesh& mesh_;
  const Camera& camera_;
  int width_, height_;
  std::vector<std::uint32_t> triangles_;
  std::vector<double> depths_;
};

}  // namespace meshbound::tools
