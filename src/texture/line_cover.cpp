// SPDX-License-Identifier: MIT
#include "texture/line_cover.h"

#include <algorithm>
#include <cmath>

#include "texture/chart_edges.h"
#include "texture/overlay_numbers.h"

namespace meshbound {
namespace {

/// Whether a point of the texture lies on the line of the coordinates of a triangle, decided exactly.
bool is_on_line(const ChartTriangle& of_line, const Eigen::Vector2d& p, const ExactUnits& units) {
  const Eigen::Vector2d &from = of_line.source->coordinates[of_line.along[0]],
                        &to = of_line.source->coordinates[of_line.along[2]];
  if (p == from || p == to) return true;
  int side = 0;
  if (sign_is_known(doubled_area(from, to, p), side)) return side == 0;
  const auto exact = [&](const Eigen::Vector2d& at) {
    return TexturePoint<mpz_class>{in_units(at.x(), units.texture), in_units(at.y(), units.texture)};
  };
  const TexturePoint<mpz_class> start = exact(from);
  return sgn(cross<mpz_class>(exact(to) - start, exact(p) - start)) == 0;
}

/// A triangle with an area in the texture, as doubles know it; absent if they do not.
std::optional<ChartTriangle> chart_with_area(const TexturedTriangle& t, std::uint32_t number) {
  ChartTriangle chart;
  int turn = 0;
  if (!sign_is_known(doubled_area(t.coordinates[0], t.coordinates[1], t.coordinates[2]), turn) || turn == 0)
    return std::nullopt;
  chart.source = &t;
  chart.turned = turn < 0;
  chart.plane = LiftedPlane(t);
  chart.number = number;
  return chart;
}

}  // namespace

struct LineCover::Directions {
  /// `of` has texture coordinates on a line, and not one alone.
  explicit Directions(const ChartTriangle& of) : at(of.source->corners[of.along[0]]) {
    const auto& uv = of.source->coordinates;
    const auto& corners = of.source->corners;
    const auto [first, middle, last] = of.along;
    const Eigen::Vector2d way = uv[last] - uv[first];
    axis = std::fabs(way.x()) > std::fabs(way.y()) ? 0 : 1;
    const double share = (uv[middle][axis] - uv[first][axis]) / way[axis];
    const Eigen::Vector3d opposite = corners[first] + share * (corners[last] - corners[first]);
    across = (corners[middle] - opposite).stableNormalized();
  }
  Eigen::Index axis = 0;   ///< of texture coordinates: differs along the line
  Eigen::Vector3d at;      ///< a point of the triangle
  Eigen::Vector3d across;  ///< where the coordinate stays the same; not of length 1 without an area in space
};

void LineCover::unfold(const ChartTriangle& t, const Directions& directions) {
  TexturedTriangle& unfolded = unfolded_.emplace_back(*t.source);
  for (std::size_t k = 0; k < 3; ++k)
    unfolded.coordinates[k] = {t.source->coordinates[k][directions.axis],
                               directions.across.dot(t.source->corners[k] - directions.at)};
}

std::optional<double> LineCover::upper(const ChartTriangle& a, Candidates candidates, double min_upper,
                                       double precision) {
  const Directions directions(a);
  unfolded_.clear();
  unfold(a, directions);
  for (const ChartTriangle* b : candidates) {
    const auto is_on_it = [&](const Eigen::Vector2d& p) { return is_on_line(a, p, units_); };
    if (b->chart == Chart::Segment && std::ranges::all_of(b->source->coordinates, is_on_it)) unfold(*b, directions);
  }
  const std::optional<ChartTriangle> unfolded_a = chart_with_area(unfolded_.front(), 0);
  if (!unfolded_a) return std::nullopt;
  charts_.clear();
  for (std::size_t i = 1; i < unfolded_.size(); ++i)
    if (const auto chart = chart_with_area(unfolded_[i], static_cast<std::uint32_t>(charts_.size())))
      charts_.push_back(*chart);
  link_across_edges(charts_);
  candidates_.clear();
  for (const ChartTriangle& chart : charts_) candidates_.push_back(&chart);
  return near_cover_.upper(*unfolded_a, candidates_, min_upper, precision);
}

}  // namespace meshbound
