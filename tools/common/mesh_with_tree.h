// SPDX-License-Identifier: MIT
#pragma once
#include <optional>

#include "common/tile_workers.h"
#include "mesh/stored_mesh.h"
#include "meshbound/bvh.h"
#include "meshbound/triangle_mesh.h"

namespace meshbound::tools {

/// A mesh and its tree, which is built when first used: comparing a mesh with a copy of itself needs none. Not
/// thread-safe.
class MeshWithTree {
 public:
  /// `mesh` must outlive this. `threads` as in `BvhOptions`.
  MeshWithTree(const TriangleMesh& mesh, int threads) : mesh_(mesh), threads_(threads) {}

  /// Loads a stored mesh when first called.
  [[nodiscard]] const TriangleMesh& mesh() {
    if (stored_ == nullptr) return mesh_;
    if (!loaded_) loaded_ = loaded(*stored_);
    return *loaded_;
  }

  /// Makes this stand for a stored mesh, which is measured tile by tile, as its tree may not fit into memory. Both must
  /// outlive this.
  void measure_in_tiles(const StoredMesh& mesh, TileWorkers& workers) {
    stored_ = &mesh;
    workers_ = &workers;
  }
  [[nodiscard]] const StoredMesh* stored() const { return stored_; }  ///< null: it is measured by its tree
  [[nodiscard]] TileWorkers& workers() const { return *workers_; }    ///< where there is a stored mesh

  /// Throws `Stopped` as `stop` says; the next call starts again.
  [[nodiscard]] const Bvh& tree(const StopToken& stop) {
    if (!tree_) tree_.emplace(mesh_, BvhOptions{threads_, stop});
    return *tree_;
  }

 private:
  const TriangleMesh& mesh_;
  int threads_;
  std::optional<Bvh> tree_;
  const StoredMesh* stored_ = nullptr;
  TileWorkers* workers_ = nullptr;
  std::optional<TriangleMesh> loaded_;
};

}  // namespace meshbound::tools
