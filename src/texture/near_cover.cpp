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

/// Gathers the sheet of a triangle. False if an edge of it may run through the inside of A with nothing beyond.
bool NearCover::gather_closed_sheet(const ChartTriangle& a, const ChartTriangle& first) {
  bool is_closed = true;
  sheet_.assign(1, &first);
  for (std::size_t i = 0; i < sheet_.size(); ++i) {
    const ChartTriangle& b = *sheet_[i];
    for (std::size_t edge = 0; edge < 3; ++edge) {
      const ChartTriangle* across = b.across[edge];
      const bool is_between_candidates = across != nullptr && candidates_.contains(across->number);
      if (!is_between_candidates && is_outside(a, b, edge)) continue;
      if (across == nullptr)
        is_closed = false;
      else if (gathered_.insert(across->number))
        sheet_.push_back(across);
    }
  }
  return is_closed;
}

/// A sheet that has no open edge through the inside of A covers all of A where it covers a point of it, as `Covering`
/// tells it.
std::optional<double> NearCover::upper(const ChartTriangle& a, Candidates candidates, double min_upper,
                                       double precision) {
  double upper = HUGE_VAL;
  const auto upper_of = [&](const ChartTriangle* b) { return upper_of_pair(a, *b, min_upper, precision); };
  for (const ChartTriangle* b : candidates)
    if (is_part_of(a, *b)) upper = std::min(upper, upper_of(b));
  if (upper < HUGE_VAL) return upper;
  candidates_.clear();
  gathered_.clear();
  for (const ChartTriangle* b : candidates) candidates_.insert(b->number);
  for (const ChartTriangle* first : candidates) {
    if (!gathered_.insert(first->number) || !gather_closed_sheet(a, *first) || !has_covered_point(a, sheet_)) continue;
    double of_sheet = min_upper;
    for (const ChartTriangle* b : sheet_) of_sheet = std::max(of_sheet, upper_of(b));
    upper = std::min(upper, of_sheet);
  }
  return upper < HUGE_VAL ? std::optional(upper) : std::nullopt;
}

}  // namespace meshbound
