// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "simplify/cover/original_clusters.h"
#include "simplify/cover/original_soup.h"
#include "simplify/kernel/slab_kernel.h"

namespace meshbound {

/// A hierarchy over the clusters of an original.
///
/// A node knows a ball and a slab through the middle of it, across the mean normal: its triangles lie in both. On a
/// smooth surface the slab is far thinner than a box along the axes, and a face nearly as parallel to it as the surface
/// sees no more of it than its thickness. Immutable, safe to share.
class SlabTree {
 public:
  /// O(n log n).
  SlabTree(const OriginalSoup& soup, const OriginalClusters& clusters);

  /// Eight nodes of one level.
  struct Block {
    SlabBlock slabs;
    /// A bit for each lane: whether every edge of its triangles has a neighbour across, in the node or elsewhere.
    unsigned is_closed = 0;
  };
  [[nodiscard]] std::uint32_t levels() const { return static_cast<std::uint32_t>(levels_.size()); }
  /// Level 0 has the leaves; the last one has a single block. Lane k of block i on another level is the parent of block
  /// 8 i + k of the level below.
  [[nodiscard]] const Block& block(std::uint32_t level, std::uint32_t index) const { return levels_[level][index]; }
  /// The cluster in lane k of block i of level 0, as `leaf` 8 i + k.
  [[nodiscard]] std::uint32_t cluster(std::uint32_t leaf) const { return cluster_of_leaf_[leaf]; }

 private:
  std::vector<std::uint32_t> cluster_of_leaf_;
  std::vector<std::vector<Block>> levels_;
};

}  // namespace meshbound
