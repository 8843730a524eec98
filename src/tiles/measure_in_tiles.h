// SPDX-License-Identifier: MIT
#pragma once
#include "mesh/stored_mesh.h"
#include "meshbound/tiles.h"
#include "tiles/tile_jobs.h"

namespace meshbound {

/// As `hausdorff_distance_in_tiles`; `runner` works on the tiles. Where that are several processes, each calls this
/// with the same meshes and options and gets the same result. Arrays of the size of a mesh are kept in its space.
[[nodiscard]] HausdorffDistance measure_in_tiles(const StoredMesh& a, const StoredMesh& b,
                                                 const DistanceOptions& options, const TileOptions& tiles,
                                                 JobRunner& runner);
/// As above for meshes in memory, which it validates.
[[nodiscard]] HausdorffDistance measure_in_tiles(const TriangleMesh& a, const TriangleMesh& b,
                                                 const DistanceOptions& options, const TileOptions& tiles,
                                                 JobRunner& runner);

/// As `default_error_bound` of "meshbound/distance.h"; `diagonal` is that of the bounding box of A.
[[nodiscard]] double default_error_bound(const StoredMesh& a, const StoredMesh& b, double diagonal);

/// As `one_sided_hausdorff_distance_in_tiles`, in the same way.
[[nodiscard]] OneSidedDistance measure_one_side_in_tiles(const StoredMesh& a, const StoredMesh& b,
                                                         const DistanceOptions& options, const TileOptions& tiles,
                                                         JobRunner& runner);
/// As above for meshes in memory, which it validates.
[[nodiscard]] OneSidedDistance measure_one_side_in_tiles(const TriangleMesh& a, const TriangleMesh& b,
                                                         const DistanceOptions& options, const TileOptions& tiles,
                                                         JobRunner& runner);

}  // namespace meshbound
