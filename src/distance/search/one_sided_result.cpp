// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "distance/search/one_sided_search.h"
#include "distance/shortcuts/identical.h"
#include "geometry/safe_length.h"
#include "numeric/rounding.h"

namespace meshbound {
namespace {

Eigen::Vector3d to_world(const PlacedModel& model, const Vec3& working) {
  const Vec3 p = model.bvh->data().frame.to_model(working);
  return model.pose * Eigen::Vector3d(p.x, p.y, p.z);
}

/// The furthest point that was found, in coordinates of its triangle, which the next search may see in another frame.
/// Near enough is good enough: any v, w >= 0 with v + w <= 1 are a point of the triangle.
StartPoint start_point(const TriangleCorners& t, const LowerBound& lower) {
  const Vec3 a = t[0], ab = t[1] - a, ac = t[2] - a, ap = lower.point - a;
  const double aa = dot(ab, ab), bb = dot(ac, ac), mixed = dot(ab, ac), d1 = dot(ab, ap), d2 = dot(ac, ap);
  const double determinant = aa * bb - mixed * mixed;
  double v = 0, w = 0;
  if (determinant > 0) {
    v = std::clamp((bb * d1 - mixed * d2) / determinant, 0.0, 1.0);
    w = std::clamp((aa * d2 - mixed * d1) / determinant, 0.0, 1.0 - v);
  }
  return {lower.from_slot, v, w};
}

}  // namespace

/// The point that realises the best lower bound of this direction, else the furthest vertex met: where the other
/// direction's bound served, or the distance is 0, no point was proven on the way. Its closest triangle is asked for
/// here, once: on the way any triangle near enough served.
LowerBound OneSidedSearch::proven_witness() {
  LowerBound found = own_lower_;
  if (!(found.lower > 0)) {
    found.point = vertex(farthest_vertex_);
    found.nearest_slot = farthest_nearest_.squared < 0 ? 0 : farthest_nearest_.slot;
    found.from_slot = slot_using_vertex(a_, farthest_vertex_);
  }
  SearchKernel& kernel = *kernels_.front();
  const Nearest nearest = kernel.nearest(found.point, found.nearest_slot, 0);
  found.nearest_slot = nearest.slot;
  if (found.lower > 0) return found;
  kernel.begin({});
  kernel.offer(found.point, nearest, found.from_slot);
  found.lower = kernel.lower().lower;
  return found;
}

Witness OneSidedSearch::witness_at(const LowerBound& lower) const {
  const CornerTriangle<double> t = triangle_at(b_, lower.nearest_slot);
  const Vec3 nearest = lower.point - closest_on_triangle(t, lower.point).offset;
  Witness witness;
  witness.from = {to_world(task_.b, lower.point), a_.triangle_of_slot[lower.from_slot]};
  witness.nearest = {to_world(task_.b, nearest), b_.triangle_of_slot[lower.nearest_slot]};
  witness.distance = safe_length(witness.from.position - witness.nearest.position);
  return witness;
}

void OneSidedSearch::fill_stats() {
  std::uint64_t tested = 0;
  for (const auto& kernel : kernels_) {
    const WalkCounters& counters = kernel->counters();
    stats_.closest_point_queries += counters.queries.queries;
    stats_.nodes_visited += counters.queries.nodes;
    tested += counters.queries.triangles;
    stats_.subdivisions += counters.cuts;
    stats_.pieces += counters.pieces;
    stats_.resolved += counters.resolved;
    stats_.enclosed += counters.enclosed;
    stats_.given_up += counters.given_up;
    stats_.deepest_subdivision = std::max(stats_.deepest_subdivision, counters.deepest);
  }
  stats_.triangles_tested = tested;
  stats_.culled_by_vertices =
      stats_.triangles - stats_.matched - stats_.proven_before - stats_.culled_by_node - stats_.walked;
  stats_.culled_on_a_percent = 100 * (1 - static_cast<double>(stats_.walked) / static_cast<double>(stats_.triangles));
  const double all = static_cast<double>(stats_.closest_point_queries) * b_.triangle_count();
  stats_.culled_on_b_percent = all > 0 ? std::max(0.0, 100 * (1 - static_cast<double>(tested) / all)) : 100;
  stats_.seconds = seconds_since(task_.start);
}

/// No two points of the models are further apart than this: diagonals of boxes, without any search.
double OneSidedSearch::farthest_apart() const {
  const double radius_a = length(map_.rows[0]) * 0.5 * length(a_.working_box.hi - a_.working_box.lo);
  const double radius_b = 0.5 * length(b_.working_box.hi - b_.working_box.lo);
  const Vec3 centre_a = map_(0.5 * (a_.working_box.lo + a_.working_box.hi));
  const Vec3 centre_b = 0.5 * (b_.working_box.lo + b_.working_box.hi);
  return (length(centre_a - centre_b) + radius_a + radius_b) * (1 + 0x1p-20) + goal_.largest_slack();
}

/// All of A is within `upper` of B, model units: what the next search under other poses may build upon.
void OneSidedSearch::remember_front(double upper) {
  if (task_.memory == nullptr || !task_.memory->rigid || decided()) return;
  NodeFront& front = task_.memory->front;
  const double working = next_up(std::ldexp(upper, -b_.frame.exponent));
  if (front.is_new) {
    for (NodeFront::Node& node : front.nodes) node.upper = std::min(node.upper, working);
  } else if (stats_.proven_before < stats_.triangles) {
    front = {{{working, a_.levels() - 1, 0, 0}}, map_, goal_.slack};
  }
}

OneSidedDistance OneSidedSearch::result() {
  OneSidedDistance result;
  const LowerBound lower = proven_witness();
  std::uint32_t deepest = 0;
  for (const auto& kernel : kernels_) deepest = std::max(deepest, kernel->counters().deepest);
  double upper = 0;
  if (decided())
    upper = farthest_apart();
  else if (stats_.matched + stats_.proven_before < stats_.triangles)
    upper = goal_.proven_upper(upper_squared_, deepest);
  result.bounds.lower = b_.frame.length_down(std::max(0.0, lower.lower));
  result.bounds.upper = std::max({b_.frame.length_up(upper), known_upper_, result.bounds.lower});
  result.witness = witness_at(lower);
  remember_front(result.bounds.upper);
  if (task_.memory != nullptr) task_.memory->start = start_point(triangle(lower.from_slot), lower);
  const double proven = std::max(result.bounds.lower, known_lower_);
  const bool narrow = result.bounds.upper - proven <= task_.error_bound && !task_.decide_only;
  if (decided())
    result.outcome = Outcome::ExceedsTolerance;
  else if (narrow || (result.bounds.upper <= task_.tolerance && task_.decide_only))
    result.outcome = Outcome::Converged;
  else
    // Asked once more: it may have run out within the last batch.
    result.outcome = out_of_budget() ? Outcome::BudgetExhausted : Outcome::PrecisionReached;
  fill_stats();
  result.stats = stats_;
  return result;
}

}  // namespace meshbound
