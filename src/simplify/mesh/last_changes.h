// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "numeric/no_index.h"
#include "simplify/mesh/array_mesh.h"

namespace meshbound {

/// By vertex: the number of the last change of it, 0 for none. A collapse changes both ends of its edge, a move its
/// vertex, and all faces around it. Numbers of later changes are larger.
class LastChanges {
 public:
  explicit LastChanges(std::size_t vertices) : numbers_(vertices, 0) {}

  [[nodiscard]] std::uint32_t of_vertex(std::uint32_t vertex) const { return numbers_[vertex]; }
  /// Returns what it was before.
  std::uint32_t set(std::uint32_t vertex, std::uint32_t number) { return std::exchange(numbers_[vertex], number); }
  void clear() { std::fill(numbers_.begin(), numbers_.end(), 0); }

  /// The last change of a face. One that is left has come to all its vertices by the last change of them, or before: it
  /// is the latest of its corners. One that a collapse has removed still has the vertex that went with it as a corner,
  /// whose last change this is; what else is gone of its corners went later.
  [[nodiscard]] std::uint32_t of_face(const ArrayMesh& mesh, std::uint32_t face) const {
    const auto [a, b, c] = mesh.corners(face);
    if (!mesh.is_removed(face)) return std::max({numbers_[a], numbers_[b], numbers_[c]});
    std::uint32_t first = no_index;
    for (const std::uint32_t v : {a, b, c})
      if (!mesh.is_vertex(v)) first = std::min(first, numbers_[v]);
    return first == no_index ? 0 : first;
  }

 private:
  std::vector<std::uint32_t> numbers_;
};

}  // namespace meshbound
