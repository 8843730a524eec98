// SPDX-License-Identifier: GPL-3.0-or-later
/// Edge collapses where CGAL's own loop takes too long.
///
/// After each collapse `edge_collapse` asks for the cost of every edge of every vertex around, and the profile of an
/// edge lists all border edges of its ends. At a vertex with k edges, a hub as on every cylinder cap, that is k steps
/// for each of its k collapses, and k^2 where the mesh has a border. The loop here makes the same calls in the same
/// order but leaves the edges of a hub alone until collapses beside it have brought it down to `max_edges_of_vertex`:
/// they could hardly be collapsed anyway, as a collapse changes at most `DeviationTracker::most_added_faces` faces.
#pragma once
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Edge_profile.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <CGAL/boost/graph/Euler_operations.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include "meshbound/cgal/surface_mesh.h"

namespace meshbound::cgal {

namespace SMS = CGAL::Surface_mesh_simplification;

/// A mesh with a vertex of more edges is not for CGAL's loop.
inline constexpr std::uint32_t max_edges_for_cgal = 96;
/// Edges of vertices with more than this are left alone by the other loop.
inline constexpr std::uint32_t max_edges_of_vertex = 48;

[[nodiscard]] std::vector<std::uint32_t> edge_counts(const SurfaceMesh& mesh);

/// `edge_collapse` with these policies, for a mesh with hubs. O(n log n) beside what the policies do.
template <class Stop, class Cost, class Placement, class Filter, class Visitor, class Constraint>
class HubCollapse {
  using Vertex = SurfaceMesh::Vertex_index;
  using Halfedge = SurfaceMesh::Halfedge_index;
  using Edge = SurfaceMesh::Edge_index;
  using Point = Kernel::Point_3;
  using Vector = Kernel::Vector_3;
  using PointMap = SurfaceMesh::Property_map<Vertex, Point>;
  using Profile = SMS::Edge_profile<SurfaceMesh, PointMap, Kernel>;

 public:
  HubCollapse(SurfaceMesh& mesh, std::vector<std::uint32_t> edge_counts, const Stop& stop, const Cost& cost,
              const Placement& placement, const Filter& filter, Visitor visitor, const Constraint& constraint)
      : mesh_(mesh),
        stop_(stop),
        cost_(cost),
        placement_(placement),
        filter_(filter),
        visitor_(visitor),
        constraint_(constraint),
        has_border_(!CGAL::is_closed(mesh)),
        edge_count_(std::move(edge_counts)),
        queued_cost_(mesh.num_edges(), not_queued),
        marked_(mesh.num_vertices(), 0) {}

  void run() {
    visitor_.OnStarted(mesh_);
    cost_.initialize(mesh_, mesh_.points(), kernel_);
    for (const Edge e : mesh_.edges()) offer(e);
    initial_ = current_ = mesh_.number_of_edges();
    while (!queue_.empty()) {
      const auto [cost, e] = *queue_.begin();
      drop(e);
      const Profile profile = profile_of(e);
      visitor_.OnSelected(profile, boost::optional<double>(cost), initial_, current_);
      if (stop_(cost, profile, initial_, current_)) {
        visitor_.OnStopConditionReached(profile);
        break;
      }
      if (!try_collapse(profile)) visitor_.OnNonCollapsable(profile);
    }
    visitor_.OnFinished(mesh_);
  }

 private:
  static constexpr double not_queued = std::numeric_limits<double>::infinity();

  [[nodiscard]] bool is_hub(Vertex v) const { return edge_count_[v] > max_edges_of_vertex; }
  [[nodiscard]] Profile profile_of(Edge e) {
    const auto index = get(boost::vertex_index, mesh_);
    const auto halfedge_index = get(boost::halfedge_index, mesh_);
    return Profile(mesh_.halfedge(e), mesh_, kernel_, index, mesh_.points(), halfedge_index, has_border_);
  }

  void drop(Edge e) {
    if (queued_cost_[e] == not_queued) return;
    queue_.erase({queued_cost_[e], e});
    queued_cost_[e] = not_queued;
  }
  /// Puts the edge where its cost belongs now.
  void offer(Edge e) {
    const double cost = cost_of(e);
    if (cost == queued_cost_[e]) return;
    drop(e);
    if (cost == not_queued) return;
    queued_cost_[e] = cost;
    queue_.insert({cost, e});
  }
  [[nodiscard]] double cost_of(Edge e) {
    if (is_hub(mesh_.vertex(e, 0)) || is_hub(mesh_.vertex(e, 1)) || get(constraint_, e)) return not_queued;
    const Profile profile = profile_of(e);
    const boost::optional<double> cost = cost_(profile, placement_(profile));
    return cost && *cost < not_queued ? *cost : not_queued;
  }
  void offer_around(Vertex v) {
    for (const Halfedge h : CGAL::halfedges_around_target(mesh_.halfedge(v), mesh_)) offer(mesh_.edge(h));
  }

  bool try_collapse(const Profile& profile) {
    if (!keeps_manifold(profile)) return false;
    const boost::optional<Point> placement = placement_(profile);
    if (!placement || folds(profile, *placement) || !filter_(profile, placement)) return false;
    collapse(profile, placement);
    return true;
  }

  /// The ends have no neighbours in common but the apexes of the faces at the edge, and the surface stays one.
  [[nodiscard]] bool keeps_manifold(const Profile& profile) {
    const auto is_border = [&](Halfedge h) { return mesh_.is_border(mesh_.edge(h)); };
    const bool left = profile.left_face_exists(), right = profile.right_face_exists();
    if (left && is_border(profile.v1_vL()) && is_border(profile.vL_v0())) return false;
    if (right && is_border(profile.vR_v1()) && is_border(profile.v0_vR())) return false;
    ++round_;
    for (const Halfedge h : CGAL::halfedges_around_target(mesh_.halfedge(profile.v0()), mesh_))
      marked_[mesh_.source(h)] = round_;
    int common = 0;
    for (const Halfedge h : CGAL::halfedges_around_target(mesh_.halfedge(profile.v1()), mesh_))
      common += marked_[mesh_.source(h)] == round_ ? 1 : 0;
    if (common != int{left} + int{right}) return false;
    if (has_constrained_edge(profile.v0()) && has_constrained_edge(profile.v1())) return false;
    if (!left || !right) return true;
    if (mesh_.is_border(profile.v0()) && mesh_.is_border(profile.v1())) return false;
    return profile.vL() != profile.vR() && !CGAL::is_tetrahedron(profile.v0_v1(), mesh_);
  }
  [[nodiscard]] bool has_constrained_edge(Vertex v) const {
    const auto around = CGAL::halfedges_around_target(mesh_.halfedge(v), mesh_);
    return std::any_of(around.begin(), around.end(), [&](Halfedge h) { return get(constraint_, mesh_.edge(h)); });
  }

  /// True where two faces that would share an edge lie on each other but for a degree, or one is hardly there: what
  /// CGAL's loop refuses as well.
  [[nodiscard]] bool folds(const Profile& profile, const Point& placement) {
    beside_.clear();
    const auto is_end = [&](Vertex v) { return v == profile.v0() || v == profile.v1(); };
    for (const Vertex end : {profile.v0(), profile.v1()}) {
      for (const Halfedge h : CGAL::halfedges_around_target(mesh_.halfedge(end), mesh_)) {
        if (mesh_.is_border(h)) continue;
        const Vertex a = mesh_.source(h), b = mesh_.target(mesh_.next(h));
        if (is_end(a) || is_end(b)) continue;  // this face goes
        const Point &pa = mesh_.point(a), &pb = mesh_.point(b);
        const Vector normal = CGAL::cross_product(placement - pa, pb - pa);
        beside_.emplace_back(a, normal);
        beside_.emplace_back(b, normal);
        const Halfedge beyond = mesh_.opposite(mesh_.prev(h));  // from a to b
        const Vertex c = mesh_.target(mesh_.next(beyond));
        if (mesh_.is_border(beyond) || is_end(c)) continue;
        if (lie_on_each_other(normal, CGAL::cross_product(pb - pa, mesh_.point(c) - pa))) return true;
      }
    }
    std::sort(beside_.begin(), beside_.end(), [](const auto& m, const auto& n) { return m.first < n.first; });
    for (std::size_t i = 1; i < beside_.size(); ++i) {
      if (beside_[i].first == beside_[i - 1].first && lie_on_each_other(beside_[i].second, beside_[i - 1].second))
        return true;
    }
    return false;
  }
  [[nodiscard]] static bool lie_on_each_other(const Vector& m, const Vector& n) {
    constexpr double max_ratio_of_squared_areas = 1e8, squared_cosine_of_degree = 0.9996954135095479;
    const double mm = m.squared_length(), nn = n.squared_length(), mn = m * n;
    if (!(std::max(mm, nn) < max_ratio_of_squared_areas * std::min(mm, nn))) return true;
    return mn <= 0 && mn * mn > squared_cosine_of_degree * mm * nn;
  }

  void collapse(const Profile& profile, const boost::optional<Point>& placement) {
    visitor_.OnCollapsing(profile, placement);
    std::array<Edge, 5> around{mesh_.edge(profile.v0_v1())};
    std::size_t count = 1;
    std::array<Vertex, 2> apexes;
    std::size_t apex_count = 0;
    if (profile.left_face_exists()) {
      around[count++] = mesh_.edge(profile.v1_vL());
      around[count++] = mesh_.edge(profile.vL_v0());
      apexes[apex_count++] = profile.vL();
    }
    if (profile.right_face_exists()) {
      around[count++] = mesh_.edge(profile.vR_v1());
      around[count++] = mesh_.edge(profile.v0_vR());
      apexes[apex_count++] = profile.vR();
    }
    const Vertex kept = CGAL::Euler::collapse_edge(mesh_.edge(profile.v0_v1()), mesh_, constraint_);
    mesh_.point(kept) = *placement;
    current_ -= static_cast<SurfaceMesh::size_type>(1 + apex_count);
    for (std::size_t i = 0; i < count; ++i)
      if (mesh_.is_removed(around[i])) drop(around[i]);
    edge_count_[kept] = static_cast<std::uint32_t>(mesh_.degree(kept));
    visitor_.OnCollapsed(profile, kept);
    cost_.update_after_collapse(profile, kept);
    for (std::size_t i = 0; i < apex_count; ++i)
      if (--edge_count_[apexes[i]] == max_edges_of_vertex) offer_around(apexes[i]);
    neighbours_.clear();
    for (const Halfedge h : CGAL::halfedges_around_target(mesh_.halfedge(kept), mesh_))
      neighbours_.push_back(mesh_.source(h));
    for (const Vertex v : neighbours_)
      if (!is_hub(v)) offer_around(v);
  }

  SurfaceMesh& mesh_;
  const Stop& stop_;
  const Cost& cost_;
  const Placement& placement_;
  const Filter& filter_;
  Visitor visitor_;
  const Constraint& constraint_;
  bool has_border_;
  Kernel kernel_;
  std::vector<std::uint32_t> edge_count_;  ///< by vertex
  std::vector<double> queued_cost_;        ///< by edge
  std::set<std::pair<double, Edge>> queue_;
  std::vector<std::uint32_t> marked_;  ///< by vertex: the last round that it was marked in
  std::uint32_t round_ = 0;
  std::vector<std::pair<Vertex, Vector>> beside_;  ///< link vertices, with the normals of the new faces there
  std::vector<Vertex> neighbours_;
  SurfaceMesh::size_type initial_ = 0, current_ = 0;
};

/// CGAL's `edge_collapse`, but where the mesh has hubs.
template <class Stop, class Cost, class Placement, class Filter, class Visitor, class Constraint>
void collapse_edges(SurfaceMesh& mesh, const Stop& stop, const Cost& cost, const Placement& placement,
                    const Filter& filter, const Visitor& visitor, const Constraint& constraint) {
  std::vector<std::uint32_t> counts = edge_counts(mesh);
  if (std::any_of(counts.begin(), counts.end(), [](std::uint32_t count) { return count > max_edges_for_cgal; })) {
    HubCollapse(mesh, std::move(counts), stop, cost, placement, filter, visitor, constraint).run();
    return;
  }
  SMS::edge_collapse(
      mesh, stop,
      CGAL::parameters::get_cost(cost).get_placement(placement).filter(filter).visitor(visitor).edge_is_constrained_map(
          constraint));
}

}  // namespace meshbound::cgal
