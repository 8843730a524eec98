// SPDX-License-Identifier: MIT
#include "simplify/cover/original_clusters.h"

#include "numeric/no_index.h"

namespace meshbound {

OriginalClusters::OriginalClusters(const std::vector<Triangle>& triangles, std::size_t vertex_count) {
  std::vector<std::uint32_t> last_cluster(vertex_count, no_index);  // by vertex
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const std::uint32_t cluster = cluster_of(t);
    for (const std::uint32_t v : triangles[t]) {
      if (last_cluster[v] == cluster) continue;
      last_cluster[v] = cluster;
      vertices_.push_back(v);
    }
    if (t % size == size - 1 || t + 1 == triangles.size())
      first_vertex_.push_back(static_cast<std::uint32_t>(vertices_.size()));
  }
}

}  // namespace meshbound
