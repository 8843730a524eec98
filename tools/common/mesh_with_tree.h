// SPDX-License-Identifier: MIT
#pragma once
#include <optional>

#include "meshbound/bvh.h"
#include "meshbound/tiles.h"
#include "meshbound/triangle_mesh.h"

namespace meshbound::tools {

/// A mesh and its tree, which is built when first used: comparing a mesh with a copy of itself needs none. Not
/// thread-safe.
class MeshWithTree {
 public:
  /// `mesh` must outlive this. `threads` as in `BvhOptions`.
  MeshWithTree(const TriangleMesh& mesh, int threads) : mesh_(mesh), threads_(threads) {}

  [[nodiscard]] const TriangleMesh& mesh() const { return mesh_; }

  /// Makes measurements run tile by tile from here on, as the whole tree may not fit into memory.
  void measure_in_tiles(const TileOptions& tiles) { tiles_ = tiles; }
  [[nodiscard]] const std::optional<TileOptions>& tiles() const { return tiles_; }

  /// Throws `Stopped` as `stop` says; the next call starts again.
  [[nodiscard]] const Bvh& tree(const StopToken& stop) {
    if (!tree_) tree_.emplace(mesh_, BvhOptions{threads_, stop});
    return *tree_;
  }

 private:
  const TriangleMesh& mesh_;
  int threads_;
  std::optional<Bvh> tree_;
  std::optional<TileOptions> tiles_;
};

}  // namespace meshbound::tools
