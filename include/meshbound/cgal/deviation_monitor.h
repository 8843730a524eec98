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
///       visitor.OnCollapsing, collapse,     visitor.OnCollapsed        commits the proof
///
/// Filter and visitor must be used together: either throws where the other is missing. Either may be wrapped (as
/// `Bounded_normal_change_filter` does with a filter; a visitor's wrapper passes every call on), and both are copyable
/// handles on the monitor, which must outlive them. `monitor.placement(base)` wraps a placement so that others are
/// tried where the one of `base` breaks the bound; it gives fewer faces. CGAL 5 and 6.
///
/// Kernels: those whose coordinates are doubles (`Simple_cartesian<double>`, inexact constructions). With exact
/// constructions the proof is of `CGAL::to_double` of each point: the distance of the meshes themselves differs by no
/// more than what that rounds at their vertices.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "meshbound/cgal/surface_mesh.h"
#include "meshbound/collapse_checker.h"

namespace meshbound::cgal {

/// A proof that follows one mesh through runs of `edge_collapse`. Not thread-safe. Memory: O(original).
template <class Mesh, class VertexPointMap = typename boost::property_map<Mesh, CGAL::vertex_point_t>::type>
class DeviationMonitor {
  using Graph = boost::graph_traits<Mesh>;
  using Vertex = typename Graph::vertex_descriptor;
  using Halfedge = typename Graph::halfedge_descriptor;
  using Point = typename boost::property_traits<VertexPointMap>::value_type;

 public:
  class Filter;
  class StopPredicate;
  class Visitor;
  template <class Base>
  class Placement;
  using Counts = CollapseChecker::Counts;  ///< what became of collapses

  /// The original is `mesh` as it is now. Throws `InvalidInput` where a face is not a triangle or an edge has length
  /// zero (CGAL collapses these without asking a filter; weld the vertices first), and as `CollapseChecker` does.
  DeviationMonitor(Mesh& mesh, double tolerance) : DeviationMonitor(mesh, tolerance, get(CGAL::vertex_point, mesh)) {}
  /// Follows a mesh whose points stand in a property map of the caller's.
  DeviationMonitor(Mesh& mesh, double tolerance, VertexPointMap points)
      : mesh_(mesh),
        points_(points),
        checker_(to_triangle_mesh(mesh, points), tolerance),
        numbers_(get(CGAL::dynamic_vertex_property_t<std::uint32_t>(), mesh)) {
    std::uint32_t number = 0;
    for (const Vertex v : vertices(mesh_)) put(numbers_, v, number++);
    refuse_edges_of_no_length();
  }
  DeviationMonitor(const DeviationMonitor&) = delete;
  DeviationMonitor& operator=(const DeviationMonitor&) = delete;

  [[nodiscard]] Filter filter() { return Filter(*this); }                        ///< for `parameters::filter`
  [[nodiscard]] StopPredicate stop_predicate() { return StopPredicate(*this); }  ///< second argument of `edge_collapse`
  [[nodiscard]] Visitor visitor() { return Visitor(*this); }                     ///< for `parameters::visitor`
  /// For `parameters::get_placement`: see `Placement`.
  template <class Base>
  [[nodiscard]] Placement<Base> placement(const Base& base) {
    return Placement<Base>(*this, base);
  }

  /// Vertices for which the property map gives true stay where they are: no collapse moves them or joins two of them.
  /// Read once, now. A collapse may go on with the other vertex descriptor of its edge; the lock goes with the point.
  /// `Placement` puts the vertex of a collapse where the locked end is; without it, other placements are refused.
  template <class LockMap>
  void lock_vertices(const LockMap& is_locked) {
    for (const Vertex v : vertices(mesh_))
      if (get(is_locked, v) && halfedge(v, mesh_) != Graph::null_halfedge()) checker_.lock(get(numbers_, v));
  }
  /// A tolerance for each face, by a property map, beside the one for all: see `CollapseChecker::limit_triangles`.
  /// Before the first collapse.
  template <class ToleranceMap>
  void limit_faces(const ToleranceMap& tolerances) {
    std::vector<double> by_triangle;
    for (const auto f : CGAL::faces(mesh_)) by_triangle.push_back(CGAL::to_double(get(tolerances, f)));
    checker_.limit_triangles(by_triangle);
  }

  /// Ends a run when it returns true; asked before each collapse, with the number of faces left. None: never.
  std::function<bool(std::size_t faces)> should_stop;

  /// For the next run, with a larger tolerance against the same original. Throws `InvalidInput` for a smaller one.
  void grow_tolerance(double tolerance) { checker_.grow_tolerance(tolerance); }
  [[nodiscard]] std::size_t faces() const { return checker_.faces(); }      ///< that are left
  [[nodiscard]] const Counts& counts() const { return checker_.counts(); }  ///< since the start

 private:
  [[nodiscard]] static Eigen::Vector3d to_eigen(const Point& p) {
    return {CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z())};
  }
  void refuse_edges_of_no_length() const {
    for (const auto e : edges(mesh_)) {
      const Halfedge h = halfedge(e, mesh_);
      if (get(points_, source(h, mesh_)) == get(points_, target(h, mesh_)))
        throw InvalidInput("an edge has length zero, which CGAL collapses without asking; weld equal vertices first");
    }
  }
  /// Throws unless the visitor has announced the edge, and has committed all collapses before: an `edge_collapse` that
  /// ended by an exception leaves its last edge announced to one that lacks the visitor, but one edge only.
  template <class Profile>
  void require_visitor(const Profile& profile) const {
    if (announced_ != profile.v0_v1())
      throw InvalidInput("edge_collapse was given the filter of the deviation monitor only: pass its visitor too");
    if (const auto left = faces_of_mesh(); left && *left != faces())
      throw InvalidInput("the mesh was changed without the deviation monitor: it has " + std::to_string(*left) +
                         " faces instead of " + std::to_string(faces()));
  }
  /// Without those that CGAL has removed but not yet freed; none for a mesh that cannot count them in O(1).
  [[nodiscard]] std::optional<std::size_t> faces_of_mesh() const {
    if constexpr (requires { mesh_.number_of_faces(); }) return mesh_.number_of_faces();
    if constexpr (requires { mesh_.size_of_facets(); }) return mesh_.size_of_facets();
    return std::nullopt;
  }
  template <class Profile>
  [[nodiscard]] bool admits(const Profile& profile, const Point& point) {
    admitted_.reset();
    if (!checker_.admits(get(numbers_, profile.v0()), get(numbers_, profile.v1()), to_eigen(point))) return false;
    admitted_.emplace(profile.v0_v1(), point);
    return true;
  }

  Mesh& mesh_;
  VertexPointMap points_;
  CollapseChecker checker_;
  typename boost::property_map<Mesh, CGAL::dynamic_vertex_property_t<std::uint32_t>>::type numbers_;  ///< there
  std::optional<Halfedge> selected_;                    ///< popped from the queue, its placement not yet asked for
  std::optional<Halfedge> announced_;                   ///< by the visitor: the edge for which the filter may be asked
  std::optional<std::pair<Halfedge, Point>> admitted_;  ///< by the filter
  bool collapsing_ = false;
  std::uint32_t kept_ = 0;  ///< the number of the vertex of this collapse
};

/// Takes a profile and an optional placement of CGAL (boost:: or std::optional), returns it, or none to refuse. Throws
/// `InvalidInput` where the visitor has not announced the edge: in an `edge_collapse` without the visitor, collapses
/// that were admitted are never committed, and the next proof would start from a mesh that is no longer there. Throws
/// it, too, where the mesh has another number of faces than the monitor knows of.
template <class Mesh, class VertexPointMap>
class DeviationMonitor<Mesh, VertexPointMap>::Filter {
 public:
  explicit Filter(DeviationMonitor& monitor) : monitor_(&monitor) {}  ///< a handle; `monitor` must outlive it

  /// The placement if the collapse keeps the bound there, else none.
  template <class Profile, class OptionalPoint>
  OptionalPoint operator()(const Profile& profile, const OptionalPoint& placement) const {
    monitor_->require_visitor(profile);
    if (!placement || !monitor_->admits(profile, *placement)) return OptionalPoint();
    return placement;
  }

 private:
  DeviationMonitor* monitor_;
};

/// Gives the placement of `base`, but when CGAL is about to collapse the edge: then the first of that one, a point
/// where the largest sampled distance is least, and the ends of the edge, that keeps the bound. (CGAL asks a placement
/// for the costs of all edges, too, where a proof would be wasted, and ignores the placement that a filter returns.)
template <class Mesh, class VertexPointMap>
template <class Base>
class DeviationMonitor<Mesh, VertexPointMap>::Placement {
 public:
  Placement(DeviationMonitor& monitor, const Base& base)
      : monitor_(&monitor), base_(base) {}  ///< a handle; `monitor` must outlive it

  /// The point for the vertex of a collapse.
  template <class Profile>
  auto operator()(const Profile& profile) const -> decltype(std::declval<const Base&>()(profile)) {
    auto placement = base_(profile);
    if (!placement || monitor_->selected_ != profile.v0_v1()) return placement;
    monitor_->selected_.reset();
    const auto& numbers = monitor_->numbers_;
    const auto admitted = monitor_->checker_.admitted_placement(get(numbers, profile.v0()), get(numbers, profile.v1()),
                                                                to_eigen(*placement));
    if (admitted) *placement = Point(admitted->x(), admitted->y(), admitted->z());
    return placement;
  }

 private:
  DeviationMonitor* monitor_;
  Base base_;
};

/// Ends a run where `should_stop` says so.
template <class Mesh, class VertexPointMap>
class DeviationMonitor<Mesh, VertexPointMap>::StopPredicate {
 public:
  explicit StopPredicate(DeviationMonitor& monitor) : monitor_(&monitor) {}  ///< a handle; `monitor` must outlive it

  /// Whether the run ends before the next collapse.
  template <class Cost, class Profile, class Size>
  bool operator()(const Cost&, const Profile&, Size, Size) const {
    return monitor_->should_stop && monitor_->should_stop(monitor_->faces());
  }

 private:
  DeviationMonitor* monitor_;
};

/// Commits the proofs of collapses that are made. The functions are those that CGAL asks of a visitor.
template <class Mesh, class VertexPointMap>
class DeviationMonitor<Mesh, VertexPointMap>::Visitor {
 public:
  explicit Visitor(DeviationMonitor& monitor) : monitor_(&monitor) {}  ///< a handle; `monitor` must outlive it

  /// Forgets the last edge of a run that ended by an exception.
  template <class AnyMesh>
  void OnStarted(AnyMesh&) const {
    monitor_->announced_.reset();
  }
  /// The filter may not be asked any more.
  template <class AnyMesh>
  void OnFinished(AnyMesh&) const {
    monitor_->announced_.reset();
  }
  /// Nothing is to be done here.
  template <class Profile>
  void OnStopConditionReached(const Profile&) const {}
  /// Nothing is to be done here.
  template <class Profile, class OptionalCost>
  void OnCollected(const Profile&, const OptionalCost&) const {}
  /// The edge for which `Placement` and the filter are asked next.
  template <class Profile, class OptionalCost, class Size>
  void OnSelected(const Profile& profile, const OptionalCost&, Size, Size) const {
    monitor_->selected_ = monitor_->announced_ = profile.v0_v1();
  }
  /// Nothing is to be done here.
  template <class Profile>
  void OnNonCollapsable(const Profile&) const {}

  /// Throws `Error` when the collapse is not the one that the filter admitted last.
  template <class Profile, class OptionalPoint>
  void OnCollapsing(const Profile& profile, const OptionalPoint& placement) const {
    auto& admitted = monitor_->admitted_;
    if (!admitted || !placement || admitted->first != profile.v0_v1() || admitted->second != *placement)
      throw Error("a collapse that the deviation monitor has not admitted: pass its filter to edge_collapse too");
    admitted.reset();
    monitor_->announced_.reset();
    monitor_->kept_ = monitor_->checker_.commit();
    monitor_->collapsing_ = true;
  }
  /// Throws `Error` for the collapses of zero-length edges that CGAL makes without asking.
  template <class Profile, class AnyVertex>
  void OnCollapsed(const Profile&, const AnyVertex& v) const {
    if (!monitor_->collapsing_)
      throw Error("a zero-length edge was collapsed without asking the deviation monitor; weld equal vertices first");
    monitor_->collapsing_ = false;
    put(monitor_->numbers_, v, monitor_->kept_);
  }

 private:
  DeviationMonitor* monitor_;
};

}  // namespace meshbound::cgal
