// SPDX-License-Identifier: MIT
#pragma once
#include "simplify/cover/original_clusters.h"
#include "simplify/cover/original_soup.h"
#include "simplify/cover/slab_tree.h"

namespace meshbound {

/// The triangles of an original in clusters, and a hierarchy over these. Immutable, safe to share.
struct ClusteredOriginal {
  /// O(n log n).
  explicit ClusteredOriginal(const OriginalSoup& original)
      : clusters(original.triangles, original.vertices.size()), slabs(original, clusters) {}

  OriginalClusters clusters;
  SlabTree slabs;
};

}  // namespace meshbound
