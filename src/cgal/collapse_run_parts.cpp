// SPDX-License-Identifier: GPL-3.0-or-later
/// What goes from the runs of parts to the one of the joined mesh.
#include "cgal/collapse_run.h"

namespace meshbound::cgal {

FinishedPart CollapseRun::finished() {
  monitor_->begin_pass();
  FinishedPart result;
  std::vector<std::uint32_t> place(copy_.mesh.num_vertices());
  for (const auto v : copy_.mesh.vertices()) {
    place[v] = static_cast<std::uint32_t>(result.vertices.size());
    result.vertices.push_back({copy_.mesh.point(v), seam_->vertex(v), copy_.vertex_of_vertex[v], monitor_->is_locked(v),
                               policies_->quadric(v)});
  }
  Monitor::Part& proof = result.proof;
  proof.proof = monitor_->tracker().proof();
  proof.triangle_of = part_->triangle_of;
  proof.face_of.assign(proof.proof.nearest.size(), FinishedPart::none);
  for (const auto f : copy_.mesh.faces()) {
    proof.face_of[monitor_->face_id(f)] = static_cast<std::uint32_t>(result.polygons.size());
    const auto h = copy_.mesh.halfedge(f);
    result.polygons.push_back(
        {place[copy_.mesh.source(h)], place[copy_.mesh.target(h)], place[copy_.mesh.target(copy_.mesh.next(h))]});
    result.triangle_of_face.push_back(part_->triangle_of[copy_.triangle_of_face[f]]);
  }
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

CollapseRun::CollapseRun(JoinedParts joined, const TriangleMesh& original, const SimplifyOptions& options,
                         double tolerance)
    : original_(original),
      options_(options),
      copy_(std::move(joined.copy)),
      locked_(std::move(joined.locked)),
      counts_of_parts_(joined.counts),
      stats_of_parts_(joined.stats),
      work_of_parts_(joined.work),
      estimated_(joined.estimated) {
  monitor_.emplace(copy_.mesh, original_, Bvh(original_, BvhOptions{options.threads}), joined.proofs, tolerance,
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

}  // namespace meshbound::cgal
