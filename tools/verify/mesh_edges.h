// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "meshbound/triangle_mesh.h"
#include "verify/certificate_reader.h"

namespace meshbound::verify {

/// The edges of the triangles of a mesh. Vertices at equal coordinates are one.
class MeshEdges {
 public:
  /// `mesh` must be one that the verifier accepts, and outlive this. O(n log n).
  explicit MeshEdges(const TriangleMesh& mesh);

  /// The edges of the list, each as a triangle without area whose last two corners are its second vertex. Throws
  /// `Rejected`, with `name` for the mesh, if a triangle has no such edge or the list is empty. O(edges log n).
  [[nodiscard]] TriangleMesh lines(const EdgeList& edges, const char* name) const;
  /// Whether the list has every border: each edge that exactly one triangle with three different positions has. A
  /// triangle with two corners at one position is a segment or a point, and has no border. O(edges log edges).
  [[nodiscard]] bool has_all_borders(const EdgeList& edges) const;

 private:
  using Key = std::array<std::uint32_t, 2>;  ///< ascending
  [[nodiscard]] Key key(std::uint32_t a, std::uint32_t b) const;

  const TriangleMesh& mesh_;
  std::vector<std::uint32_t> position_;  ///< by vertex: the same number at the same coordinates
  std::vector<Key> edges_;               ///< of all triangles, ascending
  std::vector<Key> borders_;             ///< ascending
};

}  // namespace meshbound::verify
