// SPDX-License-Identifier: MIT
#include "texture/near_cover.h"

#include <algorithm>
#include <cmath>

#include "texture/chart_sides.h"
#include "texture/pair_bound.h"

namespace meshbound {
namespace {

Eigen::Vector2d inner_point(const ChartTriangle& t, const std::array<double, 3>& weights) {
  const auto& uv = t.source->coordinates;
  return (weights[0] * uv[0] + weights[1] * uv[1] + weights[2] * uv[2]) / (weights[0] + weights[1] + weights[2]);
}

/// Whether some point of the triangle is known to be inside a candidate.
bool has_covered_point(const ChartTriangle& a, NearCover::Candidates candidates) {
  return std::any_of(weights_of_inner_points.begin(), weights_of_inner_points.end(), [&](const auto& weights) {
    const Eigen::Vector2d p = inner_point(a, weights);
    return is_inside(a, p) &&
           std::any_of(candidates.begin(), candidates.end(), [&](const ChartTriangle* b) { return is_inside(*b, p); });
  });
}

}  // namespace

bool NearCover::is_complete(const ChartTriangle& a, Candidates candidates) {
  candidates_.clear();
  for (const ChartTriangle* b : candidates) candidates_.insert(b->number);
  const auto is_closed = [&](const ChartTriangle& b, std::size_t edge) {
    return (b.across[edge] != nullptr && candidates_.contains(b.across[edge]->number)) || is_outside(a, b, edge);
  };
  const bool has_open = std::any_of(candidates.begin(), candidates.end(), [&](const ChartTriangle* b) {
    return !is_closed(*b, 0) || !is_closed(*b, 1) || !is_closed(*b, 2);
  });
  return !has_open && has_covered_point(a, candidates);
}

std::optional<double> NearCover::upper(const ChartTriangle& a, Candidates candidates, double min_upper,
                                       double precision) {
  double upper = min_upper;
  const auto whole =
      std::find_if(candidates.begin(), candidates.end(), [&](const ChartTriangle* b) { return is_part_of(a, *b); });
  if (whole != candidates.end())
    upper = upper_of_pair(a, **whole, min_upper, precision);
  else if (is_complete(a, candidates))
    for (const ChartTriangle* b : candidates) upper = std::max(upper, upper_of_pair(a, *b, min_upper, precision));
  else
    return std::nullopt;
  return upper < HUGE_VAL ? std::optional(upper) : std::nullopt;
}

}  // namespace meshbound
