// SPDX-License-Identifier: MIT
#include "decimation/kept_vertices.h"

#include <algorithm>
#include <utility>

namespace meshbound::tools {

void KeptVertices::note(std::uint32_t face, std::uint32_t triangle, double amount) {
  exceeding_.push_back(triangle);
  Worst& worst = worst_of_face_[face];
  if (amount > worst.amount) worst = {amount, triangle};
}

/// Vertices whose nearest face of the attempt is one that exceeds.
void KeptVertices::note_vertices_near(const std::vector<std::uint8_t>& exceeds, const TriangleMesh& attempt) {
  const Bvh tree(attempt);
  for (std::uint32_t v = 0; v < original_.vertices.size(); ++v)
    if (exceeds[closest_point(tree, original_.vertices[v]).point.triangle] != 0) near_exceeding_.push_back(v);
}

void KeptVertices::learn(const TextureDeviation& deviation, const Bvh& original, const TriangleMesh& attempt) {
  for (const TextureWitness& w : deviation.a_to_b.exceeding) note(w.nearest.triangle, w.from.triangle, w.distance);
  for (const TextureWitness& w : deviation.b_to_a.exceeding)
    note(w.from.triangle, closest_point(original, w.from.position).point.triangle, w.distance);
  if (deviation.b_to_a.exceeding.empty() || rounds_ < gradual_rounds) return;
  std::vector<std::uint8_t> exceeds(attempt.triangles.size(), 0);
  for (const TextureWitness& w : deviation.b_to_a.exceeding) exceeds[w.from.triangle] = 1;
  note_vertices_near(exceeds, attempt);
}

void KeptVertices::learn(const NormalDeviation& deviation) {
  for (const FaceTurn& turn : deviation.exceeding) note(turn.nearest.triangle, turn.from.triangle, turn.degrees);
}

bool KeptVertices::lock_vertex(std::uint32_t vertex) {
  const bool locks_more = !locked_[vertex];
  locked_[vertex] = true;
  return locks_more;
}

bool KeptVertices::lock(std::uint32_t triangle) {
  bool locks_more = false;
  for (const std::uint32_t v : original_.triangles[triangle]) locks_more = lock_vertex(v) || locks_more;
  return locks_more;
}

bool KeptVertices::lock_around() {
  std::vector<bool> reached(original_.vertices.size());
  for (const std::uint32_t t : exceeding_)
    for (const std::uint32_t v : original_.triangles[t]) reached[v] = true;
  for (bool has_grown = true; has_grown;) {
    bool locks_more = false;
    std::vector<bool> next = reached;
    for (std::uint32_t t = 0; t < original_.triangles.size(); ++t) {
      const Triangle& corners = original_.triangles[t];
      if (std::none_of(corners.begin(), corners.end(), [&](std::uint32_t v) { return reached[v]; })) continue;
      locks_more = lock(t) || locks_more;
      for (const std::uint32_t v : corners) next[v] = true;
    }
    if (locks_more) return true;
    has_grown = next != reached;
    reached = std::move(next);
  }
  return false;
}

bool KeptVertices::tighten() {
  if (++rounds_ > max_rounds) return false;
  locked_.resize(original_.vertices.size());
  bool locks_more = false;
  if (rounds_ <= gradual_rounds)
    for (const auto& [face, worst] : worst_of_face_) locks_more = lock(worst.triangle) || locks_more;
  if (!locks_more) {
    for (const std::uint32_t t : exceeding_) locks_more = lock(t) || locks_more;
    for (const std::uint32_t v : near_exceeding_) locks_more = lock_vertex(v) || locks_more;
  }
  if (!locks_more) locks_more = lock_around();
  worst_of_face_.clear();
  exceeding_.clear();
  near_exceeding_.clear();
  return locks_more;
}

}  // namespace meshbound::tools
