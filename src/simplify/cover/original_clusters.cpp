// SPDX-License-Identifier: MIT
#include "simplify/cover/original_clusters.h"

namespace meshbound {

OriginalClusters::OriginalClusters(const std::vector<Triangle>& triangles, std::size_t vertex_count)
    : corners_(triangles.size()) {
  // By vertex: one more than its index in `vertices_`, where it was put last.
  std::vector<std::uint32_t> last_place(vertex_count, 0);
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const std::uint32_t first = first_vertex_.back();
    for (std::size_t k = 0; k < 3; ++k) {
      std::uint32_t& place = last_place[triangles[t][k]];
      if (place <= first) {
        vertices_.push_back(triangles[t][k]);
        place = static_cast<std::uint32_t>(vertices_.size());
      }
      corners_[t][k] = static_cast<std::uint8_t>(place - 1 - first);
    }
    if (t % size == size - 1 || t + 1 == triangles.size())
      first_vertex_.push_back(static_cast<std::uint32_t>(vertices_.size()));
  }
}

}  // namespace meshbound
