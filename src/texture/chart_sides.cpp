// SPDX-License-Identifier: MIT
#include "texture/chart_sides.h"

#include <optional>

namespace meshbound {
namespace {

/// The side of an edge that a point is known to lie on: 1 inside, 0 on its line, -1 beyond it; absent if doubles do not
/// tell.
std::optional<int> known_side(const ChartTriangle& t, std::size_t edge, const Eigen::Vector2d& p) {
  int side = 0;
  return sign_is_known(inner_area(t, edge, p), side) ? std::optional(side) : std::nullopt;
}

/// Whether a point is known to lie on an edge or beyond it.
bool is_beyond(const ChartTriangle& t, std::size_t edge, const Eigen::Vector2d& p) {
  return known_side(t, edge, p).value_or(1) <= 0;
}

/// Whether all of a triangle is known to be on one side of the line of an edge.
bool is_on_one_side(const ChartTriangle& t, const ChartTriangle& of_edge, std::size_t edge) {
  bool is_within = true, is_beyond = true;
  for (const Eigen::Vector2d& p : t.source->coordinates) {
    const std::optional<int> side = known_side(of_edge, edge, p);
    is_within = is_within && side.value_or(-1) >= 0;
    is_beyond = is_beyond && side.value_or(1) <= 0;
  }
  return is_within || is_beyond;
}

}  // namespace

bool is_inside(const ChartTriangle& t, const Eigen::Vector2d& p) {
  for (std::size_t edge = 0; edge < 3; ++edge)
    if (known_side(t, edge, p) != 1) return false;
  return true;
}

bool is_part_of(const ChartTriangle& part, const ChartTriangle& whole) {
  for (const Eigen::Vector2d& p : part.source->coordinates)
    for (std::size_t edge = 0; edge < 3; ++edge)
      if (known_side(whole, edge, p).value_or(-1) < 0) return false;
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
