// SPDX-License-Identifier: MIT
// What comes out of a decimation: the mesh, its proof, and what was counted.
#include <algorithm>
#include <utility>

#include "numeric/no_index.h"
#include "simplify/decimation.h"

namespace meshbound {
namespace {

/// Items, each with the number of what it comes from in the start.
class Sourced {
 public:
  void add(std::uint32_t source, std::uint32_t item) { keys_.push_back(std::uint64_t{source} << 32 | item); }
  /// The items in the order of their sources; those of one source ascend.
  [[nodiscard]] std::vector<std::uint32_t> items_in_order() && {
    std::sort(keys_.begin(), keys_.end());
    std::vector<std::uint32_t> items(keys_.size());
    std::transform(keys_.begin(), keys_.end(), items.begin(),
                   [](std::uint64_t key) { return static_cast<std::uint32_t>(key); });
    return items;
  }

 private:
  std::vector<std::uint64_t> keys_;  ///< one number sorts faster than a pair
};

}  // namespace

/// The faces that are left, by their number in the start.
std::vector<std::uint32_t> Decimation::faces_in_order() const {
  Sourced faces;
  for (std::uint32_t f = 0; f < state_->mesh.face_count(); ++f)
    if (!state_->mesh.is_removed(f)) faces.add(caller_triangle(state_->source_triangle[f]), f);
  return std::move(faces).items_in_order();
}

void Decimation::current_mesh(SimplifiedLevel& into) const {
  const DecimationState& state = *state_;
  Sourced vertices, kept;
  for (std::uint32_t v = 0; v < state.mesh.vertex_count(); ++v)
    if (state.mesh.is_vertex(v)) vertices.add(source_of(v), v);
  for (const std::uint32_t t : state.kept) kept.add(order_.triangle[t], t);
  TriangleMesh& mesh = into.mesh;
  mesh = {};
  into.source_vertex.clear();
  into.source_triangle.clear();
  into.turned_faces = 0;
  into.lines.clear();
  into.texture_coordinates.clear();
  std::vector<std::uint32_t> index(state.mesh.vertex_count());
  for (const std::uint32_t v : std::move(vertices).items_in_order()) {
    index[v] = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.push_back(in_model(v));
    into.source_vertex.push_back(source_of(v));
  }
  for (const std::uint32_t f : faces_in_order()) {
    const auto corners = state.mesh.corners(f);
    mesh.triangles.push_back({index[corners[0]], index[corners[1]], index[corners[2]]});
    into.source_triangle.push_back(caller_triangle(state.source_triangle[f]));
    if (state.texture) into.texture_coordinates.push_back(state.texture->of(f));
    const bool is_turned_over = has_turned_faces_ && is_turned_over_[f] != 0;
    if (is_turned_over && !keeps_sides()) ++into.turned_faces;
    if (is_turned_over && keeps_sides()) {
      std::swap(mesh.triangles.back()[1], mesh.triangles.back()[2]);
      if (state.texture) std::swap(into.texture_coordinates.back()[1], into.texture_coordinates.back()[2]);
    }
    for (Corner c = 3 * f; c < 3 * f + 3; ++c) {
      if (state.mesh.edge(c) == c && state.lines.is_line(state.mesh, c))
        into.lines.push_back({index[state.mesh.start(c)], index[state.mesh.end(c)]});
    }
  }
  for (const std::uint32_t t : std::move(kept).items_in_order()) {
    Triangle corners{};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t v = order_.triangles[t][i];
      corners[i] = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.vertices.push_back(as_written(in_original(v)));  // two may have one place in the frame
      into.source_vertex.push_back(order_.vertex[v]);
    }
    mesh.triangles.push_back(corners);
    into.source_triangle.push_back(order_.triangle[t]);
    if (state.texture) into.texture_coordinates.push_back(options_.texture_coordinates[order_.triangle[t]]);
  }
}

std::vector<std::uint32_t> Decimation::turned_faces() const {
  std::vector<std::uint32_t> turned;
  if (!has_turned_faces_ || keeps_sides()) return turned;
  const std::vector<std::uint32_t> faces = faces_in_order();
  for (std::uint32_t i = 0; i < faces.size(); ++i)
    if (is_turned_over_[faces[i]] != 0) turned.push_back(i);
  return turned;
}

void Decimation::current_proof(ProvenMesh& into) const {
  const std::vector<std::uint32_t> faces = faces_in_order();
  std::vector<std::uint32_t> index(state_->mesh.face_count(), no_index);
  into.near.clear();
  for (std::uint32_t i = 0; i < faces.size(); ++i) {
    index[faces[i]] = i;
    into.near.push_back(order_.triangle[state_->nearest[faces[i]]]);
  }
  into.cover = {};
  for (const std::uint32_t t : index_of_caller_triangle()) {
    for (const std::uint32_t f : state_->cover.faces_of(t)) into.cover.numbers.push_back(index[f]);
    into.cover.end_list();
  }
}

void Decimation::describe(SimplifyResult& result) const {
  result.kept_triangles = state_->kept.size();
  result.dropped_triangles = below_rounding_ ? 0 : dropped_triangles_ - result.kept_triangles;
  result.locked_vertices = locked_vertices_;
  result.split = split_;
  result.pruned_components = pruned_components_;
  result.pruned_faces = pruned_faces_;
  result.tolerance_below_rounding = below_rounding_;
  result.counts = counts();
}

}  // namespace meshbound
