// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <vector>

#include "mesh/gltf_content.h"

namespace meshbound {

/// A node that shows a mesh, and the sizes on the screen at which it switches levels.
struct NodeCoverage {
  std::size_t node = 0;
  /// By level, the finest first: the level is shown where the model covers at least this share of the screen's height
  /// and less than the share of the level before. No share is larger than the one before it; the last is 0.
  std::vector<double> shares;
};

/// Merges the documents of all levels into one: that of the finest level, whose nodes refer to the coarser ones by the
/// extension MSFT_lod, with `shares` as MSFT_screencoverage. The documents must have the same nodes; textures and
/// everything else is stored once. A node with children or an animation gets a child that shows its mesh.
[[nodiscard]] GltfContent with_levels(const std::vector<GltfContent>& levels, const std::vector<NodeCoverage>& nodes);

}  // namespace meshbound
