// SPDX-License-Identifier: MIT
// Triangles in the texture, for tests of what covers what there.
#pragma once
#include <cstdint>
#include <vector>

#include "texture/overlay.h"

namespace meshbound {

/// A triangle whose place in space is that in the texture, at a height.
inline TexturedTriangle in_texture(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                                   double height = 0, std::uint32_t material = 0) {
  TexturedTriangle t;
  t.coordinates = {a, b, c};
  for (std::size_t k = 0; k < 3; ++k) t.corners[k] = {t.coordinates[k].x(), t.coordinates[k].y(), height};
  t.material = material;
  return t;
}

/// The charts of the triangles of a mesh, which must outlive them, with their numbers but without links.
inline std::vector<ChartTriangle> charts_of(const std::vector<TexturedTriangle>& triangles, const ExactUnits& units) {
  std::vector<ChartTriangle> charts;
  for (const TexturedTriangle& t : triangles) {
    charts.push_back(chart_triangle(t, units));
    charts.back().number = static_cast<std::uint32_t>(charts.size() - 1);
  }
  return charts;
}

}  // namespace meshbound
