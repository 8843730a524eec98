// SPDX-License-Identifier: MIT
/// What doubles know of the places of points and triangles in the texture. Edge k of a triangle is opposite to corner
/// k; triangles have an area in the texture.
#pragma once
#include <array>
#include <cstddef>

#include "texture/overlay.h"
#include "texture/overlay_numbers.h"

namespace meshbound {

/// Weights of the first corners of a polygon, against 1 for the others, of inner points to be tried in turn: a point on
/// an edge of a triangle does not tell whether that covers what is around it. Where the corners are points
/// of a regular grid, the last one lies on none of its lines.
inline constexpr std::array<std::array<double, 3>, 3> weights_of_inner_points = {
    {{1, 1, 1}, {3, 2, 1}, {0.618034, 1, 1.414214}}};

/// Twice the area of the triangle that a point makes with an edge, positive on the inner side.
[[nodiscard]] inline Approximate inner_area(const ChartTriangle& t, std::size_t edge, const Eigen::Vector2d& p) {
  const Eigen::Vector2d &from = t.source->coordinates[(edge + 1) % 3], &to = t.source->coordinates[(edge + 2) % 3];
  if (p == to) return {};  // as for the other end
  const Approximate area = doubled_area(from, to, p);
  return t.turned ? -area : area;
}

/// Whether a point is known to be inside a triangle, off its edges.
[[nodiscard]] bool is_inside(const ChartTriangle& t, const Eigen::Vector2d& p);

/// Whether all of a triangle is known to have coordinates of another one.
[[nodiscard]] bool is_part_of(const ChartTriangle& part, const ChartTriangle& whole);

/// Whether a segment is known to have no point inside a triangle, as it lies on one of its edges or beyond it.
[[nodiscard]] bool is_outside(const ChartTriangle& t, const Eigen::Vector2d& from, const Eigen::Vector2d& to);

/// Whether an edge is known to have no point inside another triangle.
[[nodiscard]] bool is_outside(const ChartTriangle& t, const ChartTriangle& of_edge, std::size_t edge);

}  // namespace meshbound
