// SPDX-License-Identifier: MIT
/// The offset between the points of two triangles with the same texture coordinate is linear in the coordinate, so its
/// length over a set of points is largest at a corner of their convex hull. What both triangles cover is the one of
/// them, cut by the edges of the other. It is cut in doubles, so that at most too much is left: *points* are kept whose
/// hull, grown by a *reach* on both axes, contains all that both cover.
#include "texture/pair_bound.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "numeric/rounding.h"
#include "texture/chart_sides.h"

namespace meshbound {
namespace {

/// Three corners become at most four, six and twelve by three cuts: each point that is kept, and one between it and
/// each point that is not.
constexpr std::size_t max_points = 12;

struct HullPoints {
  std::array<Eigen::Vector2d, max_points> at;
  std::size_t count = 0;
  double reach = 0;
};

/// Largest coordinate of a triangle in the texture.
double size_of(const ChartTriangle& t) {
  double size = 0;
  for (const Eigen::Vector2d& uv : t.source->coordinates) size = std::max(size, uv.cwiseAbs().maxCoeff());
  return size;
}

/// Cuts off what lies beyond an edge of a triangle.
///
/// A point is dropped if it, and all within reach of it, is known to lie beyond: its area with the edge, in doubles, is
/// below -margin, where the margin is more than the error of any of these areas and what the reach adds to it. Between
/// a point that is kept, with area p, and one that is dropped, with area q, the line of the edge, moved outwards by the
/// reach, is crossed at a share of the way that grows with the true areas, so it is at most (p + margin) / (p - q); the
/// point that is taken lies there or farther on. It is rounded by at most 5 u of the largest coordinate on each axis,
/// which the reach grows by.
void cut(HullPoints& points, const ChartTriangle& by, std::size_t edge, double size) {
  std::array<double, max_points> area;
  double error = 0;
  for (std::size_t i = 0; i < points.count; ++i) {
    const Approximate here = inner_area(by, edge, points.at[i]);
    area[i] = here.value;
    error = std::max(error, here.error);
  }
  const Eigen::Vector2d way = by.source->coordinates[(edge + 2) % 3] - by.source->coordinates[(edge + 1) % 3];
  const double margin = (error + way.cwiseAbs().sum() * points.reach) * Approximate::grown;
  const auto is_dropped = [&](std::size_t i) { return area[i] < -margin; };  // not where something is not a number
  const HullPoints before = points;
  points.count = 0;
  for (std::size_t i = 0; i < before.count; ++i) {
    if (is_dropped(i)) continue;
    points.at[points.count++] = before.at[i];
    for (std::size_t j = 0; j < before.count; ++j) {
      if (!is_dropped(j)) continue;
      const double share = (area[i] + margin) / (area[i] - area[j]) * Approximate::grown;
      points.at[points.count++] = share < 1 ? before.at[i] + share * (before.at[j] - before.at[i]) : before.at[j];
    }
  }
  points.reach += size * (8 * unit_roundoff) + Approximate::tiny;
}

}  // namespace

double upper_of_pair(const ChartTriangle& a, const ChartTriangle& b, double min_upper, double precision) {
  if (b.plane.is_within(*a.source, min_upper) || a.plane.is_within(*b.source, min_upper)) return min_upper;
  HullPoints points;
  std::copy(a.source->coordinates.begin(), a.source->coordinates.end(), points.at.begin());
  points.count = 3;
  const double size = size_of(a);
  for (std::size_t edge = 0; edge < 3; ++edge) cut(points, b, edge, size);
  const double beside = points.reach * (a.plane.max_derivative() + b.plane.max_derivative()) * Approximate::grown;
  double upper = min_upper;
  for (std::size_t i = 0; i < points.count; ++i) {
    const Approximate there = distance_at(a.plane, b.plane, points.at[i]);
    const double here = (there.value + (there.error + beside)) * Approximate::grown;
    if (!(there.error + beside <= precision && here < HUGE_VAL)) return HUGE_VAL;  // also what is not a number
    upper = std::max(upper, here);
  }
  return upper;
}

}  // namespace meshbound
