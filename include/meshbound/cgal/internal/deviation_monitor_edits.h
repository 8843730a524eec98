// SPDX-License-Identifier: GPL-3.0-or-later
/// Edits beside collapses, and the search for a vertex position of low deviation; included by deviation_monitor.h.
#pragma once
#include <CGAL/boost/graph/Euler_operations.h>

#include "meshbound/cgal/deviation_monitor.h"

namespace meshbound::cgal {
namespace internal {

/// Newton steps of a search, and how often a step that gains nothing is shortened.
constexpr int most_newton_steps = 8;
constexpr int most_shorter_steps = 3;
constexpr double shorter_step = 0.35;
/// The curvature across the normal vanishes where the surface is flat; this share of the mean one is added to all.
constexpr double damping = 1e-3;
/// A step that gains a smaller share ends the search.
constexpr double least_step_gain = 0.01;
/// An edit that gains a smaller share is not worth its proof.
constexpr double least_relocation_gain = 0.02;
constexpr double least_flip_gain = 0.05;
/// Where the worst sample is at a tenth of the tolerance there is nothing to gain.
constexpr double low_deviation = 1e-6;
/// Some original vertex is further from the searched placement's faces than this, in tolerances: not worth a proof.
constexpr double largest_promising_deviation = 1.05;
/// Where no placement tried has a smaller sum, the worst sample at about twice the tolerance, a search finds none that
/// keeps the bound.
constexpr double hopeless_deviation = 50;
/// A step goes at most this share of the mean length of the edges.
constexpr double longest_step = 0.5;

/// For a placement of least largest deviation: it is computed anew this many times, as closest points move with it.
constexpr int most_minimax_steps = 3;
/// No placement is expected to be proven where some sample stays further off than this, in tolerances, as far as
/// distances are linear; and none is where one is further off than the tolerance (of 1,100 tried, none was).
constexpr double hopeless_height = 1.1;
constexpr double largest_provable_height = 1;
constexpr int most_shorter_moves = 3;
constexpr double shorter_move = 0.5;

}  // namespace internal

template <class Mesh, class VertexPointMap>
void DeviationMonitor<Mesh, VertexPointMap>::touch_around(Vertex v) {
  const std::uint64_t now = clock_;
  const auto touch = [&](Vertex w) {
    VertexMemory memory = get(vertex_memory_, w);
    memory.touched_at = now;
    put(vertex_memory_, w, memory);
  };
  touch(v);
  for (const Halfedge h : CGAL::halfedges_around_target(halfedge(v, mesh_), mesh_)) touch(source(h, mesh_));
}

template <class Mesh, class VertexPointMap>
void DeviationMonitor<Mesh, VertexPointMap>::place(const Eigen::Vector3d& p) {
  for (std::size_t i = 0; i < added_.size(); ++i) added_[i].corners[moved_corner_[i]] = p;
}

template <class Mesh, class VertexPointMap>
void DeviationMonitor<Mesh, VertexPointMap>::changed(Vertex v) {
  VertexMemory memory = get(vertex_memory_, v);
  memory.moved_at = memory.touched_at = clock_;
  put(vertex_memory_, v, memory);
}

/// Newton's method with shorter steps where a whole one does not lower the sum or the guard forbids it.
template <class Mesh, class VertexPointMap>
auto DeviationMonitor<Mesh, VertexPointMap>::lower_deviation(const Eigen::Vector3d& p, double reach) -> Sampled {
  place(p);
  Sampled result{p, tracker_.sampled_deviation(added_, moved_corner_), 0};
  result.at_start = result.lowest.sum;
  bool gains = result.lowest.sum > internal::low_deviation;
  for (int k = 0; k < internal::most_newton_steps && gains; ++k) {
    gains = false;
    Eigen::Matrix3d curvature = result.lowest.curvature;
    const double mean = curvature.trace() / 3;
    if (!(mean > 0)) break;
    curvature.diagonal().array() += internal::damping * mean;
    Eigen::Vector3d step = -curvature.ldlt().solve(result.lowest.gradient);
    const double length = step.norm();
    if (!(length > 0)) break;
    if (length > reach) step *= reach / length;
    for (int shorter = 0; shorter <= internal::most_shorter_steps; ++shorter, step *= internal::shorter_step) {
      const Eigen::Vector3d q = result.point + step;
      place(q);
      if (!passes_guards()) continue;
      const SampledDeviation there = tracker_.sampled_deviation(added_, moved_corner_);
      if (!(there.sum < result.lowest.sum)) continue;
      gains = there.sum < (1 - internal::least_step_gain) * result.lowest.sum;
      result.point = q;
      result.lowest = there;
      break;
    }
  }
  place(result.point);
  return result;
}

/// Of the edges that end in the vertex that moves, as they are in `added_`.
template <class Mesh, class VertexPointMap>
double DeviationMonitor<Mesh, VertexPointMap>::mean_edge() const {
  double sum = 0;
  for (std::size_t i = 0; i < added_.size(); ++i) {
    const std::size_t k = moved_corner_[i];
    sum += (added_[i].corners[(k + 1) % 3] - added_[i].corners[k]).norm();
  }
  return added_.empty() ? 0 : sum / static_cast<double>(added_.size());
}

/// False where a sample says that a proof of the gathered star would fail. Notes the best placement seen.
template <class Mesh, class VertexPointMap>
bool DeviationMonitor<Mesh, VertexPointMap>::is_promising(const Eigen::Vector3d& placement) {
  if (std::exchange(must_sample_, false)) {
    tracker_.sample(removed_);
    best_sampled_.reset();
  }
  if (!passes_guards()) return false;
  const SampledDeviation there = tracker_.sampled_deviation(added_, moved_corner_);
  if (!best_sampled_ || there.sum < best_sampled_->second) best_sampled_.emplace(placement, there.sum);
  return there.worst <= internal::largest_promising_deviation;
}

/// Where the sampled deviation around the edge tested last is least; none where that is no good.
template <class Mesh, class VertexPointMap>
auto DeviationMonitor<Mesh, VertexPointMap>::searched_placement(const Point& p0, const Point& p1)
    -> std::optional<Point> {
  if (!best_sampled_ || best_sampled_->second > internal::hopeless_deviation) return std::nullopt;
  const double reach = internal::longest_step * (to_eigen(p0) - to_eigen(p1)).norm();
  const Sampled found = lower_deviation(best_sampled_->first, reach);
  if (found.lowest.worst > internal::largest_promising_deviation) return std::nullopt;
  return to_point(found.point);
}

template <class Mesh, class VertexPointMap>
auto DeviationMonitor<Mesh, VertexPointMap>::moved_within_guards(const Eigen::Vector3d& p, Eigen::Vector3d move)
    -> std::optional<Eigen::Vector3d> {
  for (int k = 0; k < internal::most_shorter_moves; ++k, move *= internal::shorter_move) {
    place(p + move);
    if (passes_guards()) return p + move;
  }
  return std::nullopt;
}

/// Of the gathered star. Not a proof, but nothing else is expected to keep the bound either.
template <class Mesh, class VertexPointMap>
void DeviationMonitor<Mesh, VertexPointMap>::take_first_step() {
  tracker_.sample_heights(removed_);
  first_step_ = tracker_.height_step(added_, moved_corner_);
  hopeless_ = first_step_->there > internal::hopeless_height;
  refused_by_bound_ = refused_by_bound_ || hopeless_;
}

/// Starts from the first of the placements that the guards allow. None where no placement is expected to keep the
/// bound.
template <class Mesh, class VertexPointMap>
auto DeviationMonitor<Mesh, VertexPointMap>::minimax_placement(const Point& p0, const Point& p1, const Point& wanted)
    -> std::optional<Point> {
  const std::array<Point, 4> starts = {wanted, CGAL::midpoint(p0, p1), p0, p1};
  const auto start = std::find_if(starts.begin(), starts.end(), [&](const Point& p) {
    place(to_eigen(p));
    return passes_guards();
  });
  if (start == starts.end()) return std::nullopt;
  if (!first_step_) take_first_step();
  const double reach = internal::longest_step * (to_eigen(p0) - to_eigen(p1)).norm();
  Eigen::Vector3d at = to_eigen(*start), best = at;
  double least = HUGE_VAL;
  for (int k = 0; k <= internal::most_minimax_steps; ++k) {
    const HeightStep step = k == 0 ? *first_step_ : tracker_.height_step(added_, moved_corner_);
    if (step.here < least) least = step.here, best = at;
    const bool found = k > 0 && step.here <= internal::largest_provable_height;
    if (found || step.there > internal::hopeless_height || k == internal::most_minimax_steps) break;
    const double length = step.move.norm();
    if (!(length > 0)) break;
    const auto next = moved_within_guards(at, std::min(1.0, reach / length) * step.move);
    if (!next) break;
    at = *next;
  }
  hopeless_ = least > internal::largest_provable_height;
  if (hopeless_) return std::nullopt;
  return to_point(best);
}

template <class Mesh, class VertexPointMap>
void DeviationMonitor<Mesh, VertexPointMap>::commit_move(Vertex v, const Point& to) {
  tracker_.commit();
  put(points_, v, to);
  ++clock_;
  touch_around(v);
  changed(v);
}

template <class Mesh, class VertexPointMap>
bool DeviationMonitor<Mesh, VertexPointMap>::relocate_vertex(Vertex v) {
  if (is_border(v) || is_locked(v)) return false;
  gather_star(v, Graph::null_vertex(), get(points_, v));
  tracker_.sample(removed_);
  const Sampled found = lower_deviation(at(v), internal::longest_step * mean_edge());
  if (found.lowest.sum > (1 - internal::least_relocation_gain) * found.at_start || found.point == at(v)) return false;
  if (!admits_gathered(v, v, found.point, SurfaceChange::no_triangle)) return false;
  commit_move(v, to_point(found.point));
  return true;
}

template <class Mesh, class VertexPointMap>
bool DeviationMonitor<Mesh, VertexPointMap>::move_vertex(Vertex v, const Point& to) {
  if (is_border(v) || is_locked(v)) return false;
  gather_star(v, Graph::null_vertex(), to);
  if (!admits_gathered(v, v, to_eigen(to), SurfaceChange::no_triangle)) return false;
  commit_move(v, to);
  return true;
}

/// The faces (a, b, c) and (b, a, d) at h = a -> b before, and (a, d, c) and (d, b, c) after a flip; false where
/// topology, a lock or the guard forbids it.
template <class Mesh, class VertexPointMap>
bool DeviationMonitor<Mesh, VertexPointMap>::gather_flip(Edge e) {
  if (CGAL::is_border(e, mesh_)) return false;
  const Halfedge h = halfedge(e, mesh_), o = opposite(h, mesh_);
  const Vertex a = source(h, mesh_), b = target(h, mesh_);
  const Vertex c = target(next(h, mesh_), mesh_), d = target(next(o, mesh_), mesh_);
  if (is_locked(a) || is_locked(b)) return false;
  if (c == d || degree(a, mesh_) <= 3 || degree(b, mesh_) <= 3 || CGAL::halfedge(c, d, mesh_).second) return false;
  removed_faces_ = {face(h, mesh_), face(o, mesh_)};
  removed_ = {get(face_ids_, removed_faces_[0]), get(face_ids_, removed_faces_[1])};
  before_ = {{at(a), at(b), at(c)}, {at(b), at(a), at(d)}};
  added_ = {{removed_[0], {at(a), at(d), at(c)}}, {removed_[1], {at(d), at(b), at(c)}}};
  moved_corner_ = {1, 2};  // their edge to the next corner is the one that both have
  for (const TrackedFace& face : added_) {
    if (normal_guard &&
        !(normal_guard->allows(before_[0], face.corners) && normal_guard->allows(before_[1], face.corners)))
      return false;
  }
  return true;
}

template <class Mesh, class VertexPointMap>
bool DeviationMonitor<Mesh, VertexPointMap>::flip_lowers_deviation() {
  const std::array<TrackedFace, 2> before = {{{removed_[0], before_[0]}, {removed_[1], before_[1]}}};
  const std::array<std::size_t, 2> common_edge = {0, 0};  // as `moved_corner_`
  tracker_.sample(removed_);
  const double now = tracker_.sampled_deviation(before, common_edge).sum;
  return now >= internal::low_deviation &&
         tracker_.sampled_deviation(added_, moved_corner_).sum < (1 - internal::least_flip_gain) * now;
}

/// Of the edge that was gathered.
template <class Mesh, class VertexPointMap>
bool DeviationMonitor<Mesh, VertexPointMap>::make_flip(Edge e) {
  const Halfedge h = halfedge(e, mesh_);
  const Vertex a = source(h, mesh_), b = target(h, mesh_);
  if (!admits_gathered(a, b, added_[0].corners[1], SurfaceChange::no_triangle)) return false;
  tracker_.commit();
  const std::array<Vertex, 4> around = {a, b, target(next(h, mesh_), mesh_),
                                        target(next(opposite(h, mesh_), mesh_), mesh_)};
  CGAL::Euler::flip_edge(h, mesh_);
  for (const Face f : removed_faces_) {
    const std::array<Vertex, 3> v = corners(f);
    put(face_ids_, f, std::find(v.begin(), v.end(), a) != v.end() ? removed_[0] : removed_[1]);
  }
  put(edge_memory_, e, EdgeMemory{});
  ++clock_;
  for (const Vertex v : around) changed(v);
  return true;
}

template <class Mesh, class VertexPointMap>
bool DeviationMonitor<Mesh, VertexPointMap>::flip_edge(Edge e) {
  return gather_flip(e) && flip_lowers_deviation() && make_flip(e);
}

template <class Mesh, class VertexPointMap>
bool DeviationMonitor<Mesh, VertexPointMap>::turn_edge(Edge e) {
  return gather_flip(e) && make_flip(e);
}

}  // namespace meshbound::cgal
