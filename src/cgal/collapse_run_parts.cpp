// SPDX-License-Identifier: GPL-3.0-or-later
/// What goes from the runs of parts to the one of the joined mesh.
#include <numeric>
#include <utility>

#include "cgal/collapse_run.h"

namespace meshbound::cgal {
namespace {

/// Collapses beside a seam take away faces of two rings.
constexpr int rings_at_seam = 2;

}  // namespace

/// Returns the place of each vertex.
std::vector<std::uint32_t> CollapseRun::take_mesh(FinishedPart& result) const {
  std::vector<std::uint32_t> place(copy_.mesh.num_vertices());
  for (const auto v : copy_.mesh.vertices()) {
    place[v] = static_cast<std::uint32_t>(result.vertices.size());
    result.vertices.push_back(
        {copy_.mesh.point(v), seam_->vertex(v), copy_.vertex_of_vertex[v], is_locked(v), policies_->quadric(v), {}});
  }
  for (const auto f : copy_.mesh.faces()) {
    const auto h = copy_.mesh.halfedge(f);
    result.polygons.push_back(
        {place[copy_.mesh.source(h)], place[copy_.mesh.target(h)], place[copy_.mesh.target(copy_.mesh.next(h))]});
    result.triangle_of_face.push_back(part_->named_after[f]);
  }
  return place;
}

FinishedPart CollapseRun::estimated_part(const CollapseGoal& goal) {
  goal_ = goal;
  run_phase({}, kept_parts());
  FinishedPart result;
  (void)take_mesh(result);
  std::size_t place = 0;
  for (const auto v : copy_.mesh.vertices()) result.vertices[place++].heights = phase_->heights()[v];
  result.estimated.performed = phase_->collapses();
  result.ended_by = ended_by_.value_or(EndedBy::NothingFits);
  return result;
}

FinishedPart CollapseRun::finished() {
  monitor_->begin_pass();
  FinishedPart result;
  const std::vector<std::uint32_t> place = take_mesh(result);
  Monitor::Part& proof = result.proof;
  proof.proof = monitor_->tracker().proof();
  proof.triangle_of = part_->triangle_of;
  proof.face_of.assign(proof.proof.nearest.size(), FinishedPart::none);
  std::uint32_t at = 0;
  for (const auto f : copy_.mesh.faces()) proof.face_of[monitor_->face_id(f)] = at++;
  for (const std::uint32_t t : monitor_->uncovered()) proof.uncovered.push_back(part_->triangle_of[t]);
  result.settled = settled_edges(place);
  result.counts = monitor_->counts();
  result.stats = stats();
  result.estimated = estimated_;
  result.work = work_of_run_;
  result.ended_by = ended_by_.value_or(EndedBy::NothingFits);
  return result;
}

/// What was refused beside a seam was refused without the faces beyond it, and is not settled.
std::vector<std::array<std::uint32_t, 2>> CollapseRun::settled_edges(const std::vector<std::uint32_t>& place) const {
  const SurfaceMesh& mesh = copy_.mesh;
  std::vector<bool> beside(mesh.num_vertices(), false);
  for (const auto h : mesh.halfedges()) {
    if (seam_->has(mesh.source(h))) beside[mesh.source(h)] = beside[mesh.target(h)] = true;
  }
  std::vector<std::array<std::uint32_t, 2>> settled;
  for (const auto e : mesh.edges()) {
    const auto a = mesh.vertex(e, 0), b = mesh.vertex(e, 1);
    if (!beside[a] && !beside[b] && monitor_->is_settled(e)) settled.push_back({place[a], place[b]});
  }
  return settled;
}

CollapseRun::CollapseRun(JoinedParts joined, const TriangleMesh& original, Bvh tree, const SimplifyOptions& options,
                         double tolerance)
    : original_(original),
      options_(options),
      copy_(std::move(joined.copy)),
      locked_(std::move(joined.locked)),
      counts_of_parts_(joined.counts),
      stats_of_parts_(joined.stats),
      work_of_parts_(joined.work),
      estimated_(joined.estimated) {
  monitor_.emplace(copy_.mesh, original_, std::move(tree), joined.proofs, tolerance,
                   get(CGAL::vertex_point, copy_.mesh));
  set_up_monitor();
  policies_.emplace(options_.cost, kept_parts(), nullptr);
  policies_->start_from(std::move(joined.quadrics), copy_.mesh);
  for (const auto& [a, b] : joined.settled) {
    const auto h = copy_.mesh.halfedge(SurfaceMesh::Vertex_index(a), SurfaceMesh::Vertex_index(b));
    monitor_->settle(copy_.mesh.edge(h));
  }
  monitor_->begin_pass();
}

CollapseRun::CollapseRun(JoinedParts joined, const TriangleMesh& original, const SimplifyOptions& options)
    : heights_(std::move(joined.heights)),
      original_(original),
      options_(options),
      copy_(std::move(joined.copy)),
      locked_(std::move(joined.locked)),
      estimated_(joined.estimated) {
  policies_.emplace(options_.cost, kept_parts(), nullptr);
  policies_->start_from(std::move(joined.quadrics), copy_.mesh);
  beside_seam_ = joined.on_seam;
  for (int ring = 0; ring < rings_at_seam; ++ring) {
    const std::vector<bool> inner = beside_seam_;
    for (const auto h : copy_.mesh.halfedges()) {
      if (inner[copy_.mesh.source(h)]) beside_seam_[copy_.mesh.target(h)] = true;
    }
  }
}

bool CollapseRun::prove_estimated(const CollapseGoal& goal) {
  goal_ = goal;
  KeptParts kept = kept_parts();
  kept.only = &beside_seam_;
  run_phase({}, kept);
  return prove_phase();
}

ProvenMesh CollapseRun::proven_mesh() const {
  ProvenMesh result;
  const SurfaceMesh& mesh = copy_.mesh;
  std::vector<std::uint32_t> place(mesh.num_vertices());
  for (const auto v : mesh.vertices()) {
    place[v] = static_cast<std::uint32_t>(result.polygons.points.size());
    result.polygons.points.push_back(mesh.point(v));
    result.polygons.vertex_of_vertex.push_back(copy_.vertex_of_vertex[v]);
    result.locked.push_back(is_locked(v));
    result.quadrics.push_back(policies_->quadric(v));
  }
  for (const auto f : mesh.faces()) {
    const auto h = mesh.halfedge(f);
    result.polygons.polygons.push_back(
        {place[mesh.source(h)], place[mesh.target(h)], place[mesh.target(mesh.next(h))]});
    result.polygons.triangle_of_face.push_back(copy_.triangle_of_face[f]);
  }
  result.proof = monitor_->tracker().proof();
  return result;
}

CollapseRun::CollapseRun(ProvenPart part, const Seams& seams, const SimplifyOptions& options,
                         const std::vector<bool>& locked)
    : part_(std::move(part.part)),
      original_(part_->original),
      options_(options),
      copy_(to_manifold_copy(std::move(part_->copy))),
      locked_(locked) {
  seam_.emplace(seams, part_->seam_vertex);
  Monitor::Part proof;
  proof.triangle_of.resize(part_->triangle_of.size());
  std::iota(proof.triangle_of.begin(), proof.triangle_of.end(), 0u);
  proof.face_of.resize(copy_.mesh.number_of_faces());
  std::iota(proof.face_of.begin(), proof.face_of.end(), 0u);
  const double tolerance = part.proof.tolerance;
  proof.proof = std::move(part.proof);
  monitor_.emplace(copy_.mesh, original_, Bvh(original_, BvhOptions{options.threads}), std::span(&proof, 1), tolerance,
                   get(CGAL::vertex_point, copy_.mesh));
  set_up_monitor();
  policies_.emplace(options_.cost, kept_parts(), &*seam_);
  policies_->start_from(std::move(part.quadrics), copy_.mesh);
}

}  // namespace meshbound::cgal
