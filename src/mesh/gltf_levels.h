// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <vector>

#include "mesh/gltf_content.h"
#include "mesh/gltf_document.h"

namespace meshbound {

/// A node that shows a mesh, and the sizes on the screen at which it switches levels.
struct NodeCoverage {
  std::size_t node = 0;
  /// By level, the finest first: the level is shown where the model covers at least this share of the screen's height
  /// and less than the share of the level before. No share is larger than the one before it; the last is 0.
  std::vector<double> shares;
};

/// Where the vertices of the levels of a mesh are stored.
enum class LevelVertices {
  Apart,  ///< each primitive of each level has its own
  Shared  ///< all levels share one set, each vertex once; their primitives are lists of indices
};

/// A level as it was read from a file.
struct GltfLevel {
  MeshSource source;
  GltfDocument document;
};

/// Merges the documents of all levels into one: that of the finest level, whose nodes refer to the coarser ones by the
/// extension MSFT_lod, with the shares of `nodes` as MSFT_screencoverage. The documents must be levels of one model;
/// textures and everything else is stored once. A node with children, a
/// camera, extensions or an animation gets a child that shows its mesh.
[[nodiscard]] GltfContent with_levels(const std::vector<GltfLevel>& levels, const std::vector<NodeCoverage>& nodes,
                                      LevelVertices vertices);

}  // namespace meshbound
