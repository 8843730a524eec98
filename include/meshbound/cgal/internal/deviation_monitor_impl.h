// SPDX-License-Identifier: GPL-3.0-or-later
/// Member functions of `DeviationMonitor`; included by its header.
#pragma once
#include <utility>

#include "meshbound/cgal/deviation_monitor.h"

namespace meshbound::cgal {

template <class Mesh, class VertexPointMap>
DeviationMonitor<Mesh, VertexPointMap>::DeviationMonitor(Mesh& mesh, const TriangleMesh& original, Bvh tree,
                                                         VertexPointMap points, double tolerance)
    : mesh_(mesh),
      points_(points),
      bvh_(std::move(tree)),
      tracker_(MeshView(original), bvh_, tolerance),
      face_ids_(get(CGAL::dynamic_face_property_t<std::uint32_t>(), mesh)),
      edge_memory_(get(CGAL::dynamic_edge_property_t<EdgeMemory>(), mesh)),
      vertex_memory_(get(CGAL::dynamic_vertex_property_t<VertexMemory>(), mesh)) {
  for (const Edge e : edges(mesh_)) put(edge_memory_, e, EdgeMemory{});
  for (const Vertex v : vertices(mesh_)) put(vertex_memory_, v, VertexMemory{});
  refuse_zero_length_edges();
}

template <class Mesh, class VertexPointMap>
DeviationMonitor<Mesh, VertexPointMap>::DeviationMonitor(Mesh& mesh, const TriangleMesh& original,
                                                         const std::vector<std::uint32_t>& triangle_of_face,
                                                         double tolerance, VertexPointMap points)
    : DeviationMonitor(mesh, original, Bvh(MeshView(original)), points, tolerance) {
  number_faces(triangle_of_face);
}

template <class Mesh, class VertexPointMap>
DeviationMonitor<Mesh, VertexPointMap>::DeviationMonitor(Mesh& mesh, const TriangleMesh& original, Bvh tree,
                                                         double tolerance, VertexPointMap points, int threads,
                                                         const StopToken& stop)
    : DeviationMonitor(mesh, original, std::move(tree), points, tolerance) {
  start_from_approximation(threads, stop);
}

template <class Mesh, class VertexPointMap>
void DeviationMonitor<Mesh, VertexPointMap>::start_from_approximation(int threads, const StopToken& stop) {
  std::vector<TrackedFace> faces;
  for (const Face f : CGAL::faces(mesh_)) {
    const auto id = static_cast<std::uint32_t>(faces_++);
    put(face_ids_, f, id);
    const std::array<Vertex, 3> v = corners(f);
    faces.push_back({id, {at(v[0]), at(v[1]), at(v[2])}});
  }
  unproven_ = tracker_.start_from(faces, threads, stop);
}

template <class Mesh, class VertexPointMap>
void DeviationMonitor<Mesh, VertexPointMap>::refuse_unproven() const {
  if (!unproven_.empty())
    throw Error("the mesh that the deviation monitor was given is not proven to be within the tolerance");
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
  moved_corner_.clear();
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
      if (v[i] == around) moved_corner_.push_back(i);
    }
  };
  for_each_face_around(v0, [&](Face f) { visit(f, v0, v1); });
  if (v1 != Graph::null_vertex()) for_each_face_around(v1, [&](Face f) { visit(f, v1, v0); });
}

template <class Mesh, class VertexPointMap>
void DeviationMonitor<Mesh, VertexPointMap>::append_ring(Vertex v0, Vertex v1, std::vector<std::uint32_t>& ring) {
  ++ring_round_;
  const auto is_new = [&](std::uint32_t id) {
    if (id >= in_ring_.size()) in_ring_.resize(std::size_t{id} + 1, 0);
    return std::exchange(in_ring_[id], ring_round_) != ring_round_;
  };
  for (const std::uint32_t id : removed_) is_new(id);
  const auto append = [&](Halfedge h) {
    const Face f = face(h, mesh_);
    if (f == Graph::null_face()) return;
    const std::uint32_t id = get(face_ids_, f);
    if (is_new(id)) ring.push_back(id);
  };
  for (const Face star : removed_faces_) {
    for (const Halfedge h : CGAL::halfedges_around_face(halfedge(star, mesh_), mesh_)) {
      const Vertex v = target(h, mesh_);
      if (v != v0 && v != v1) for_each_halfedge_near(h, append);
    }
  }
}

/// Calls `visit` for the halfedges with the target of `h`: for all where they are few, else for those next to `h`.
template <class Mesh, class VertexPointMap>
template <class Visit>
void DeviationMonitor<Mesh, VertexPointMap>::for_each_halfedge_near(Halfedge h, const Visit& visit) const {
  constexpr int many = 64, beside = 8;
  const Halfedge first = halfedge(target(h, mesh_), mesh_);
  int count = 0;
  for (Halfedge g = first; count < many;) {
    ++count;
    g = opposite(next(g, mesh_), mesh_);
    if (g == first) break;
  }
  if (count < many) {
    for (const Halfedge g : CGAL::halfedges_around_target(first, mesh_)) visit(g);
    return;
  }
  Halfedge forth = h, back = h;
  visit(h);
  for (int k = 0; k < beside; ++k) {
    visit(forth = opposite(next(forth, mesh_), mesh_));
    visit(back = prev(opposite(back, mesh_), mesh_));
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
/// when something changed among the neighbours of an end; and always after the tolerance has grown. Changes of
/// neighbours hardly ever help an edge that was hopeless: of 1,200 on the rocker-arm at 0.1%, 3 could be collapsed.
template <class Mesh, class VertexPointMap>
bool DeviationMonitor<Mesh, VertexPointMap>::nothing_changed_since(const EdgeMemory& memory, Vertex v0,
                                                                   Vertex v1) const {
  if (memory.refused_at <= tolerance_start_) return false;
  const VertexMemory a = get(vertex_memory_, v0), b = get(vertex_memory_, v1);
  if (memory.hopeless || memory.refused_at > pass_start_) return std::max(a.moved_at, b.moved_at) < memory.refused_at;
  return std::max(a.touched_at, b.touched_at) < memory.refused_at;
}

template <class Mesh, class VertexPointMap>
bool DeviationMonitor<Mesh, VertexPointMap>::test_gathered(Halfedge h, Vertex v0, Vertex v1, const Point& placement) {
  if (search_placements && !is_promising(to_eigen(placement))) return false;
  if (admits_gathered(v0, v1, to_eigen(placement), tested_.uncovered)) {
    admitted_.emplace(h, placement);
    return true;
  }
  if (refused_by_bound_) tested_.uncovered = tracker_.last_uncovered();
  return false;
}

template <class Mesh, class VertexPointMap>
bool DeviationMonitor<Mesh, VertexPointMap>::admits_gathered(Vertex v0, Vertex v1, const Eigen::Vector3d& placement,
                                                             std::uint32_t try_first) {
  refuse_unproven();
  if (!passes_guards()) return false;
  SurfaceChange change;
  change.removed = removed_;
  change.added = added_;
  change.moved_vertex = placement;
  change.try_first = try_first;
  change.ring = [this, v0, v1](std::vector<std::uint32_t>& ring) { append_ring(v0, v1, ring); };
  if (tracker_.admits(change)) return true;
  refused_by_bound_ = true;
  return false;
}

/// False for an edge that need not be tried again yet.
template <class Mesh, class VertexPointMap>
template <class Profile>
bool DeviationMonitor<Mesh, VertexPointMap>::begin_test(const Profile& profile) {
  admitted_.reset();
  refused_.reset();
  refused_by_bound_ = false;
  must_sample_ = true;
  hopeless_ = false;
  first_step_.reset();
  tested_ = get(edge_memory_, edge(profile.v0_v1(), mesh_));
  if (!nothing_changed_since(tested_, profile.v0(), profile.v1())) return true;
  ++counts_.repeated;
  return false;
}

template <class Mesh, class VertexPointMap>
void DeviationMonitor<Mesh, VertexPointMap>::end_test(Edge e, bool admitted) {
  last_was_refused_ = !admitted;
  if (admitted) {
    put(edge_memory_, e, EdgeMemory{});
    return;
  }
  ++counts_.refused;
  put(edge_memory_, e, EdgeMemory{++clock_, tested_.uncovered, hopeless_});
}

template <class Mesh, class VertexPointMap>
template <class Profile>
bool DeviationMonitor<Mesh, VertexPointMap>::admits(const Profile& profile, const Point& placement) {
  const std::pair<Halfedge, Point> asked(profile.v0_v1(), placement);
  if (admitted_ == asked) return true;
  if (refused_ == asked) {
    admitted_.reset();
    refused_.reset();
    return false;
  }
  if (!begin_test(profile)) return false;
  bool admitted = locks_allow(profile.v0(), profile.v1(), placement);
  if (admitted) {
    gather_star(profile.v0(), profile.v1(), placement);
    admitted = test_gathered(profile.v0_v1(), profile.v0(), profile.v1(), placement);
  }
  end_test(edge(profile.v0_v1(), mesh_), admitted);
  return admitted;
}

template <class Mesh, class VertexPointMap>
template <class Profile>
std::optional<typename DeviationMonitor<Mesh, VertexPointMap>::Point>
DeviationMonitor<Mesh, VertexPointMap>::admitted_placement(const Profile& profile, const Point& wanted) {
  std::optional<Point> placement;
  if (is_locked(profile.v0()) || is_locked(profile.v1())) {
    const Point& kept = get(points_, is_locked(profile.v0()) ? profile.v0() : profile.v1());
    if (admits(profile, kept)) placement = kept;
  } else if (begin_test(profile)) {
    gather_star(profile.v0(), profile.v1(), wanted);
    placement = first_admitted(profile, wanted);
    end_test(edge(profile.v0_v1(), mesh_), placement.has_value());
  }
  if (!placement) refused_.emplace(profile.v0_v1(), wanted);
  return placement;
}

/// What is likely comes first: where the last edge was refused, so is this one, and samples may tell that.
template <class Mesh, class VertexPointMap>
template <class Profile>
std::optional<typename DeviationMonitor<Mesh, VertexPointMap>::Point>
DeviationMonitor<Mesh, VertexPointMap>::first_admitted(const Profile& profile, const Point& wanted) {
  const bool movable = !preserve_boundary || !(is_border(profile.v0()) || is_border(profile.v1()));
  const int fallbacks = movable ? fallback_placements : 0;
  const auto admitted = [&](const std::optional<Point>& p) {
    if (!p) return false;
    place(to_eigen(*p));
    return test_gathered(profile.v0_v1(), profile.v0(), profile.v1(), *p);
  };
  if (last_was_refused_ && fallbacks > 0 && passes_guards()) take_first_step();
  if (hopeless_) return std::nullopt;
  const bool is_far = first_step_ && first_step_->here > internal::largest_provable_height;
  refused_by_bound_ = refused_by_bound_ || is_far;
  if (!is_far && admitted(wanted)) return wanted;
  for (int k = 0; k < fallbacks && !hopeless_; ++k) {
    const std::optional<Point> other = fallback(k, profile.p0(), profile.p1(), wanted);
    if (other && (*other != wanted || is_far) && admitted(other)) return other;
  }
  if (!movable || !search_placements) return std::nullopt;
  const std::optional<Point> other = searched_placement(profile.p0(), profile.p1());
  return admitted(other) ? other : std::nullopt;
}

template <class Mesh, class VertexPointMap>
auto DeviationMonitor<Mesh, VertexPointMap>::fallback(int k, const Point& p0, const Point& p1, const Point& wanted)
    -> std::optional<Point> {
  if (k == 0) return minimax_placement(p0, p1, wanted);
  if (k == 1) return CGAL::midpoint(p0, p1);
  return k == 2 ? p0 : p1;
}

template <class Mesh, class VertexPointMap>
void DeviationMonitor<Mesh, VertexPointMap>::collapsed_into(Vertex v) {
  ++counts_.performed;
  const std::uint64_t now = ++clock_;
  put(vertex_memory_, v, VertexMemory{now, now, collapsing_locked_});
  touch_around(v);
}

}  // namespace meshbound::cgal
