// SPDX-License-Identifier: GPL-3.0-or-later
#include "cgal/decimation.h"

#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include <algorithm>
#include <boost/property_map/function_property_map.hpp>
#include <cmath>

#include "meshbound/mesh_summary.h"

namespace meshbound::cgal {
namespace {

/// A pass over all edges that removes a smaller share of the faces than this is the last one: what it gains no longer
/// pays for looking at every edge again.
constexpr double least_gain_of_pass = 0.01;

/// Refinement ends where as much work as all passes before it gains less than this share of the faces.
constexpr double least_gain_of_refinement = 0.015;

/// With Effort::Fast, of those that `DeviationMonitor` knows: the middle and the ends of the edge.
constexpr int fast_fallback_placements = 3;

/// Clock and callbacks are looked at once in this many collapses.
constexpr std::uint64_t checks_between_looks = 64;

TriangleMesh mapped(const TriangleMesh& mesh, const WorkingFrame& frame) {
  TriangleMesh result;
  result.triangles = mesh.triangles;
  result.vertices.reserve(mesh.vertices.size());
  for (const Eigen::Vector3d& p : mesh.vertices) result.vertices.push_back(frame.to_frame(p));
  return result;
}

/// False at a border, and where a face has no area and so no normal.
bool is_feature(const SurfaceMesh& mesh, SurfaceMesh::Edge_index edge, double angle) {
  if (mesh.is_border(edge)) return false;
  const auto normal = [&](SurfaceMesh::Halfedge_index h) {
    const auto& p = mesh.point(mesh.source(h));
    return CGAL::cross_product(mesh.point(mesh.target(h)) - p, mesh.point(mesh.target(mesh.next(h))) - p);
  };
  const auto a = normal(mesh.halfedge(edge, 0)), b = normal(mesh.halfedge(edge, 1));
  if (a.squared_length() == 0 || b.squared_length() == 0) return false;
  return std::atan2(std::sqrt(CGAL::cross_product(a, b).squared_length()), a * b) > angle;
}

}  // namespace

class Decimation::Filter {
 public:
  explicit Filter(Decimation& owner) : owner_(&owner), filter_(owner.monitor_->filter()) {}

  template <class Profile, class OptionalPoint>
  OptionalPoint operator()(const Profile& profile, const OptionalPoint& placement) const {
    const OptionalPoint admitted = filter_(profile, placement);
    if (!admitted && owner_->options_.on_exceed == OnExceed::Stop && owner_->monitor_->last_refusal_by_bound() &&
        owner_->truly_exceeds())
      owner_->ended_by_ = EndedBy::Tolerance;
    return admitted;
  }

 private:
  Decimation* owner_;
  Monitor::Filter filter_;
};

Decimation::Decimation(const TriangleMesh& original, const SimplifyOptions& options)
    : input_vertices_(original.vertices.size()),
      order_(spatial_order(original, options.threads)),
      original_(order_.mesh),
      options_(options),
      frame_(used_bounding_box(original_)),
      framed_original_(mapped(original_, frame_)),
      copy_(manifold_copy(framed_original_)) {
  start_points_.reserve(copy_.mesh.number_of_vertices());
  for (const auto v : copy_.mesh.vertices()) {
    start_points_.push_back(copy_.mesh.point(v));
    by_start_point_.push_back(v);
  }
  std::sort(by_start_point_.begin(), by_start_point_.end(), [&](auto a, auto b) {
    return start_points_[a] < start_points_[b] || (start_points_[a] == start_points_[b] && a < b);
  });
  monitor_.emplace(copy_.mesh, framed_original_, copy_.triangle_of_face, 0.0, get(CGAL::vertex_point, copy_.mesh));
  monitor_->normal_guard = NormalGuard();
  monitor_->preserve_boundary = options.preserve_boundary;
  if (options.effort == Effort::Fast) monitor_->fallback_placements = fast_fallback_placements;
  monitor_->should_stop = [this](std::size_t faces) { return must_stop(faces); };
  lock_vertices();
  limit_faces();
  policies_.emplace(copy_.mesh, options.cost, kept_parts());
  refinement_.emplace(copy_.mesh, *monitor_, [this] { return must_stop(monitor_->faces()); });
}

void Decimation::lock_vertices() {
  if (options_.locked_vertices.empty() && !options_.feature_angle) return;
  if (!options_.locked_vertices.empty() && options_.locked_vertices.size() != input_vertices_)
    throw InvalidInput("the locked vertices must be given for every vertex of the original, or not at all");
  const auto locked = locked_copies();
  monitor_->lock_vertices(boost::make_function_property_map<SurfaceMesh::Vertex_index>(
      [&](SurfaceMesh::Vertex_index v) { return bool(locked[v]); }));
  has_locks_ = true;
}

/// By vertex of the copy: several vertices of the original, at the same place, may have become one, or one several.
std::vector<bool> Decimation::locked_copies() const {
  std::vector<bool> locked(start_points_.size(), false);
  for (std::size_t v = 0; v < order_.vertex.size() && !options_.locked_vertices.empty(); ++v) {
    if (!options_.locked_vertices[order_.vertex[v]]) continue;
    const Eigen::Vector3d& p = framed_original_.vertices[v];
    const Kernel::Point_3 point(p.x(), p.y(), p.z());
    const auto before = [&](SurfaceMesh::Vertex_index a, const Kernel::Point_3& q) { return start_points_[a] < q; };
    auto at = std::lower_bound(by_start_point_.begin(), by_start_point_.end(), point, before);
    for (; at != by_start_point_.end() && start_points_[*at] == point; ++at) locked[*at] = true;
  }
  if (!options_.feature_angle) return locked;
  for (const auto edge : copy_.mesh.edges()) {
    if (!is_feature(copy_.mesh, edge, *options_.feature_angle)) continue;
    locked[copy_.mesh.vertex(edge, 0)] = true;
    locked[copy_.mesh.vertex(edge, 1)] = true;
  }
  return locked;
}

void Decimation::limit_faces() {
  if (options_.face_tolerances.empty()) return;
  if (options_.face_tolerances.size() != order_.triangle.size())
    throw InvalidInput("tolerances of triangles must be given for every triangle of the original");
  std::vector<double> limits;
  for (const std::uint32_t t : order_.triangle) {
    const double tolerance = options_.face_tolerances[t];
    limits.push_back(tolerance > 0 ? std::max(0.0, frame_.length_to_frame(tolerance) - room()) : tolerance);
  }
  monitor_->limit_triangles(limits);
}

/// For the ways into and out of the frame, of the original and of the result, and for the output format.
double Decimation::room() const { return 4 * frame_.rounding() + frame_.length_to_frame(options_.output_rounding); }

KeptParts Decimation::kept_parts() const {
  KeptParts kept{&copy_.mesh, options_.preserve_boundary, {}};
  if (has_locks_) kept.is_locked = [this](SurfaceMesh::Vertex_index v) { return monitor_->is_locked(v); };
  return kept;
}

EndedBy Decimation::run(double tolerance, std::size_t target_faces, double seconds) {
  frame_tolerance_ = frame_.length_to_frame(tolerance);
  target_faces_ = target_faces;
  seconds_ = seconds;
  began_ = Clock::now();
  stop_checks_ = 0;  // the first look is at the first collapse: without any time there is none
  ended_by_.reset();
  below_rounding_ = !(frame_tolerance_ > 2 * room());
  if (below_rounding_) return EndedBy::Rounding;
  monitor_->grow_tolerance(frame_tolerance_ - room());
  prune();
  const std::uint64_t before = work();
  passes_until_nothing_fits();
  if (options_.effort == Effort::High && options_.on_exceed == OnExceed::Skip && !ended_by_) refine(work() - before);
  if (!ended_by_) prune();
  return ended_by_.value_or(EndedBy::NothingFits);
}

/// Before the passes, while the other components are still as the original has them, and once more after.
void Decimation::prune() {
  if (!options_.prune) return;
  const Monitor::Dropped dropped = monitor_->drop_components(target_faces_);
  pruned_.components += dropped.components;
  pruned_.faces += dropped.faces;
}

void Decimation::passes_until_nothing_fits() {
  for (;;) {
    const std::size_t before = monitor_->faces();
    pass();
    if (ended_by_ || options_.effort == Effort::Fast) return;
    const std::size_t removed = before - monitor_->faces();
    monitor_->begin_pass();
    if (static_cast<double>(removed) < least_gain_of_pass * static_cast<double>(before)) return;
  }
}

/// Rounds of edits, each followed by passes over the edges that they changed. Work is counted, not timed, so that the
/// result is the same on every machine.
void Decimation::refine(std::uint64_t work_of_passes) {
  monitor_->search_placements = true;
  monitor_->begin_pass();
  std::size_t faces = monitor_->faces();
  std::uint64_t looked_at = work(), before = 0;
  while (!ended_by_ && work() > before) {
    before = work();
    refinement_->round();
    if (ended_by_) break;
    passes_until_nothing_fits();
    if (work() - looked_at < work_of_passes) continue;
    looked_at = work();
    if (static_cast<double>(faces - monitor_->faces()) < least_gain_of_refinement * static_cast<double>(faces)) break;
    faces = monitor_->faces();
  }
  monitor_->search_placements = false;
}

void Decimation::pass() {
  SMS::edge_collapse(copy_.mesh, monitor_->stop_predicate(),
                     CGAL::parameters::get_cost(*policies_)
                         .get_placement(monitor_->placement(*policies_))
                         .filter(Filter(*this))
                         .visitor(monitor_->visitor())
                         .edge_is_constrained_map(kept_parts()));
}

bool Decimation::must_stop(std::size_t faces) {
  if (ended_by_) return true;
  if (faces <= target_faces_) {
    ended_by_ = EndedBy::Target;
    return true;
  }
  if (stop_checks_++ % checks_between_looks != 0) return false;
  if (options_.cancel != nullptr && options_.cancel->load())
    ended_by_ = EndedBy::Cancelled;
  else if (std::chrono::duration<double>(Clock::now() - began_).count() >= seconds_)
    ended_by_ = EndedBy::TimeLimit;
  show_progress(faces);
  return ended_by_.has_value();
}

void Decimation::show_progress(std::size_t faces) {
  if (!options_.progress) return;
  // Most runs end at a small share of the faces and spend their time on the way there.
  options_.progress(1 - static_cast<double>(faces) / static_cast<double>(original_.triangles.size()));
}

/// The collapse that the monitor has just refused, on a copy: does the whole mesh leave the tolerance by it? The local
/// proof may fail where the bound still holds, with the help of faces that are far along the surface.
bool Decimation::truly_exceeds() {
  const Bvh changed(after_refused_collapse());
  DistanceOptions options;
  options.threads = options_.threads;
  options.cancel = options_.cancel;
  return check_symmetric(monitor_->original_bvh(), changed, frame_tolerance_, options).verdict != Verdict::Within;
}

TriangleMesh Decimation::after_refused_collapse() const {
  TriangleMesh soup;
  const auto add = [&](const std::array<Eigen::Vector3d, 3>& corners) {
    const auto first = static_cast<std::uint32_t>(soup.vertices.size());
    soup.vertices.insert(soup.vertices.end(), corners.begin(), corners.end());
    soup.triangles.push_back({first, first + 1, first + 2});
  };
  monitor_->for_each_face_after_refused([&](const std::array<Eigen::Vector3d, 3>& corners) { add(corners); });
  for (const std::uint32_t t : monitor_->uncovered()) {
    const Triangle& corners = framed_original_.triangles[t];
    add({framed_original_.vertices[corners[0]], framed_original_.vertices[corners[1]],
         framed_original_.vertices[corners[2]]});
  }
  return soup;
}

/// A vertex that never moved, or went to where another one was, gets the coordinates of the input to the bit: the way
/// into the frame and back may round.
Eigen::Vector3d Decimation::in_model(const Kernel::Point_3& p) const {
  const auto before = [&](SurfaceMesh::Vertex_index v, const Kernel::Point_3& q) { return start_points_[v] < q; };
  const auto start = std::lower_bound(by_start_point_.begin(), by_start_point_.end(), p, before);
  if (start != by_start_point_.end() && start_points_[*start] == p)
    return original_.vertices[copy_.vertex_of_vertex[*start]];
  return frame_.to_model({p.x(), p.y(), p.z()});
}

TriangleMesh Decimation::current_mesh() const {
  const auto sorted_by = [](const auto& range, const auto& key) {
    std::vector<std::decay_t<decltype(*range.begin())>> items(range.begin(), range.end());
    std::sort(items.begin(), items.end(),
              [&](auto a, auto b) { return std::make_pair(key(a), a) < std::make_pair(key(b), b); });
    return items;
  };
  TriangleMesh result;
  std::vector<std::uint32_t> index(start_points_.size());
  for (const auto v :
       sorted_by(copy_.mesh.vertices(), [&](auto u) { return order_.vertex[copy_.vertex_of_vertex[u]]; })) {
    index[v] = static_cast<std::uint32_t>(result.vertices.size());
    result.vertices.push_back(in_model(copy_.mesh.point(v)));
  }
  for (const auto f :
       sorted_by(copy_.mesh.faces(), [&](auto g) { return order_.triangle[copy_.triangle_of_face[g]]; })) {
    const auto h = copy_.mesh.halfedge(f);
    result.triangles.push_back(
        {index[copy_.mesh.source(h)], index[copy_.mesh.target(h)], index[copy_.mesh.target(copy_.mesh.next(h))]});
  }
  for (const std::uint32_t t : sorted_by(monitor_->uncovered(), [&](auto u) { return order_.triangle[u]; })) {
    Triangle corners{};
    for (std::size_t i = 0; i < 3; ++i) {
      corners[i] = static_cast<std::uint32_t>(result.vertices.size());
      result.vertices.push_back(original_.vertices[original_.triangles[t][i]]);
    }
    result.triangles.push_back(corners);
  }
  return result;
}

void Decimation::describe(SimplifyResult& result) const {
  result.kept_triangles = monitor_->uncovered().size();
  result.dropped_triangles = copy_.dropped_triangles - result.kept_triangles;
  result.split = copy_.split;
  result.pruned_components = pruned_.components;
  result.pruned_faces = pruned_.faces;
  result.tolerance_below_rounding = below_rounding_;
  result.stats = monitor_->tracker().stats();
}

}  // namespace meshbound::cgal
