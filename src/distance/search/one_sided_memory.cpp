// SPDX-License-Identifier: MIT
/// What a search takes over from earlier ones, and leaves for later ones.
#include <algorithm>
#include <cmath>

#include "distance/search/one_sided_search.h"
#include "numeric/rounding.h"

namespace meshbound {

/// A computed distance as a length that is proven: working units, behind so many cuts.
double OneSidedSearch::proven_length(double squared, std::uint32_t cuts) const {
  return std::sqrt(squared) * (1 + 8 * unit_roundoff) + goal_.slack + cuts * goal_.cut_slack;
}

/// `proven_length` in model units. The scale is a power of two: without `ldexp` where the product is a normal number.
double OneSidedSearch::proven_model_length(double squared, std::uint32_t cuts) const {
  const double working = proven_length(squared, cuts), model = working * scale_to_model_;
  return model > 0x1p-1000 && model < 0x1p1000 ? model : b_.frame.length_up(working);
}

/// The furthest point of the search before is often still the furthest. It is constructed with less than 21 u M of
/// rounding; a lower bound uses 32 of the 128 u M in the slack, so that is allowed for.
void OneSidedSearch::probe_start() {
  if (task_.memory == nullptr || !task_.memory->start) return;
  const StartPoint& start = *task_.memory->start;
  const Triangle& t = a_.corners[start.slot];
  const Vec3 a = vertex(t[0]);
  const Vec3 p = a + start.v * (vertex(t[1]) - a) + start.w * (vertex(t[2]) - a);
  const std::uint32_t hint = task_.memory->hints[t[0]];
  SearchKernel& kernel = *kernels_.front();
  kernel.begin(lower_);
  kernel.offer(p, kernel.nearest(p, hint != no_slot ? hint : 0, 0), start.slot);
  if (kernel.lower().lower > lower_.lower) lower_ = own_lower_ = kernel.lower();
}

void OneSidedSearch::drop_proven() {
  if (task_.memory == nullptr || decided()) return;
  const double lower = b_.frame.length_down(std::max(0.0, lower_.lower));
  if (alive_.empty()) alive_.assign(a_.triangle_count(), 1);
  double target = task_.decide_only ? task_.tolerance : lower + task_.error_bound;
  if (lower <= task_.tolerance) target = std::min(target, task_.tolerance);
  for (std::uint32_t slot = 0; slot < a_.triangle_count(); ++slot) {
    const double bound = task_.memory->proofs[slot].bound;
    if (alive_[slot] == 0 || bound > target) continue;
    alive_[slot] = 0;
    kept_upper_ = std::max(kept_upper_, bound);
    ++stats_.proven_before;
  }
}

/// Called for different triangles from different threads.
void OneSidedSearch::remember(std::uint32_t slot, double squared, std::uint32_t face) {
  if (task_.memory != nullptr) task_.memory->improve(slot, proven_model_length(squared, 0), face);
}

void OneSidedSearch::cover_and_record(SearchKernel& kernel, std::uint32_t slot, std::uint32_t start,
                                      Found& found) const {
  const Triangle& t = a_.corners[slot];
  CoverRecord record;
  record.names_all = task_.memory->names_faces;
  kernel.record_in(&record);
  kernel.cover(vertex(t[0]), vertex(t[1]), vertex(t[2]), slot, start, cuts_left_);
  kernel.record_in(nullptr);
  remember_cover(slot, record, found);
}

/// Called for different triangles from different threads. What rests on one triangle is written down at once.
void OneSidedSearch::remember_cover(std::uint32_t slot, const CoverRecord& record, Found& found) const {
  if (!record.proves()) return;
  if (record.slots.size() > 1) return found.covers.add(slot, record);
  task_.memory->improve(slot, proven_model_length(record.squared, deepest_cut), record.slots.front());
}

void OneSidedSearch::remember_walk(const Found& found) {
  std::uint32_t begin = 0;
  for (const FoundCovers::Cover& cover : found.covers.covers) {
    const std::span used(found.covers.faces.data() + begin, cover.end - begin);
    task_.memory->improve(cover.slot, proven_model_length(cover.squared, deepest_cut), used);
    begin = cover.end;
  }
}

void OneSidedSearch::remember_hints() {
  if (task_.memory == nullptr || nearest_ == nullptr || decided()) return;
  const std::size_t n = culled_ ? wanted_.size() : a_.vertices.size();
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t v = culled_ ? wanted_[i] : i;
    task_.memory->hints[v] = nearest_[v].slot;
  }
}

/// In coordinates of its triangle, which the next search may see in another frame. Near enough is good enough: any
/// v, w >= 0 with v + w <= 1 are a point of the triangle.
void OneSidedSearch::remember_start(const LowerBound& lower) {
  if (task_.memory == nullptr) return;
  const Triangle& t = a_.corners[lower.from_slot];
  const Vec3 a = vertex(t[0]), ab = vertex(t[1]) - a, ac = vertex(t[2]) - a, ap = lower.point - a;
  const double aa = dot(ab, ab), bb = dot(ac, ac), mixed = dot(ab, ac), d1 = dot(ab, ap), d2 = dot(ac, ap);
  const double determinant = aa * bb - mixed * mixed;
  double v = 0, w = 0;
  if (determinant > 0) {
    v = std::clamp((bb * d1 - mixed * d2) / determinant, 0.0, 1.0);
    w = std::clamp((aa * d2 - mixed * d1) / determinant, 0.0, 1.0 - v);
  }
  task_.memory->start = StartPoint{lower.from_slot, v, w};
}

}  // namespace meshbound
