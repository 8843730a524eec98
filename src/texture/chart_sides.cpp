// SPDX-License-Identifier: MIT
#include "texture/chart_sides.h"

#include <algorithm>

namespace meshbound {
namespace {

bool is_known_positive(const Approximate& x) { return x.value > x.error; }
bool is_known_not_negative(const Approximate& x) { return is_known_positive(x) || x.is_zero(); }
bool is_known_not_positive(const Approximate& x) { return is_known_not_negative(-x); }

/// Whether a point is known to lie on an edge or beyond it.
bool is_beyond(const ChartTriangle& t, std::size_t edge, const Eigen::Vector2d& p) {
  return is_known_not_positive(inner_area(t, edge, p));
}

/// Whether all of a triangle is known to be on one side of the line of an edge.
bool is_on_one_side(const ChartTriangle& t, const ChartTriangle& of_edge, std::size_t edge) {
  bool is_within = true, is_beyond = true;
  for (const Eigen::Vector2d& p : t.source->coordinates) {
    const Approximate area = inner_area(of_edge, edge, p);
    is_within = is_within && is_known_not_negative(area);
    is_beyond = is_beyond && is_known_not_positive(area);
  }
  return is_within || is_beyond;
}

}  // namespace

bool is_inside(const ChartTriangle& t, const Eigen::Vector2d& p) {
  for (std::size_t edge = 0; edge < 3; ++edge)
    if (!is_known_positive(inner_area(t, edge, p))) return false;
  return true;
}

bool is_part_of(const ChartTriangle& part, const ChartTriangle& whole) {
  for (const Eigen::Vector2d& p : part.source->coordinates)
    for (std::size_t edge = 0; edge < 3; ++edge)
      if (!is_known_not_negative(inner_area(whole, edge, p))) return false;
  return true;
}

bool is_outside(const ChartTriangle& t, const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  for (std::size_t edge = 0; edge < 3; ++edge)
    if (is_beyond(t, edge, from) && is_beyond(t, edge, to)) return true;
  return false;
}

bool is_outside(const ChartTriangle& t, const ChartTriangle& of_edge, std::size_t edge) {
  const auto& uv = of_edge.source->coordinates;
  return is_on_one_side(t, of_edge, edge) || is_outside(t, uv[(edge + 1) % 3], uv[(edge + 2) % 3]);
}

}  // namespace meshbound
