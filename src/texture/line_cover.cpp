// SPDX-License-Identifier: MIT
#include "texture/line_cover.h"

#include <algorithm>
#include <cmath>

#include "texture/chart_edges.h"
#include "texture/line_chart.h"
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

std::optional<double> LineCover::upper(const ChartTriangle& a, Candidates candidates, double min_upper,
                                       double precision) {
  const LineChart line_chart(a);
  unfolded_.clear();
  const auto unfold = [&](const ChartTriangle& t) {
    TexturedTriangle& unfolded = unfolded_.emplace_back(*t.source);
    for (std::size_t k = 0; k < 3; ++k) unfolded.coordinates[k] = line_chart.corner(*t.source, k);
  };
  unfold(a);
  for (const ChartTriangle* b : candidates) {
    const auto is_on_it = [&](const Eigen::Vector2d& p) { return is_on_line(a, p, units_); };
    if (b->chart == Chart::Segment && std::ranges::all_of(b->source->coordinates, is_on_it)) unfold(*b);
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
