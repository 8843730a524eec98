// SPDX-License-Identifier: GPL-3.0-or-later
/// A mesh that is proven to stand for an original is cut into parts that are decimated further, each with its own
/// proof.
///
///     +------+------+      Most triangles of the original have a cover of faces of one part, which alone must cover
///     |      s      |      them from then on. Where faces of two parts cover a triangle together, x, these faces stay
///     |   x--s--x   |      as they are, and so does that cover. The mesh is coarse: there are few such faces, where a
///     |      s      |      seam through the original would be long.
///     +------+------+
#pragma once
#include <cstdint>
#include <vector>

#include "cgal/collapse_run.h"
#include "cgal/parts.h"

namespace meshbound::cgal {

class ProvenCutting {
 public:
  /// `original` must outlive this. O(n log n).
  ProvenCutting(ProvenMesh mesh, const TriangleMesh& original, std::size_t parts);
  ProvenCutting(const ProvenCutting&) = delete;
  ProvenCutting& operator=(const ProvenCutting&) = delete;

  [[nodiscard]] const Cutting& cutting() const { return *cutting_; }
  [[nodiscard]] const ProvenMesh& mesh() const { return mesh_; }
  /// Safe to call from several threads. O(size of the part + vertices of the original).
  [[nodiscard]] ProvenPart part(std::size_t index) const;
  /// The proof of the triangles that faces of several parts stand for. `face_of` gives by part and by place in its
  /// polygons what has become of a face.
  [[nodiscard]] DeviationMonitor<SurfaceMesh>::Part shared_proof(
      const std::vector<DeviationMonitor<SurfaceMesh>::Part>& parts) const;

 private:
  [[nodiscard]] std::span<const std::uint32_t> cover(std::uint32_t triangle) const {
    const std::size_t begin = triangle == 0 ? 0 : mesh_.proof.ends[triangle - 1];
    return {mesh_.proof.faces.data() + begin, mesh_.proof.ends[triangle] - begin};
  }
  [[nodiscard]] std::vector<bool> distribute(std::size_t parts);

  ProvenMesh mesh_;
  const TriangleMesh& original_;
  TriangleMesh soup_;                                  ///< the mesh itself
  std::vector<std::uint32_t> named_after_;             ///< by face: triangle of the original
  std::vector<std::uint32_t> part_of_;                 ///< by face
  std::vector<std::uint32_t> place_;                   ///< by face: among those of its part
  std::vector<std::vector<std::uint32_t>> originals_;  ///< by part: triangles that its faces stand for, ascending
  std::vector<std::uint32_t> shared_;                  ///< of these, the ones of several parts, ascending
  std::optional<Cutting> cutting_;
};

}  // namespace meshbound::cgal
