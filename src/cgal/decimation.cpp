// SPDX-License-Identifier: GPL-3.0-or-later
#include "cgal/decimation.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "meshbound/mesh_summary.h"

namespace meshbound::cgal {
namespace {

TriangleMesh mapped(const TriangleMesh& mesh, const WorkingFrame& frame) {
  TriangleMesh result;
  result.triangles = mesh.triangles;
  result.vertices.reserve(mesh.vertices.size());
  for (const Eigen::Vector3d& p : mesh.vertices) result.vertices.push_back(frame.to_frame(p));
  return result;
}

/// The others go by the mesh as a whole: its first refusal, its number of faces, its components, and which triangle is
/// the nearest to a face, which may be one of another part.
bool fits_parts(const SimplifyOptions& options, std::size_t triangles) {
  return options.parts && number_of_parts(triangles) > 1 && options.on_exceed == OnExceed::Skip &&
         !options.target_faces && !options.target_ratio && !options.prune && options.face_tolerances.empty();
}

/// What was collapsed by an estimate before the time ended may still be proven in this share of that time.
constexpr double proof_share_of_time = 0.25;

StopToken later_by_share(const StopToken& stop, double share) {
  if (stop.deadline == StopToken::Clock::time_point::max()) return stop;
  const std::chrono::duration<double> left = stop.deadline - StopToken::Clock::now();
  return stop.until(stop.deadline, share * left.count());
}

/// Of parts where anything else than that nothing fits has ended one.
EndedBy end_of(const std::vector<FinishedPart>& parts) {
  EndedBy ended_by = EndedBy::NothingFits;
  for (const FinishedPart& part : parts) {
    if (part.ended_by != EndedBy::NothingFits) ended_by = part.ended_by;
  }
  return ended_by;
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

Decimation::Decimation(const TriangleMesh& original, const SimplifyOptions& options, const StopToken& stop)
    : input_vertices_(original.vertices.size()),
      order_(spatial_order(original, options.threads)),
      original_(order_.mesh),
      options_(options),
      frame_(used_bounding_box(original_)),
      framed_original_(mapped(original_, frame_)) {
  stop.check();
  sort_start_points();
  stop.check();
  polygons_ = manifold_polygons(framed_original_);
  dropped_triangles_ = polygons_->dropped_triangles;
  split_ = polygons_->split;
  stop.check();
  locked_ = locked_copies();
  limits_ = limits_in_frame();
  if (!fits_parts(options, polygons_->polygons.size())) start_whole();
}

void Decimation::sort_start_points() {
  by_start_point_.resize(framed_original_.vertices.size());
  std::iota(by_start_point_.begin(), by_start_point_.end(), 0u);
  const auto& at = framed_original_.vertices;
  std::sort(by_start_point_.begin(), by_start_point_.end(),
            [&](auto a, auto b) { return is_before(at[a], at[b]) || (at[a] == at[b] && a < b); });
}

/// The first vertex of the original, by index, at this place.
std::optional<std::uint32_t> Decimation::first_at(const Eigen::Vector3d& p) const {
  const auto before = [&](std::uint32_t v, const Eigen::Vector3d& q) {
    return is_before(framed_original_.vertices[v], q);
  };
  const auto at = std::lower_bound(by_start_point_.begin(), by_start_point_.end(), p, before);
  if (at == by_start_point_.end() || framed_original_.vertices[*at] != p) return std::nullopt;
  return *at;
}

void Decimation::start_whole() {
  run_.emplace(to_manifold_copy(std::move(*polygons_)), framed_original_, options_, locked_);
  if (!limits_.empty()) run_->limit_triangles(limits_);
  polygons_.reset();
}

EndedBy Decimation::run_parts(const CollapseGoal& goal) {
  const Cutting cutting(framed_original_, *polygons_, number_of_parts(polygons_->polygons.size()));
  std::uint64_t restarts = 0;
  if (polygons_->dropped_triangles == 0) {
    if (const std::optional<EndedBy> ended_by = run_estimated_parts(goal, cutting)) return *ended_by;
    ++restarts;
  }
  std::vector<FinishedPart> parts = cgal::run_parts(cutting, locked_, options_, goal);
  const EndedBy ended_by = end_of(parts);
  JoinedParts joined = join(std::move(parts), cutting, locked_);
  joined.estimated.restarts += restarts;
  run_.emplace(std::move(joined), framed_original_, Bvh(framed_original_, BvhOptions{options_.threads}), options_,
               goal.tolerance - goal.room);
  polygons_.reset();
  return ended_by;
}

std::optional<EndedBy> Decimation::run_estimated_parts(const CollapseGoal& goal, const Cutting& cutting) {
  std::vector<FinishedPart> estimated = estimate_parts(cutting, locked_, options_, goal);
  EndedBy ended_by = end_of(estimated);
  run_.emplace(join(std::move(estimated), cutting, locked_), framed_original_, options_);
  if (!run_->prove_estimated(goal)) {
    run_.reset();
    return std::nullopt;
  }
  ended_by = run_->ended_by().value_or(ended_by);
  if (ended_by != EndedBy::NothingFits) {
    polygons_.reset();
    return ended_by;
  }
  const ProvenCutting again(run_->proven_mesh(), framed_original_, cutting.parts());
  const CollapseRun::Monitor::Counts counts = run_->counts();
  const TrackerStats stats = run_->stats();
  const EstimatedCollapses estimate = run_->estimated();
  const std::uint64_t work = run_->work_of_estimate();
  Bvh tree = run_->take_tree();
  run_.reset();
  std::vector<FinishedPart> parts = cgal::run_parts(again, options_, goal);
  ended_by = end_of(parts);
  JoinedParts joined = join(std::move(parts), again);
  joined.counts += counts;
  joined.counts.performed -= estimate.performed;
  joined.stats += stats;
  joined.estimated = estimate;
  joined.work += work;
  run_.emplace(std::move(joined), framed_original_, std::move(tree), options_, goal.tolerance - goal.room);
  polygons_.reset();
  return ended_by;
}

/// By vertex of the polygons: several vertices of the original, at the same place, may have become one, or one several.
std::vector<bool> Decimation::locked_copies() const {
  if (options_.locked_vertices.empty() && !options_.feature_angle) return {};
  if (!options_.locked_vertices.empty() && options_.locked_vertices.size() != input_vertices_)
    throw InvalidInput("the locked vertices must be given for every vertex of the original, or not at all");
  std::vector<bool> locked_at(framed_original_.vertices.size(), false);  // by first vertex at the place
  for (std::size_t v = 0; v < order_.vertex.size() && !options_.locked_vertices.empty(); ++v) {
    if (options_.locked_vertices[order_.vertex[v]]) locked_at[*first_at(framed_original_.vertices[v])] = true;
  }
  std::vector<bool> locked;
  for (const std::uint32_t v : polygons_->vertex_of_vertex)
    locked.push_back(locked_at[*first_at(framed_original_.vertices[v])]);
  if (!options_.feature_angle) return locked;
  const SurfaceMesh mesh = to_surface_mesh(polygons_->points, polygons_->polygons);
  for (const auto edge : mesh.edges()) {
    if (!is_feature(mesh, edge, *options_.feature_angle)) continue;
    locked[mesh.vertex(edge, 0)] = true;
    locked[mesh.vertex(edge, 1)] = true;
  }
  return locked;
}

std::vector<double> Decimation::limits_in_frame() const {
  if (options_.face_tolerances.empty()) return {};
  if (options_.face_tolerances.size() != order_.triangle.size())
    throw InvalidInput("tolerances of triangles must be given for every triangle of the original");
  std::vector<double> limits;
  for (const std::uint32_t t : order_.triangle) {
    const double tolerance = options_.face_tolerances[t];
    limits.push_back(tolerance > 0 ? std::max(0.0, frame_.length_to_frame(tolerance) - room()) : tolerance);
  }
  return limits;
}

/// For the ways into and out of the frame, of the original and of the result, and for the output format.
double Decimation::room() const { return 4 * frame_.rounding() + frame_.length_to_frame(options_.output_rounding); }

EndedBy Decimation::run(double tolerance, std::size_t target_faces, const StopToken& stop) {
  CollapseGoal goal;
  goal.tolerance = frame_.length_to_frame(tolerance);
  goal.room = room();
  goal.target_faces = target_faces;
  goal.stop = stop;
  goal.stop_proof = later_by_share(stop, proof_share_of_time);
  below_rounding_ = !(goal.tolerance > 2 * goal.room);
  if (below_rounding_) {
    if (!run_) start_whole();
    return EndedBy::Rounding;
  }
  if (!run_ || run_->is_unproven()) stop.check();
  if (!run_) {
    const EndedBy ended_by = run_parts(goal);
    if (ended_by != EndedBy::NothingFits) return ended_by;
  }
  return run_->run(goal);
}

/// A vertex that never moved, or went to where another one was, gets the coordinates of the input to the bit: the way
/// into the frame and back may round.
Eigen::Vector3d Decimation::in_model(const Kernel::Point_3& p) const {
  const std::optional<std::uint32_t> start = first_at({p.x(), p.y(), p.z()});
  return start ? original_.vertices[*start] : frame_.to_model({p.x(), p.y(), p.z()});
}

TriangleMesh Decimation::current_mesh() const {
  const auto sorted_by = [](const auto& range, const auto& key) {
    std::vector<std::decay_t<decltype(*range.begin())>> items(range.begin(), range.end());
    std::sort(items.begin(), items.end(),
              [&](auto a, auto b) { return std::make_pair(key(a), a) < std::make_pair(key(b), b); });
    return items;
  };
  const ManifoldCopy& copy = run_->copy();
  const SurfaceMesh& mesh = copy.mesh;
  TriangleMesh result;
  std::vector<std::uint32_t> index(mesh.num_vertices());
  for (const auto v : sorted_by(mesh.vertices(), [&](auto u) { return order_.vertex[copy.vertex_of_vertex[u]]; })) {
    index[v] = static_cast<std::uint32_t>(result.vertices.size());
    result.vertices.push_back(in_model(mesh.point(v)));
  }
  for (const auto f : sorted_by(mesh.faces(), [&](auto g) { return order_.triangle[copy.triangle_of_face[g]]; })) {
    const auto h = mesh.halfedge(f);
    result.triangles.push_back({index[mesh.source(h)], index[mesh.target(h)], index[mesh.target(mesh.next(h))]});
  }
  for (const std::uint32_t t : sorted_by(run_->uncovered(), [&](auto u) { return order_.triangle[u]; })) {
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
  if (!run_) return;
  result.kept_triangles = run_->uncovered().size();
  result.dropped_triangles = dropped_triangles_ - result.kept_triangles;
  result.split = split_;
  result.pruned_components = run_->pruned().components;
  result.pruned_faces = run_->pruned().faces;
  result.tolerance_below_rounding = below_rounding_;
  result.stats = run_->stats();
  result.estimated = run_->estimated();
}

}  // namespace meshbound::cgal
