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

/// Calls on_sheet(triangles) for each sheet that covers A.
template <class OnSheet>
void NearCover::for_each_complete_sheet(const ChartTriangle& a, Candidates candidates, const OnSheet& on_sheet) {
  candidates_.clear();
  gathered_.clear();
  for (const ChartTriangle* b : candidates) candidates_.insert(b->number);
  for (const ChartTriangle* b : candidates)
    if (gathered_.insert(b->number) && gather_closed_sheet(a, *b) && has_covered_point(a, sheet_)) on_sheet(sheet_);
}

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

bool NearCover::is_complete(const ChartTriangle& a, Candidates candidates) {
  bool is_complete = false;
  for_each_complete_sheet(a, candidates, [&](const auto&) { is_complete = true; });
  return is_complete;
}

std::optional<double> NearCover::upper(const ChartTriangle& a, Candidates candidates, double min_upper,
                                       double precision) {
  double upper = HUGE_VAL;
  const auto upper_of = [&](const ChartTriangle* b) { return upper_of_pair(a, *b, min_upper, precision); };
  for (const ChartTriangle* b : candidates)
    if (is_part_of(a, *b)) upper = std::min(upper, upper_of(b));
  if (upper < HUGE_VAL) return upper;
  for_each_complete_sheet(a, candidates, [&](const std::vector<const ChartTriangle*>& sheet) {
    double of_sheet = min_upper;
    for (const ChartTriangle* b : sheet) of_sheet = std::max(of_sheet, upper_of(b));
    upper = std::min(upper, of_sheet);
  });
  return upper < HUGE_VAL ? std::optional(upper) : std::nullopt;
}

}  // namespace meshbound
