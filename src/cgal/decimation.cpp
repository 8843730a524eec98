// SPDX-License-Identifier: GPL-3.0-or-later
#include "cgal/decimation.h"

#include <algorithm>
#include <cmath>
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

Decimation::Decimation(const TriangleMesh& original, const SimplifyOptions& options)
    : input_vertices_(original.vertices.size()),
      order_(spatial_order(original, options.threads)),
      original_(order_.mesh),
      options_(options),
      frame_(used_bounding_box(original_)),
      framed_original_(mapped(original_, frame_)) {
  ManifoldCopy copy = manifold_copy(framed_original_);
  start_points_.reserve(copy.mesh.number_of_vertices());
  for (const auto v : copy.mesh.vertices()) {
    start_points_.push_back(copy.mesh.point(v));
    by_start_point_.push_back(v);
  }
  std::sort(by_start_point_.begin(), by_start_point_.end(), [&](auto a, auto b) {
    return start_points_[a] < start_points_[b] || (start_points_[a] == start_points_[b] && a < b);
  });
  const std::vector<bool> locked = locked_copies(copy.mesh);
  run_.emplace(std::move(copy), framed_original_, options_, locked);
  limit_faces();
}

/// By vertex of the copy: several vertices of the original, at the same place, may have become one, or one several.
std::vector<bool> Decimation::locked_copies(const SurfaceMesh& mesh) const {
  if (options_.locked_vertices.empty() && !options_.feature_angle) return {};
  if (!options_.locked_vertices.empty() && options_.locked_vertices.size() != input_vertices_)
    throw InvalidInput("the locked vertices must be given for every vertex of the original, or not at all");
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
  for (const auto edge : mesh.edges()) {
    if (!is_feature(mesh, edge, *options_.feature_angle)) continue;
    locked[mesh.vertex(edge, 0)] = true;
    locked[mesh.vertex(edge, 1)] = true;
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
  run_->limit_triangles(limits);
}

/// For the ways into and out of the frame, of the original and of the result, and for the output format.
double Decimation::room() const { return 4 * frame_.rounding() + frame_.length_to_frame(options_.output_rounding); }

EndedBy Decimation::run(double tolerance, std::size_t target_faces, double seconds) {
  CollapseGoal goal;
  goal.tolerance = frame_.length_to_frame(tolerance);
  goal.room = room();
  goal.target_faces = target_faces;
  goal.began = CollapseGoal::Clock::now();
  goal.seconds = seconds;
  below_rounding_ = !(goal.tolerance > 2 * goal.room);
  return below_rounding_ ? EndedBy::Rounding : run_->run(goal);
}

/// A vertex that never moved, or went to where another one was, gets the coordinates of the input to the bit: the way
/// into the frame and back may round.
Eigen::Vector3d Decimation::in_model(const Kernel::Point_3& p) const {
  const auto before = [&](SurfaceMesh::Vertex_index v, const Kernel::Point_3& q) { return start_points_[v] < q; };
  const auto start = std::lower_bound(by_start_point_.begin(), by_start_point_.end(), p, before);
  if (start != by_start_point_.end() && start_points_[*start] == p)
    return original_.vertices[run_->copy().vertex_of_vertex[*start]];
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
  for (const auto v : sorted_by(run_->copy().mesh.vertices(),
                                [&](auto u) { return order_.vertex[run_->copy().vertex_of_vertex[u]]; })) {
    index[v] = static_cast<std::uint32_t>(result.vertices.size());
    result.vertices.push_back(in_model(run_->copy().mesh.point(v)));
  }
  for (const auto f : sorted_by(run_->copy().mesh.faces(),
                                [&](auto g) { return order_.triangle[run_->copy().triangle_of_face[g]]; })) {
    const auto h = run_->copy().mesh.halfedge(f);
    result.triangles.push_back({index[run_->copy().mesh.source(h)], index[run_->copy().mesh.target(h)],
                                index[run_->copy().mesh.target(run_->copy().mesh.next(h))]});
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
  result.kept_triangles = run_->uncovered().size();
  result.dropped_triangles = run_->copy().dropped_triangles - result.kept_triangles;
  result.split = run_->copy().split;
  result.pruned_components = run_->pruned().components;
  result.pruned_faces = run_->pruned().faces;
  result.tolerance_below_rounding = below_rounding_;
  result.stats = run_->stats();
  result.estimated = run_->estimated();
}

}  // namespace meshbound::cgal
