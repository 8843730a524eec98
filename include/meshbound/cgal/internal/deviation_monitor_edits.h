// SPDX-License-Identifier: GPL-3.0-or-later
/// Edits beside collapses, and the search for a vertex position of low deviation; included by deviation_monitor.h.
#pragma once
#include <CGAL/boost/graph/Euler_operations.h>

#include "meshbound/cgal/deviation_monitor.h"

namespace meshbound::cgal {
namespace internal {

/// Rounds of six steps each, the steps halved after a round without gain.
constexpr int most_search_rounds = 6;
constexpr int most_halvings = 3;
/// A step or an edit that gains a smaller share is not worth its proof.
constexpr double least_step_gain = 1e-3;
constexpr double least_relocation_gain = 0.02;
constexpr double least_flip_gain = 0.05;
/// A collapse whose deviation is above this after a round, the worst sample at about three times the tolerance, is
/// given up.
constexpr double hopeless_deviation = 1000;
/// Where the worst sample is at a tenth of the tolerance there is nothing to gain.
constexpr double low_deviation = 1e-6;
/// Of the searched placement of a collapse: the step along the normal in tolerances, across in edge lengths.
constexpr double search_normal_step = 0.4;
constexpr double search_tangent_step = 0.15;

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

/// Unit normal of the faces that stay, weighted by area; zero where they cancel.
template <class Mesh, class VertexPointMap>
Eigen::Vector3d DeviationMonitor<Mesh, VertexPointMap>::normal_before() const {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (const auto& c : before_) normal += (c[1] - c[0]).cross(c[2] - c[0]);
  const double length = normal.norm();
  if (!(length > 0)) return Eigen::Vector3d::Zero();
  return normal / length;
}

template <class Mesh, class VertexPointMap>
auto DeviationMonitor<Mesh, VertexPointMap>::lower_deviation(Eigen::Vector3d p, double normal_step, double tangent_step)
    -> Sampled {
  place(p);
  Sampled result{p, tracker_.sampled_deviation(added_)};
  result.lowest = result.at_start;
  const Eigen::Vector3d normal = normal_before();
  const Eigen::Vector3d first = normal.unitOrthogonal(), second = normal.cross(first);
  int halvings = 0;
  for (int round = 0; round < internal::most_search_rounds && result.lowest > internal::low_deviation; ++round) {
    const double before = result.lowest;
    for (const Eigen::Vector3d& step : {Eigen::Vector3d(normal_step * normal), Eigen::Vector3d(tangent_step * first),
                                        Eigen::Vector3d(tangent_step * second)}) {
      for (const double sign : {1.0, -1.0}) {
        const Eigen::Vector3d q = result.point + sign * step;
        place(q);
        if (!passes_guards()) continue;
        const double sum = tracker_.sampled_deviation(added_, result.lowest);
        if (sum < (1 - internal::least_step_gain) * result.lowest) {
          result.point = q;
          result.lowest = sum;
          break;
        }
      }
    }
    if (result.lowest > internal::hopeless_deviation) break;
    if (result.lowest < 0.9 * before) continue;
    if (++halvings > internal::most_halvings) break;
    normal_step *= 0.5;
    tangent_step *= 0.5;
  }
  place(result.point);
  return result;
}

template <class Mesh, class VertexPointMap>
auto DeviationMonitor<Mesh, VertexPointMap>::searched_placement(const Point& p0, const Point& p1, const Point& wanted)
    -> Point {
  tracker_.sample(removed_);
  const double edge = (to_eigen(p0) - to_eigen(p1)).norm();
  return to_point(lower_deviation(to_eigen(wanted), internal::search_normal_step * tracker_.tolerance(),
                                  internal::search_tangent_step * edge)
                      .point);
}

template <class Mesh, class VertexPointMap>
void DeviationMonitor<Mesh, VertexPointMap>::commit_move(Vertex v, const Point& to) {
  tracker_.commit();
  put(points_, v, to);
  ++clock_;
  touch_around(v);
}

template <class Mesh, class VertexPointMap>
bool DeviationMonitor<Mesh, VertexPointMap>::relocate_vertex(Vertex v, double normal_step, double tangent_step) {
  if (is_border(v) || is_locked(v)) return false;
  gather_star(v, Graph::null_vertex(), get(points_, v));
  tracker_.sample(removed_);
  const Sampled found = lower_deviation(at(v), normal_step, tangent_step);
  if (found.lowest > (1 - internal::least_relocation_gain) * found.at_start || found.point == at(v)) return false;
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
/// topology or the guard forbids it.
template <class Mesh, class VertexPointMap>
bool DeviationMonitor<Mesh, VertexPointMap>::gather_flip(Halfedge h) {
  const Halfedge o = opposite(h, mesh_);
  const Vertex a = source(h, mesh_), b = target(h, mesh_);
  const Vertex c = target(next(h, mesh_), mesh_), d = target(next(o, mesh_), mesh_);
  if (c == d || degree(a, mesh_) <= 3 || degree(b, mesh_) <= 3 || CGAL::halfedge(c, d, mesh_).second) return false;
  removed_faces_ = {face(h, mesh_), face(o, mesh_)};
  removed_ = {get(face_ids_, removed_faces_[0]), get(face_ids_, removed_faces_[1])};
  before_ = {{at(a), at(b), at(c)}, {at(b), at(a), at(d)}};
  added_ = {{removed_[0], before_[0]}, {removed_[1], before_[1]}};
  const std::array<std::array<Eigen::Vector3d, 3>, 2> after = {{{at(a), at(d), at(c)}, {at(d), at(b), at(c)}}};
  for (const auto& face : after) {
    if (normal_guard && !(normal_guard->allows(before_[0], face) && normal_guard->allows(before_[1], face)))
      return false;
  }
  tracker_.sample(removed_);
  const double now = tracker_.sampled_deviation(added_);
  if (now < internal::low_deviation) return false;
  added_[0].corners = after[0];
  added_[1].corners = after[1];
  const double enough = (1 - internal::least_flip_gain) * now;
  return tracker_.sampled_deviation(added_, enough) < enough;
}

template <class Mesh, class VertexPointMap>
bool DeviationMonitor<Mesh, VertexPointMap>::flip_edge(Edge e) {
  const Halfedge h = halfedge(e, mesh_);
  const Vertex a = source(h, mesh_), b = target(h, mesh_);
  if (CGAL::is_border(e, mesh_) || is_locked(a) || is_locked(b) || !gather_flip(h)) return false;
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
  for (const Vertex v : around) {
    VertexMemory memory = get(vertex_memory_, v);
    memory.touched_at = clock_;
    put(vertex_memory_, v, memory);
  }
  return true;
}

}  // namespace meshbound::cgal
