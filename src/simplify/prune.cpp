// SPDX-License-Identifier: MIT
#include "simplify/prune.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "numeric/no_index.h"
#include "numeric/sort_unique.h"

namespace meshbound {
namespace {

using Component = std::vector<std::uint32_t>;

/// By number of faces, then by the first of them.
std::vector<Component> components(const ArrayMesh& mesh) {
  std::vector<Component> all;
  std::vector<std::uint8_t> seen(mesh.face_count(), 0);
  for (std::uint32_t first = 0; first < mesh.face_count(); ++first) {
    if (mesh.is_removed(first) || seen[first] != 0) continue;
    Component faces{first};
    seen[first] = 1;
    for (std::size_t i = 0; i < faces.size(); ++i) {
      for (Corner c = 3 * faces[i]; c < 3 * faces[i] + 3; ++c) {
        if (mesh.twin(c) == no_index || seen[mesh.twin(c) / 3] != 0) continue;
        seen[mesh.twin(c) / 3] = 1;
        faces.push_back(mesh.twin(c) / 3);
      }
    }
    all.push_back(std::move(faces));
  }
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.size() < b.size(); });
  return all;
}

bool must_stay(const DecimationState& state, const Component& component, bool keeps_borders) {
  return std::any_of(component.begin(), component.end(), [&](std::uint32_t f) {
    for (Corner c = 3 * f; c < 3 * f + 3; ++c) {
      if (state.locked[state.mesh.vertex(c)] != 0) return true;
      if (keeps_borders && state.mesh.twin(c) == no_index) return true;
      if (state.lines.is_line(state.mesh, c)) return true;
    }
    return false;
  });
}

/// Originals that some of the faces cover, each once.
std::vector<std::uint32_t> originals_of(const DecimationState& state, const Component& component) {
  std::vector<std::uint32_t> originals;
  for (const std::uint32_t f : component) {
    const auto of_face = state.cover.originals_of(f);
    originals.insert(originals.end(), of_face.begin(), of_face.end());
  }
  sort_unique(originals);
  return originals;
}

}  // namespace

Pruned prune(DecimationState& state, double tolerance, std::size_t min_faces, bool keeps_borders,
             ProofWorkers& workers) {
  state.grow_tolerance(tolerance);
  Pruned pruned;
  if (state.proven_changes) return pruned;  // these could not be taken back without their component
  const std::vector<Component> all = components(state.mesh);
  if (all.size() < 2) return pruned;
  FaceBoxes boxes(state.mesh);
  std::size_t removed = 0;  // since the boxes were made
  std::vector<IdList> covers;
  for (const Component& component : all) {
    if (state.faces < min_faces + component.size() || state.faces == component.size()) continue;
    if (must_stay(state, component, keeps_borders)) continue;
    const std::vector<std::uint32_t> originals = originals_of(state, component);
    if (boxes.are_outdated(removed)) boxes = FaceBoxes(state.mesh), removed = 0;
    state.mesh.remove_component(component);
    std::optional<FaceBoxes> boxes_of_others;  // of a large component all faces would be found for each original
    if (boxes.are_outdated(component.size())) boxes_of_others.emplace(state.mesh);
    if (!workers.cover_anywhere(originals, boxes_of_others ? *boxes_of_others : boxes, covers)) {
      state.mesh.restore_component(component);
      continue;
    }
    for (const std::uint32_t f : component) state.samples.clear(f);
    state.cover.assign(originals, [&](std::size_t i) { return covers[i].ids(); });
    for (std::size_t i = 0; i < originals.size(); ++i) {
      for (const std::uint32_t v : state.triangles[originals[i]]) {
        const std::uint32_t at = state.samples.face_of(v);
        if (at != no_index && state.mesh.is_removed(at)) state.samples.give_to(v, covers[i].ids().front());
      }
    }
    state.faces -= component.size();
    ++pruned.components;
    pruned.faces += component.size();
    removed += component.size();
  }
  return pruned;
}

}  // namespace meshbound
