// SPDX-License-Identifier: MIT
#include "distance/levels/level_surface.h"

#include <algorithm>
#include <optional>

#include "distance/shortcuts/triangle_table.h"

namespace meshbound {

LevelSurface::LevelSurface(const Bvh::Data& tree, const MeshView& level)
    : vertices(tree.vertices.size()), corners(tree.corners.begin(), tree.corners.end()) {
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    const Eigen::Vector3d p = level.vertex(tree.source_vertex[v]);
    vertices[v] = {p.x(), p.y(), p.z()};
  }
}

Successors::Successors(const LevelSurface& from, const LevelSurface& to)
    : slot(from.corners.size(), no_slot), vertex(from.vertices.size(), no_slot) {
  const PositionTable positions(to.vertices);
  std::optional<TriangleTable> triangles;  // built when the first triangle has all its corners in the next level
  for (std::size_t v = 0; v < vertex.size(); ++v) {
    const std::uint32_t found = positions.find(from.vertices[v]);
    if (found != no_index) vertex[v] = found;
  }
  std::vector<std::uint32_t> slot_at(to.vertices.size(), no_slot);
  for (std::uint32_t s = 0; s < to.corners.size(); ++s)
    for (const std::uint32_t v : to.corners[s]) slot_at[v] = s;
  near_slot.assign(slot.size(), no_slot);
  for (std::size_t s = 0; s < slot.size(); ++s) {
    const Triangle& t = from.corners[s];
    const Triangle there{vertex[t[0]], vertex[t[1]], vertex[t[2]]};
    for (const std::uint32_t v : there)
      if (v != no_slot) near_slot[s] = slot_at[v];
    if (there[0] == no_slot || there[1] == no_slot || there[2] == no_slot) continue;
    if (!triangles) triangles.emplace(to.corners, to.vertices, positions);
    const std::uint32_t found = triangles->find(there);
    if (found != no_index) slot[s] = near_slot[s] = found;
  }
}

SearchMemory inherited_by_original(const SearchMemory& memory, const Successors& next) {
  SearchMemory result;
  result.proofs.resize(memory.proofs.size());
  std::vector<std::uint32_t> used;
  for (std::uint32_t s = 0; s < memory.proofs.size(); ++s) {
    const TriangleProof& proof = memory.proofs[s];
    const std::uint32_t* const faces = proof.count == 1 ? &proof.at : memory.faces.data() + proof.at;
    used.clear();
    for (std::uint32_t i = 0; i < proof.count && next.slot[faces[i]] != no_slot; ++i)
      used.push_back(next.slot[faces[i]]);
    if (proof.count > 0 && used.size() == proof.count) result.improve(s, proof.bound, used);
  }
  result.hints.resize(memory.hints.size(), no_slot);
  for (std::size_t v = 0; v < result.hints.size(); ++v)
    if (memory.hints[v] != no_slot) result.hints[v] = next.near_slot[memory.hints[v]];
  result.start = memory.start;
  return result;
}

SearchMemory inherited_by_level(const SearchMemory& memory, const Successors& next, const Bvh::Data& to) {
  SearchMemory result;
  result.reset(to);
  for (std::uint32_t s = 0; s < next.slot.size(); ++s) {
    // The original does not change from level to level, so its triangles need not be named.
    if (next.slot[s] != no_slot) result.improve(next.slot[s], memory.proofs[s].bound, 0);
  }
  for (std::size_t v = 0; v < next.vertex.size(); ++v)
    if (next.vertex[v] != no_slot) result.hints[next.vertex[v]] = memory.hints[v];
  if (memory.start && next.slot[memory.start->slot] != no_slot) {
    result.start = memory.start;
    result.start->slot = next.slot[memory.start->slot];
  }
  return result;
}

}  // namespace meshbound
