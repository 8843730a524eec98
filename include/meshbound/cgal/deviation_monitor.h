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
/// Filter and visitor must be used together: either throws where the other is missing. Either may be wrapped (as
/// `Bounded_normal_change_filter` does with a filter; a visitor's wrapper passes every call on), and both are copyable
/// handles on the monitor, which must outlive them. `monitor.placement(base)` wraps a placement so that others are
/// tried where the one of `base` breaks the bound; it gives fewer faces. CGAL 5 and 6.
#pragma once
#include <CGAL/boost/graph/helpers.h>
#include <CGAL/boost/graph/iterator.h>
#include <CGAL/boost/graph/properties.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
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

    Counts& operator+=(const Counts& other) {
      performed += other.performed;
      refused += other.refused;
      repeated += other.repeated;
      return *this;
    }
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

  /// `mesh` need have nothing in common with the original but its place: it is an approximation, made by anything, that
  /// is proven here from nothing. `unproven` says where that failed; unless it is empty, a call that would prove an
  /// edit throws `Error`. `tree` must be built from `original`. The same for any number of threads; 0: as many as
  /// OpenMP has. Throws `InvalidInput` as above, and `Stopped` when `stop` ended the proof. Expected O(n log n).
  DeviationMonitor(Mesh& mesh, const TriangleMesh& original, Bvh tree, double tolerance, VertexPointMap points,
                   int threads = 0, const StopToken& stop = {});
  /// Triangles of the original and faces, by their place in the range of faces.
  [[nodiscard]] const Unproven& unproven() const { return unproven_; }

  /// What another monitor proved of a part of the original, in the numbers of the whole.
  struct Part {
    static constexpr std::uint32_t none = SurfaceChange::no_triangle;

    TrackedProof proof;
    std::vector<std::uint32_t> triangle_of;  ///< by triangle of the part's original: the same in the whole
    std::vector<std::uint32_t> face_of;      ///< by `face_id` there: its place in the faces of the mesh here, or none
    std::vector<std::uint32_t> uncovered;    ///< as `uncovered` there, in numbers of the whole
  };
  /// The mesh was joined from parts, each proven alone, and `original` from theirs: all proofs are taken over. `tree`
  /// must be built from `original`. Throws as `DeviationTracker::take_over` does. O(n).
  DeviationMonitor(Mesh& mesh, const TriangleMesh& original, Bvh tree, std::span<const Part> parts, double tolerance,
                   VertexPointMap points);

  DeviationMonitor(const DeviationMonitor&) = delete;
  DeviationMonitor& operator=(const DeviationMonitor&) = delete;

  [[nodiscard]] Filter filter() { return Filter(*this); }
  [[nodiscard]] StopPredicate stop_predicate() { return StopPredicate(*this); }
  [[nodiscard]] Visitor visitor() { return Visitor(*this); }

  template <class Base>
  [[nodiscard]] Placement<Base> placement(const Base& base) {
    return Placement<Base>(*this, base);
  }

  static constexpr int most_fallback_placements = 4;

  /// Checked for every face that a collapse moves, before the bound. None by default: users stack filters of their own.
  std::optional<NormalGuard> normal_guard;

  /// `Placement` then never moves a vertex of the border by itself.
  bool preserve_boundary = false;

  /// `Placement` then tries this many placements beside the one it was given, 0 to 4, before an edge is refused: a
  /// point where the largest sampled deviation around the edge is least, the middle of the edge, and its ends.
  int fallback_placements = most_fallback_placements;

  /// `Placement` then tries last the point where the deviation sampled around the edge is least: fewer faces, slower.
  bool search_placements = false;

  /// Vertices for which the property map gives true stay where they are: no collapse moves them or joins two of them.
  /// Read once, now. A collapse may go on with the other vertex descriptor of its edge; the lock goes with the point.
  /// `Placement` puts the vertex of a collapse where the locked end is; without it, other placements are refused.
  template <class LockMap>
  void lock_vertices(const LockMap& is_locked) {
    for (const Vertex v : CGAL::vertices(mesh_)) {
      VertexMemory memory = get(vertex_memory_, v);
      memory.locked = bool(get(is_locked, v));
      put(vertex_memory_, v, memory);
    }
  }
  [[nodiscard]] bool is_locked(Vertex v) const { return get(vertex_memory_, v).locked; }

  /// A tolerance for each face of the mesh, which must be the original itself, by a property map: see
  /// `DeviationTracker::limit_triangles` for what it means. Before the first collapse.
  template <class ToleranceMap>
  void limit_faces(const ToleranceMap& tolerances) {
    std::vector<double> by_triangle;
    for (const Face f : CGAL::faces(mesh_)) by_triangle.push_back(CGAL::to_double(get(tolerances, f)));
    limit_triangles(by_triangle);
  }
  /// The same by triangle of the original.
  void limit_triangles(std::span<const double> tolerances) { tracker_.limit_triangles(tolerances); }

  /// Ends the next run when it returns true; asked before each collapse, with the number of faces left. None: never.
  std::function<bool(std::size_t faces)> should_stop;

  /// Triangles of the original that the mesh has no face for and near. The bound holds for the mesh together with them.
  [[nodiscard]] const std::vector<std::uint32_t>& uncovered() const { return uncovered_; }

  /// Call before another `edge_collapse` on the same mesh: edges refused before are tried again where the mesh around
  /// them has changed since.
  void begin_pass() { pass_start_ = ++clock_; }
  /// True when the edge was refused and nothing near has changed since: the next pass will not test it.
  [[nodiscard]] bool is_settled(Edge e) const {
    const Halfedge h = halfedge(e, mesh_);
    return nothing_changed_since(get(edge_memory_, e), source(h, mesh_), target(h, mesh_));
  }
  /// Makes the edge settled, for one that another monitor found so.
  void settle(Edge e) { put(edge_memory_, e, EdgeMemory{++clock_}); }
  /// Goes on with a larger tolerance; every edge is tried again. The same one changes nothing. Throws `InvalidInput`
  /// for a smaller one.
  void grow_tolerance(double tolerance) {
    if (tolerance == tracker_.tolerance()) return;
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

  /// Edits beside collapses, between two runs of `edge_collapse`. Each is made only when it passes the guard and keeps
  /// the bound, and `relocate_vertex` and `flip_edge` only when it also lowers the deviation sampled around it, which
  /// `move_vertex` and `turn_edge`, a flip as well, do not ask for; false: the mesh is as it was.
  /// Vertices of the border and locked ones stay, and so do edges at locked ones. Edits make room for further
  /// collapses: edges around them are tried again.
  bool relocate_vertex(Vertex v);
  bool move_vertex(Vertex v, const Point& to);
  bool flip_edge(Edge e);
  bool turn_edge(Edge e);

  struct Dropped {
    std::size_t components = 0, faces = 0;
  };
  /// Removes components, the smallest first, as long as `least_faces` are left: those whose part of the original is
  /// proven to lie within the tolerance of what remains. Ones with locked vertices, and with `preserve_boundary` ones
  /// with a border, stay; so does what is left where `should_stop` says so. Between two runs of `edge_collapse`.
  /// O(n log n + size of the original).
  Dropped drop_components(std::size_t least_faces = 0);

  [[nodiscard]] std::size_t faces() const { return faces_; }
  /// The number of the face in the tracker.
  [[nodiscard]] std::uint32_t face_id(Face f) const { return get(face_ids_, f); }
  [[nodiscard]] const Counts& counts() const { return counts_; }
  /// True when the last collapse that was refused broke the bound: not the normal guard, nor an unchanged repetition.
  [[nodiscard]] bool last_refusal_by_bound() const { return refused_by_bound_; }
  [[nodiscard]] const Bvh& original_bvh() const { return bvh_; }
  /// For another monitor of the same original; this one can only be destroyed afterwards.
  [[nodiscard]] Bvh take_original_bvh() { return std::move(bvh_); }
  [[nodiscard]] const DeviationTracker& tracker() const { return tracker_; }
  /// Calls `visit(corners)` for each face that the mesh would have after the collapse that was tested last.
  template <class Visit>
  void for_each_face_after_refused(const Visit& visit) const;

 private:
  struct EdgeMemory {
    std::uint64_t refused_at = 0;  ///< clock; 0: never
    std::uint32_t uncovered = SurfaceChange::no_triangle;
    bool hopeless = false;  ///< no placement came near keeping the bound
  };
  struct VertexMemory {
    std::uint64_t moved_at = 0;    ///< clock of the last change of this vertex: a collapse into it, a move, a flip
    std::uint64_t touched_at = 0;  ///< clock of the last change of this vertex or a neighbour
    bool locked = false;
  };

  [[nodiscard]] static Eigen::Vector3d to_eigen(const Point& p) {
    return {CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z())};
  }
  [[nodiscard]] static Point to_point(const Eigen::Vector3d& p) { return Point(p.x(), p.y(), p.z()); }
  [[nodiscard]] Eigen::Vector3d at(Vertex v) const { return to_eigen(get(points_, v)); }
  DeviationMonitor(Mesh& mesh, const TriangleMesh& original, Bvh tree, VertexPointMap points, double tolerance);
  void start_from_approximation(int threads, const StopToken& stop);
  void refuse_unproven() const;
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
  template <class Profile>
  [[nodiscard]] bool begin_test(const Profile& profile);
  void end_test(Edge e, bool admitted);
  template <class Profile>
  [[nodiscard]] std::optional<Point> first_admitted(const Profile& profile, const Point& wanted);
  [[nodiscard]] bool test_gathered(Halfedge h, Vertex v0, Vertex v1, const Point& placement);
  /// The faces around v0 and v1, v1 may be none, with `placement` for both.
  void gather_star(Vertex v0, Vertex v1, const Point& placement);
  /// The gathered star with another placement.
  void place(const Eigen::Vector3d& p);
  [[nodiscard]] bool admits_gathered(Vertex v0, Vertex v1, const Eigen::Vector3d& placement, std::uint32_t try_first);
  /// Goes from p, in steps of at most `reach`, to where the sampled deviation of the gathered star is lower.
  struct Sampled {
    Eigen::Vector3d point;
    SampledDeviation lowest;
    double at_start = 0;
  };
  [[nodiscard]] Sampled lower_deviation(const Eigen::Vector3d& p, double reach);
  [[nodiscard]] double mean_edge() const;
  [[nodiscard]] bool gather_flip(Edge e);
  [[nodiscard]] bool flip_lowers_deviation();
  [[nodiscard]] bool make_flip(Edge e);
  void commit_move(Vertex v, const Point& to);
  [[nodiscard]] std::vector<std::vector<Face>> components() const;
  void remove_component(const std::vector<Face>& component);
  void touch_around(Vertex v);
  void changed(Vertex v);
  /// The k-th of the fallback placements beside `wanted`, for the edge whose star was gathered last.
  [[nodiscard]] std::optional<Point> fallback(int k, const Point& p0, const Point& p1, const Point& wanted);
  [[nodiscard]] std::optional<Point> minimax_placement(const Point& p0, const Point& p1, const Point& wanted);
  void take_first_step();
  /// Moves the vertex of the gathered star from p, less far where the guards say so; where it is then, if anywhere
  /// else.
  [[nodiscard]] std::optional<Eigen::Vector3d> moved_within_guards(const Eigen::Vector3d& p, Eigen::Vector3d move);
  [[nodiscard]] bool is_promising(const Eigen::Vector3d& placement);
  [[nodiscard]] std::optional<Point> searched_placement(const Point& p0, const Point& p1);
  void append_ring(Vertex v0, Vertex v1, std::vector<std::uint32_t>& ring);
  template <class Visit>
  void for_each_halfedge_near(Halfedge h, const Visit& visit) const;
  [[nodiscard]] bool nothing_changed_since(const EdgeMemory& memory, Vertex v0, Vertex v1) const;
  void collapsed_into(Vertex v);
  [[nodiscard]] bool locks_allow(Vertex v0, Vertex v1, const Point& placement) const {
    const bool first = is_locked(v0), second = is_locked(v1);
    if (first && second) return false;
    return (!first || placement == get(points_, v0)) && (!second || placement == get(points_, v1));
  }

  Mesh& mesh_;
  VertexPointMap points_;
  Bvh bvh_;
  DeviationTracker tracker_;
  typename boost::property_map<Mesh, CGAL::dynamic_face_property_t<std::uint32_t>>::type face_ids_;
  typename boost::property_map<Mesh, CGAL::dynamic_edge_property_t<EdgeMemory>>::type edge_memory_;
  typename boost::property_map<Mesh, CGAL::dynamic_vertex_property_t<VertexMemory>>::type vertex_memory_;
  std::vector<std::uint32_t> uncovered_;
  Unproven unproven_;
  std::size_t faces_ = 0;
  std::uint64_t clock_ = 1, pass_start_ = 1, tolerance_start_ = 1;
  Counts counts_;

  std::vector<std::uint32_t> removed_;
  std::vector<Face> removed_faces_;
  std::vector<std::uint32_t> in_ring_;  ///< round of `append_ring`, by face id
  std::uint32_t ring_round_ = 0;
  std::vector<TrackedFace> added_;
  std::vector<std::size_t> moved_corner_;               ///< of each of `added_`
  std::vector<std::array<Eigen::Vector3d, 3>> before_;  ///< of each of `added_`
  std::optional<Halfedge> selected_;                    ///< popped from the queue, its placement not yet asked for
  std::optional<std::pair<Halfedge, Point>> refused_;   ///< by the placement, for the filter that follows
  EdgeMemory tested_;                                   ///< of the edge tested last
  bool refused_by_bound_ = false;
  bool hopeless_ = false;                 ///< no placement of that edge comes near keeping the bound
  std::optional<HeightStep> first_step_;  ///< of that edge, from where it was wanted
  bool last_was_refused_ = false;
  bool must_sample_ = false;                                        ///< another edge than the last time
  std::optional<std::pair<Eigen::Vector3d, double>> best_sampled_;  ///< placement of this edge, and its sum
  std::optional<std::pair<Halfedge, Point>> admitted_;
  bool visited_ = false;  ///< an `edge_collapse` runs that has the visitor
  bool collapsing_ = false;
  bool collapsing_locked_ = false;  ///< one of the ends is locked
};

}  // namespace meshbound::cgal

#include "meshbound/cgal/internal/deviation_monitor_components.h"
#include "meshbound/cgal/internal/deviation_monitor_edits.h"
#include "meshbound/cgal/internal/deviation_monitor_handles.h"
#include "meshbound/cgal/internal/deviation_monitor_impl.h"
#include "meshbound/cgal/internal/deviation_monitor_parts.h"
