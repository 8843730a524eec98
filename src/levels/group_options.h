// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <vector>

#include "levels/scene_groups.h"
#include "meshbound/simplify.h"

namespace meshbound {

/// Translates options that speak of vertices, edges and triangles of an original to those of its groups. All groups
/// together cost time linear in the original and its copies. Not thread-safe.
class GroupOptions {
 public:
  /// The arguments must outlive this. Throws `InvalidInput` for options that do not fit the original.
  GroupOptions(const TriangleMesh& original, const SimplifyOptions& options);

  /// What is said of any copy holds for the group.
  [[nodiscard]] SimplifyOptions of(const SceneGroup& group);

 private:
  void add_feature_edges(SimplifyOptions& to) const;
  void add_locked_vertices(SimplifyOptions& to, std::size_t count) const;
  void add_face_tolerances(SimplifyOptions& to, const SceneGroup& group) const;

  const TriangleMesh& original_;
  const SimplifyOptions& options_;
  SimplifyOptions common_;                 ///< what is said of no single vertex, edge or triangle
  std::vector<Edge> edges_;                ///< by first vertex
  std::vector<std::uint32_t> first_edge_;  ///< of `edges_`, by first vertex, and the end of the last
  std::vector<std::uint32_t> number_;      ///< by vertex of the original: in the group at hand, else `no_index`
  std::vector<std::uint32_t> numbered_;    ///< vertices of the original in the copies of the group at hand
};

}  // namespace meshbound
