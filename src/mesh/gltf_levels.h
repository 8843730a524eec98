// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <vector>

#include "mesh/gltf_content.h"

namespace meshbound {

/// A node that shows a mesh, and from which size on the screen on it shows which level.
struct NodeCoverage {
  std::size_t node = 0;
  /// By level, the finest first: it is shown where the model covers at least this share of the screen's height, and
  /// less than that of the level before. Not ascending; the last is 0.
  std::vector<double> shares;
};

/// One document with all levels of another: the finest, whose nodes name those of the coarser ones as the extension
/// MSFT_lod does, with `shares` as MSFT_screencoverage. All have the same nodes, since they come from one document;
/// textures and all else is there once. A node with children or an animation gets a child that shows its mesh.
[[nodiscard]] GltfContent with_levels(const std::vector<GltfContent>& levels, const std::vector<NodeCoverage>& nodes);

}  // namespace meshbound
