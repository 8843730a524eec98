// SPDX-License-Identifier: MIT
#pragma once
#include "meshbound/tiles.h"
#include "tiles/tile_jobs.h"

namespace meshbound {

/// As `hausdorff_distance_in_tiles`; `runner` works on the tiles. Where that are several processes, each calls this
/// with the same meshes and options and gets the same result.
[[nodiscard]] HausdorffDistance measure_in_tiles(const TriangleMesh& a, const TriangleMesh& b,
                                                 const DistanceOptions& options, const TileOptions& tiles,
                                                 JobRunner& runner);

/// As `one_sided_hausdorff_distance_in_tiles`, in the same way.
[[nodiscard]] OneSidedDistance measure_one_side_in_tiles(const TriangleMesh& a, const TriangleMesh& b,
                                                         const DistanceOptions& options, const TileOptions& tiles,
                                                         JobRunner& runner);

}  // namespace meshbound
