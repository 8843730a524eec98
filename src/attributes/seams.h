// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "attributes/layers.h"
#include "meshbound/attributes.h"

namespace meshbound {

/// The charts of a mesh: sets of triangles connected without crossing a seam.
struct ChartPartition {
  std::vector<std::uint32_t> chart_of;  ///< by triangle
  std::uint32_t count = 0;
  std::vector<std::array<std::uint32_t, 3>> neighbours;  ///< by triangle and edge: across it, `no_index` at borders
  std::vector<std::array<std::uint8_t, 3>> is_seam;      ///< by triangle and edge
  std::vector<std::uint32_t> first;                      ///< by vertex: the first one at its position
  Layers layers;                                         ///< neighbours are of one layer
};

/// Seams are where texture coordinates, materials, parts, objects, groups, smoothing groups or named attributes with
/// seams differ. Throws `InvalidInput` if the attributes are for another number of triangles. O(n log n).
[[nodiscard]] ChartPartition charts(const TriangleMesh& mesh, const MeshAttributes& attributes);

/// `seams` (meshbound/attributes.h) of a mesh with these charts. O(n).
[[nodiscard]] std::vector<Edge> seams(const TriangleMesh& mesh, const MeshAttributes& attributes,
                                      const ChartPartition& charts);

/// Cuts the charts of a mesh where its normals differ as well: surfaces are shaded smoothly within a chart then. False
/// if they differ nowhere else than at seams, so that nothing has changed. O(n).
bool cut_at_normals(const TriangleMesh& mesh, const CornerAttribute& normals, ChartPartition& charts);

}  // namespace meshbound
