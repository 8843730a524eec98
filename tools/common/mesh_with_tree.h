// SPDX-License-Identifier: MIT
#pragma once
#include <optional>

#include "common/tile_workers.h"
#include "meshbound/bvh.h"
#include "meshbound/triangle_mesh.h"

namespace meshbound::tools {

/// A mesh and its tree, which is built when first used: comparing a mesh with a copy of itself needs none. Not
/// thread-safe.
class MeshWithTree {
 public:
  /// `mesh` must outlive this. `threads` as in `BvhOptions`.
  MeshWithTree(const TriangleMesh& mesh, int threads) : mesh_(mesh), threads_(threads) {}

  [[nodiscard]] const TriangleMesh& mesh() const { return mesh_; }

  /// Makes measurements run tile by tile from here on, as the whole tree may not fit into memory. `workers` must
  /// outlive this.
  void measure_in_tiles(TileWorkers& workers) { workers_ = &workers; }
  [[nodiscard]] TileWorkers* workers() const { return workers_; }  ///< null: it is measured by its tree

  /// Throws `Stopped` as `stop` says; the next call starts again.
  [[nodiscard]] const Bvh& tree(const StopToken& stop) {
    if (!tree_) tree_.emplace(mesh_, BvhOptions{threads_, stop});
    return *tree_;
  }

 private:
  const TriangleMesh& mesh_;
  int threads_;
  std::optional<Bvh> tree_;
  TileWorkers* workers_ = nullptr;
};

}  // namespace meshbound::tools
