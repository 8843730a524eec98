// SPDX-License-Identifier: GPL-3.0-or-later
#include "cgal/hub_collapse.h"

namespace meshbound::cgal {

std::vector<std::uint32_t> edge_counts(const SurfaceMesh& mesh) {
  std::vector<std::uint32_t> counts(mesh.num_vertices(), 0);
  for (const auto e : mesh.edges()) {
    ++counts[mesh.vertex(e, 0)];
    ++counts[mesh.vertex(e, 1)];
  }
  return counts;
}

}  // namespace meshbound::cgal
