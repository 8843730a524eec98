// SPDX-License-Identifier: MIT
#include "texture/line_cover.h"

#include <algorithm>
#include <cmath>

#include "texture/chart_edges.h"
#include "texture/line_chart.h"
#include "texture/overlay_numbers.h"

namespace meshbound {
namespace {

/// Share of its width by which a triangle is let lie inside of what covers it, where borders of both lie on one another
/// but for rounding: more than places round, if these are not more than a thousand widths of the triangle from the
/// origin, and far less than counts for a bound.
constexpr double growth_of_candidates = 0x1p-36;

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

/// What tells how charts are made.
struct LineCover::Directions {
  /// `a` has texture coordinates on a line, and not one alone.
  explicit Directions(const ChartTriangle& a) : chart(a), along(a.along) {
    for (std::size_t k = 0; k < 3; ++k) corners[k] = chart.corner(*a.source, k);
    start = corners[along[0]].x();
    length = corners[along[2]].x() - start;
    share_of_middle = (corners[along[1]].x() - start) / length;
  }

  /// The middle of the places that points of A with a coordinate have: rounded, but exact at its ends. It goes on
  /// beyond these.
  [[nodiscard]] double middle_place(double coordinate) const {
    const double first = corners[along[0]].y(), last = corners[along[2]].y(), share = (coordinate - start) / length;
    const double middle = 0.5 * (between(first, last, share_of_middle) + corners[along[1]].y());
    if (share <= share_of_middle && share_of_middle > 0) return between(first, middle, share / share_of_middle);
    if (share_of_middle >= 1) return middle;
    return between(middle, last, (share - share_of_middle) / (1 - share_of_middle));
  }
  [[nodiscard]] static double between(double from, double to, double share) { return (1 - share) * from + share * to; }

  LineChart chart;
  std::array<std::uint8_t, 3> along;       ///< the first, middle and last corner of A on the line
  std::array<Eigen::Vector2d, 3> corners;  ///< of A in the chart
  double start = 0, length = 0;            ///< of A along the line
  double share_of_middle = 0;              ///< where the middle corner is, as a share of the length
};

/// Gives corners of A the places of corners of candidates that they are but for rounding.
void LineCover::join_corners(const ChartTriangle& a, Directions& directions) const {
  for (std::size_t k = 0; k < 3; ++k) {
    const double own = directions.corners[k].y();
    double nearest = growth_of_candidates * std::fabs(directions.length);
    for (const ChartTriangle* b : on_line_)
      for (std::size_t j = 0; j < 3; ++j) {
        if (b->source->coordinates[j] != a.source->coordinates[k]) continue;
        const double place = directions.chart.place(b->source->corners[j]);
        if (!(std::fabs(place - own) < nearest)) continue;
        nearest = std::fabs(place - own);
        directions.corners[k].y() = place;
      }
  }
}

/// `growth`: moves the place away from the middle of those of A by this share of the way from there.
void LineCover::unfold(const ChartTriangle& b, const Directions& directions, double growth) {
  TexturedTriangle& unfolded = unfolded_.emplace_back(*b.source);
  for (std::size_t k = 0; k < 3; ++k) {
    Eigen::Vector2d& at = unfolded.coordinates[k] = directions.chart.corner(*b.source, k);
    if (growth > 0) at.y() += growth * (at.y() - directions.middle_place(at.x()));
  }
}

std::optional<double> LineCover::upper(const ChartTriangle& a, Candidates candidates, double min_upper,
                                       double precision) {
  on_line_.clear();
  for (const ChartTriangle* b : candidates) {
    const auto is_on_it = [&](const Eigen::Vector2d& p) { return is_on_line(a, p, units_); };
    if (b->chart == Chart::Segment && std::ranges::all_of(b->source->coordinates, is_on_it)) on_line_.push_back(b);
  }
  Directions directions(a);
  if (const auto found = upper_in_charts(a, directions, 0, min_upper, precision)) return found;
  join_corners(a, directions);
  return upper_in_charts(a, directions, growth_of_candidates, min_upper, precision);
}

std::optional<double> LineCover::upper_in_charts(const ChartTriangle& a, const Directions& directions, double growth,
                                                 double min_upper, double precision) {
  unfolded_.clear();
  unfolded_.emplace_back(*a.source).coordinates = directions.corners;
  for (const ChartTriangle* b : on_line_) unfold(*b, directions, growth);
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
