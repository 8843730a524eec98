// SPDX-License-Identifier: GPL-3.0-or-later
/// The two-sided bound as policies for `CGAL::Surface_mesh_simplification::edge_collapse`:
///
///     meshbound::cgal::DeviationMonitor monitor(mesh, tolerance);   // the original is `mesh` as it is now
///     SMS::edge_collapse(mesh, monitor.stop_predicate(),
///                        CGAL::parameters::filter(monitor.filter()).visitor(monitor.visitor()));
///
/// What `edge_collapse` calls, and what the monitor does there:
///
///     for each edge, cheapest first
///       visitor.OnSelected
///       stop_predicate(...)                 -> true: the run ends      asks DeviationMonitor::should_stop
///       link condition, placement, geometric validity
///       filter(profile, placement)          -> none: next edge         proves the collapse both ways, or refuses it
///       visitor.OnCollapsing, collapse,     visitor.OnCollapsed        commits the proof, notes where the mesh changed
///
/// Filter and visitor must be used together; either may be wrapped (as `Bounded_normal_change_filter` does with a
/// filter), and both are copyable handles on the monitor, which must outlive them. `monitor.placement(base)` wraps a
/// placement so that others are tried where the one of `base` breaks the bound; it gives fewer faces. CGAL 5 and 6.
#pragma once
#include <CGAL/boost/graph/helpers.h>
#include <CGAL/boost/graph/iterator.h>
#include <CGAL/boost/graph/properties.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "meshbound/bvh.h"
#include "meshbound/cgal/normal_guard.h"
#include "meshbound/cgal/surface_mesh.h"
#include "meshbound/deviation_tracker.h"

namespace meshbound::cgal {

template <class Mesh, class VertexPointMap = typename boost::property_map<Mesh, CGAL::vertex_point_t>::type>
class DeviationMonitor {
  using Graph = boost::graph_traits<Mesh>;
  using Vertex = typename Graph::vertex_descriptor;
  using Halfedge = typename Graph::halfedge_descriptor;
  using Edge = typename Graph::edge_descriptor;
  using Face = typename Graph::face_descriptor;
  using Point = typename boost::property_traits<VertexPointMap>::value_type;

 public:
  class Filter;
  class StopPredicate;
  class Visitor;
  template <class Base>
  class Placement;

  struct Counts {
    std::uint64_t performed = 0;
    std::uint64_t refused = 0;   ///< tested and found to break the bound
    std::uint64_t repeated = 0;  ///< refused without a test: nothing near has changed since the last one
  };

  /// The original is `mesh` as it is now. Throws `InvalidInput` when a face is not a triangle, when an edge has length
  /// zero (CGAL collapses these without asking a filter; weld the vertices first), and as `DeviationTracker` does.
  DeviationMonitor(Mesh& mesh, double tolerance) : DeviationMonitor(mesh, tolerance, get(CGAL::vertex_point, mesh)) {}
  DeviationMonitor(Mesh& mesh, double tolerance, VertexPointMap points)
      : DeviationMonitor(mesh, to_triangle_mesh(mesh, points), {}, tolerance, points) {}

  /// The original is a soup of which `mesh` is a manifold copy: its k-th face, in order of the range of faces, is
  /// triangle `triangle_of_face[k]` (k itself where the vector is empty). Triangles that no face is made from count as
  /// well. `uncovered` tells which of them lie nowhere near the copy; they are kept as they are, see there.
  DeviationMonitor(Mesh& mesh, const TriangleMesh& original, const std::vector<std::uint32_t>& triangle_of_face,
                   double tolerance, VertexPointMap points);

  DeviationMonitor(const DeviationMonitor&) = delete;
  DeviationMonitor& operator=(const DeviationMonitor&) = delete;

  [[nodiscard]] Filter filter() { return Filter(*this); }
  [[nodiscard]] StopPredicate stop_predicate() { return StopPredicate(*this); }
  [[nodiscard]] Visitor visitor() { return Visitor(*this); }

  template <class Base>
  [[nodiscard]] Placement<Base> placement(const Base& base) {
    return Placement<Base>(*this, base);
  }

  /// Checked for every face that a collapse moves, before the bound. None by default: users stack filters of their own.
  std::optional<NormalGuard> normal_guard;

  /// `Placement` then never moves a vertex of the border by itself.
  bool preserve_boundary = false;

  /// Ends the next run when it returns true; asked before each collapse, with the number of faces left. None: never.
  std::function<bool(std::size_t faces)> should_stop;

  /// Triangles of the original that the mesh has no face for and near. The bound holds for the mesh together with them.
  [[nodiscard]] const std::vector<std::uint32_t>& uncovered() const { return uncovered_; }

  /// Call before another `edge_collapse` on the same mesh: edges refused before are tried again where the mesh around
  /// them has changed since.
  void begin_pass() { pass_start_ = ++clock_; }
  /// Goes on with a larger tolerance; every edge is tried again. Throws `InvalidInput` for a smaller one.
  void grow_tolerance(double tolerance) {
    tracker_.grow_tolerance(tolerance);
    tolerance_start_ = pass_start_ = ++clock_;
  }

  /// True when the collapse of the edge of `profile` into `placement` keeps the bound. `Visitor::OnCollapsing` commits
  /// the last one that was admitted.
  template <class Profile>
  [[nodiscard]] bool admits(const Profile& profile, const Point& placement);

  /// The first placement that keeps the bound: `wanted`, or one of those that `Placement` lists. None: the edge is
  /// refused, and the filter that CGAL asks next will say so without another test.
  template <class Profile>
  [[nodiscard]] std::optional<Point> admitted_placement(const Profile& profile, const Point& wanted);

  [[nodiscard]] std::size_t faces() const { return faces_; }
  [[nodiscard]] const Counts& counts() const { return counts_; }
  /// True when the last collapse that was refused broke the bound: not the normal guard, nor an unchanged repetition.
  [[nodiscard]] bool last_refusal_by_bound() const { return refused_by_bound_; }
  [[nodiscard]] const Bvh& original_bvh() const { return bvh_; }
  [[nodiscard]] const DeviationTracker& tracker() const { return tracker_; }
  /// Calls `visit(corners)` for each face that the mesh would have after the collapse that was tested last.
  template <class Visit>
  void for_each_face_after_refused(const Visit& visit) const;

 private:
  struct EdgeMemory {
    std::uint64_t refused_at = 0;  ///< clock; 0: never
    std::uint32_t uncovered = SurfaceChange::no_triangle;
  };
  struct VertexMemory {
    std::uint64_t moved_at = 0;    ///< clock of the last collapse into this vertex
    std::uint64_t touched_at = 0;  ///< clock of the last collapse into this vertex or a neighbour
  };

  [[nodiscard]] static Eigen::Vector3d to_eigen(const Point& p) {
    return {CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z())};
  }
  [[nodiscard]] Eigen::Vector3d at(Vertex v) const { return to_eigen(get(points_, v)); }
  void number_faces(const std::vector<std::uint32_t>& triangle_of_face);
  void refuse_zero_length_edges() const;
  template <class Visit>
  void for_each_face_around(Vertex v, const Visit& visit) const;
  [[nodiscard]] std::array<Vertex, 3> corners(Face f) const {
    const Halfedge h = halfedge(f, mesh_);
    return {source(h, mesh_), target(h, mesh_), target(next(h, mesh_), mesh_)};
  }
  [[nodiscard]] bool is_border(Vertex v) const { return bool(CGAL::is_border(v, mesh_)); }
  [[nodiscard]] bool passes_guards() const;
  [[nodiscard]] bool test(Halfedge h, Vertex v0, Vertex v1, const Point& placement, std::uint32_t try_first);
  void gather_star(Vertex v0, Vertex v1, const Point& placement);
  /// The k-th of `fallback_placements` placements beside `wanted`, for the edge whose star was gathered last.
  static constexpr int fallback_placements = 7;
  [[nodiscard]] Point fallback(int k, const Point& p0, const Point& p1, const Point& wanted) const;
  void append_ring(Vertex v0, Vertex v1, std::vector<std::uint32_t>& ring) const;
  [[nodiscard]] bool nothing_changed_since(const EdgeMemory& memory, Vertex v0, Vertex v1) const;
  void collapsed_into(Vertex v);

  Mesh& mesh_;
  VertexPointMap points_;
  Bvh bvh_;
  DeviationTracker tracker_;
  typename boost::property_map<Mesh, CGAL::dynamic_face_property_t<std::uint32_t>>::type face_ids_;
  typename boost::property_map<Mesh, CGAL::dynamic_edge_property_t<EdgeMemory>>::type edge_memory_;
  typename boost::property_map<Mesh, CGAL::dynamic_vertex_property_t<VertexMemory>>::type vertex_memory_;
  std::vector<std::uint32_t> uncovered_;
  std::size_t faces_ = 0;
  std::uint64_t clock_ = 1, pass_start_ = 1, tolerance_start_ = 1;
  Counts counts_;

  std::vector<std::uint32_t> removed_;
  std::vector<Face> removed_faces_;
  std::vector<TrackedFace> added_;
  std::vector<std::array<Eigen::Vector3d, 3>> before_;  ///< of each of `added_`
  std::optional<Halfedge> selected_;                    ///< popped from the queue, its placement not yet asked for
  std::optional<std::pair<Halfedge, Point>> refused_;   ///< by the placement, for the filter that follows
  bool refused_by_bound_ = false;
  std::optional<std::pair<Halfedge, Point>> admitted_;
  bool collapsing_ = false;
};

/// Takes a profile and an optional placement of CGAL (boost:: or std::optional), returns it, or none to refuse.
template <class Mesh, class VertexPointMap>
class DeviationMonitor<Mesh, VertexPointMap>::Filter {
 public:
  explicit Filter(DeviationMonitor& monitor) : monitor_(&monitor) {}

  template <class Profile, class OptionalPoint>
  OptionalPoint operator()(const Profile& profile, const OptionalPoint& placement) const {
    if (!placement || !monitor_->admits(profile, *placement)) return OptionalPoint();
    return placement;
  }

 private:
  DeviationMonitor* monitor_;
};

/// Gives the placement of `base`, but when CGAL is about to collapse the edge: then the first of that one, the ends and
/// the middle of the edge, and points beside it along the normal, that keeps the bound. (CGAL asks a placement for the
/// costs of all edges, too, where a proof would be wasted, and ignores the placement that a filter returns.)
template <class Mesh, class VertexPointMap>
template <class Base>
class DeviationMonitor<Mesh, VertexPointMap>::Placement {
 public:
  Placement(DeviationMonitor& monitor, const Base& base) : monitor_(&monitor), base_(base) {}

  template <class Profile>
  auto operator()(const Profile& profile) const -> decltype(std::declval<const Base&>()(profile)) {
    auto placement = base_(profile);
    if (!placement || monitor_->selected_ != profile.v0_v1()) return placement;
    monitor_->selected_.reset();
    if (const std::optional<Point> admitted = monitor_->admitted_placement(profile, *placement)) *placement = *admitted;
    return placement;
  }

 private:
  DeviationMonitor* monitor_;
  Base base_;
};

template <class Mesh, class VertexPointMap>
class DeviationMonitor<Mesh, VertexPointMap>::StopPredicate {
 public:
  explicit StopPredicate(DeviationMonitor& monitor) : monitor_(&monitor) {}

  template <class Cost, class Profile, class Size>
  bool operator()(const Cost&, const Profile&, Size, Size) const {
    return monitor_->should_stop && monitor_->should_stop(monitor_->faces());
  }

 private:
  DeviationMonitor* monitor_;
};

template <class Mesh, class VertexPointMap>
class DeviationMonitor<Mesh, VertexPointMap>::Visitor {
 public:
  explicit Visitor(DeviationMonitor& monitor) : monitor_(&monitor) {}

  template <class AnyMesh>
  void OnStarted(AnyMesh&) const {}
  template <class AnyMesh>
  void OnFinished(AnyMesh&) const {}
  template <class Profile>
  void OnStopConditionReached(const Profile&) const {}
  template <class Profile, class OptionalCost>
  void OnCollected(const Profile&, const OptionalCost&) const {}
  template <class Profile, class OptionalCost, class Size>
  void OnSelected(const Profile& profile, const OptionalCost&, Size, Size) const {
    monitor_->selected_ = profile.v0_v1();
  }
  template <class Profile>
  void OnNonCollapsable(const Profile&) const {}

  /// Throws `Error` when the collapse is not the one that the filter admitted last.
  template <class Profile, class OptionalPoint>
  void OnCollapsing(const Profile& profile, const OptionalPoint& placement) const {
    auto& admitted = monitor_->admitted_;
    if (!admitted || !placement || admitted->first != profile.v0_v1() || admitted->second != *placement)
      throw Error("a collapse that the deviation monitor has not admitted: pass its filter to edge_collapse too");
    admitted.reset();
    monitor_->tracker_.commit();
    monitor_->collapsing_ = true;
    monitor_->faces_ -= (profile.left_face_exists() ? 1u : 0u) + (profile.right_face_exists() ? 1u : 0u);
  }
  /// Throws `Error` for the collapses of zero-length edges that CGAL makes without asking.
  template <class Profile, class AnyVertex>
  void OnCollapsed(const Profile&, const AnyVertex& v) const {
    if (!monitor_->collapsing_)
      throw Error("a zero-length edge was collapsed without asking the deviation monitor; weld equal vertices first");
    monitor_->collapsing_ = false;
    monitor_->collapsed_into(v);
  }

 private:
  DeviationMonitor* monitor_;
};

template <class Mesh, class VertexPointMap>
DeviationMonitor<Mesh, VertexPointMap>::DeviationMonitor(Mesh& mesh, const TriangleMesh& original,
                                                         const std::vector<std::uint32_t>& triangle_of_face,
                                                         double tolerance, VertexPointMap points)
    : mesh_(mesh),
      points_(points),
      bvh_(MeshView(original)),
      tracker_(MeshView(original), bvh_, tolerance),
      face_ids_(get(CGAL::dynamic_face_property_t<std::uint32_t>(), mesh)),
      edge_memory_(get(CGAL::dynamic_edge_property_t<EdgeMemory>(), mesh)),
      vertex_memory_(get(CGAL::dynamic_vertex_property_t<VertexMemory>(), mesh)) {
  for (const Edge e : edges(mesh_)) put(edge_memory_, e, EdgeMemory{});
  for (const Vertex v : vertices(mesh_)) put(vertex_memory_, v, VertexMemory{});
  refuse_zero_length_edges();
  number_faces(triangle_of_face);
}

template <class Mesh, class VertexPointMap>
void DeviationMonitor<Mesh, VertexPointMap>::number_faces(const std::vector<std::uint32_t>& triangle_of_face) {
  for (const Face f : CGAL::faces(mesh_)) {
    const auto id = static_cast<std::uint32_t>(faces_++);
    put(face_ids_, f, id);
    tracker_.start(id, triangle_of_face.empty() ? id : triangle_of_face.at(id));
  }
  uncovered_ = tracker_.cover_the_rest();
  auto id = static_cast<std::uint32_t>(faces_);
  for (const std::uint32_t t : uncovered_) tracker_.start(id++, t);
}

template <class Mesh, class VertexPointMap>
void DeviationMonitor<Mesh, VertexPointMap>::refuse_zero_length_edges() const {
  for (const Edge e : edges(mesh_)) {
    const Halfedge h = halfedge(e, mesh_);
    if (at(source(h, mesh_)) == at(target(h, mesh_)))
      throw InvalidInput("an edge has length zero, which CGAL collapses without asking; weld equal vertices first");
  }
}

template <class Mesh, class VertexPointMap>
template <class Visit>
void DeviationMonitor<Mesh, VertexPointMap>::for_each_face_around(Vertex v, const Visit& visit) const {
  for (const Halfedge h : CGAL::halfedges_around_target(halfedge(v, mesh_), mesh_)) {
    const Face f = face(h, mesh_);
    if (f != Graph::null_face()) visit(f);
  }
}

template <class Mesh, class VertexPointMap>
void DeviationMonitor<Mesh, VertexPointMap>::gather_star(Vertex v0, Vertex v1, const Point& placement) {
  removed_.clear();
  removed_faces_.clear();
  added_.clear();
  before_.clear();
  const Eigen::Vector3d moved = to_eigen(placement);
  const auto visit = [&](Face f, Vertex around, Vertex other) {
    const std::array<Vertex, 3> v = corners(f);
    const bool both = v[0] == other || v[1] == other || v[2] == other;
    if (both && around == v1) return;  // seen from v0
    removed_.push_back(get(face_ids_, f));
    removed_faces_.push_back(f);
    if (both) return;
    TrackedFace& face = added_.emplace_back();
    face.id = removed_.back();
    auto& before = before_.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) {
      before[i] = at(v[i]);
      face.corners[i] = v[i] == around ? moved : before[i];
    }
  };
  for_each_face_around(v0, [&](Face f) { visit(f, v0, v1); });
  for_each_face_around(v1, [&](Face f) { visit(f, v1, v0); });
}

template <class Mesh, class VertexPointMap>
void DeviationMonitor<Mesh, VertexPointMap>::append_ring(Vertex v0, Vertex v1, std::vector<std::uint32_t>& ring) const {
  for (const Face star : removed_faces_) {
    for (const Vertex v : corners(star)) {
      if (v == v0 || v == v1) continue;
      for_each_face_around(v, [&](Face f) {
        const std::uint32_t id = get(face_ids_, f);
        if (std::find(removed_.begin(), removed_.end(), id) == removed_.end() &&
            std::find(ring.begin(), ring.end(), id) == ring.end())
          ring.push_back(id);
      });
    }
  }
}

template <class Mesh, class VertexPointMap>
template <class Visit>
void DeviationMonitor<Mesh, VertexPointMap>::for_each_face_after_refused(const Visit& visit) const {
  for (const Face f : CGAL::faces(mesh_)) {
    if (std::find(removed_faces_.begin(), removed_faces_.end(), f) != removed_faces_.end()) continue;
    const std::array<Vertex, 3> v = corners(f);
    visit(std::array<Eigen::Vector3d, 3>{at(v[0]), at(v[1]), at(v[2])});
  }
  for (const TrackedFace& face : added_) visit(face.corners);
}

/// Zero-length edges must never come to be: CGAL would collapse them without asking when the next pass begins.
template <class Mesh, class VertexPointMap>
bool DeviationMonitor<Mesh, VertexPointMap>::passes_guards() const {
  for (std::size_t i = 0; i < added_.size(); ++i) {
    const auto& c = added_[i].corners;
    if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) return false;
    if (normal_guard && !normal_guard->allows(before_[i], c)) return false;
  }
  return true;
}

/// An edge that was refused is not tried again in the same pass unless one of its ends has moved; in the next pass,
/// when something changed among the neighbours of an end; and always after the tolerance has grown.
template <class Mesh, class VertexPointMap>
bool DeviationMonitor<Mesh, VertexPointMap>::nothing_changed_since(const EdgeMemory& memory, Vertex v0,
                                                                   Vertex v1) const {
  if (memory.refused_at <= tolerance_start_) return false;
  const VertexMemory a = get(vertex_memory_, v0), b = get(vertex_memory_, v1);
  if (memory.refused_at > pass_start_) return std::max(a.moved_at, b.moved_at) < memory.refused_at;
  return std::max(a.touched_at, b.touched_at) < memory.refused_at;
}

template <class Mesh, class VertexPointMap>
bool DeviationMonitor<Mesh, VertexPointMap>::test(Halfedge h, Vertex v0, Vertex v1, const Point& placement,
                                                  std::uint32_t try_first) {
  gather_star(v0, v1, placement);
  if (!passes_guards()) return false;
  SurfaceChange change;
  change.removed = removed_;
  change.added = added_;
  change.moved_vertex = to_eigen(placement);
  change.try_first = try_first;
  change.ring = [this, v0, v1](std::vector<std::uint32_t>& ring) { append_ring(v0, v1, ring); };
  if (!tracker_.admits(change)) {
    refused_by_bound_ = true;
    return false;
  }
  admitted_.emplace(h, placement);
  return true;
}

template <class Mesh, class VertexPointMap>
template <class Profile>
bool DeviationMonitor<Mesh, VertexPointMap>::admits(const Profile& profile, const Point& placement) {
  const std::pair<Halfedge, Point> asked(profile.v0_v1(), placement);
  if (admitted_ == asked) return true;
  const bool refused = refused_ == asked;
  admitted_.reset();
  refused_.reset();
  if (refused) return false;
  refused_by_bound_ = false;
  const Edge e = edge(profile.v0_v1(), mesh_);
  const EdgeMemory memory = get(edge_memory_, e);
  if (nothing_changed_since(memory, profile.v0(), profile.v1())) {
    ++counts_.repeated;
    return false;
  }
  if (test(profile.v0_v1(), profile.v0(), profile.v1(), placement, memory.uncovered)) return true;
  ++counts_.refused;
  put(edge_memory_, e, EdgeMemory{++clock_, refused_by_bound_ ? tracker_.last_uncovered() : memory.uncovered});
  return false;
}

template <class Mesh, class VertexPointMap>
template <class Profile>
std::optional<typename DeviationMonitor<Mesh, VertexPointMap>::Point>
DeviationMonitor<Mesh, VertexPointMap>::admitted_placement(const Profile& profile, const Point& wanted) {
  if (admits(profile, wanted)) return wanted;
  const Edge e = edge(profile.v0_v1(), mesh_);
  EdgeMemory memory = get(edge_memory_, e);
  const bool tested = memory.refused_at == clock_;
  const bool movable = !preserve_boundary || !(is_border(profile.v0()) || is_border(profile.v1()));
  for (int k = 0; tested && movable && k < fallback_placements; ++k) {
    const Point other = fallback(k, profile.p0(), profile.p1(), wanted);
    if (other == wanted) continue;
    if (test(profile.v0_v1(), profile.v0(), profile.v1(), other, memory.uncovered)) {
      --counts_.refused;
      put(edge_memory_, e, EdgeMemory{});
      return other;
    }
    if (refused_by_bound_) memory.uncovered = tracker_.last_uncovered();
  }
  put(edge_memory_, e, memory);
  refused_.emplace(profile.v0_v1(), wanted);
  return std::nullopt;
}

template <class Mesh, class VertexPointMap>
typename DeviationMonitor<Mesh, VertexPointMap>::Point DeviationMonitor<Mesh, VertexPointMap>::fallback(
    int k, const Point& p0, const Point& p1, const Point& wanted) const {
  if (k == 0) return CGAL::midpoint(p0, p1);
  if (k == 1) return p0;
  if (k == 2) return p1;
  // A vertex on a curved surface whose faces are chords wants to lie outside of it, up to the tolerance.
  constexpr std::array<double, 4> shares = {0.35, -0.35, 0.7, -0.7};
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (const auto& c : before_) normal += (c[1] - c[0]).cross(c[2] - c[0]);
  const double length = normal.norm();
  if (!(length > 0)) return wanted;
  const double share = shares[static_cast<std::size_t>(k - 3)] * tracker_.tolerance() / length;
  const Eigen::Vector3d p = to_eigen(wanted) + share * normal;
  return Point(p.x(), p.y(), p.z());
}

template <class Mesh, class VertexPointMap>
void DeviationMonitor<Mesh, VertexPointMap>::collapsed_into(Vertex v) {
  ++counts_.performed;
  const std::uint64_t now = ++clock_;
  put(vertex_memory_, v, VertexMemory{now, now});
  for (const Halfedge h : CGAL::halfedges_around_target(halfedge(v, mesh_), mesh_)) {
    VertexMemory memory = get(vertex_memory_, source(h, mesh_));
    memory.touched_at = now;
    put(vertex_memory_, source(h, mesh_), memory);
  }
}

}  // namespace meshbound::cgal
