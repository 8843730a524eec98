// SPDX-License-Identifier: MIT
#pragma once
#include "mesh/stored_mesh.h"
#include "meshbound/tiles.h"
#include "tiles/tile_jobs.h"

namespace meshbound {

/// As `simplify_in_tiles`, without the measurement of the level; `runner` works on the tiles. Where that are several
/// processes, each calls this with the same mesh and options and gets the same result. Arrays of the size of the
/// original are kept in its space.
[[nodiscard]] SimplifyResult decimate_in_tiles(const StoredMesh& original, const SimplifyOptions& options,
                                               const TileOptions& tiles, JobRunner& runner);

/// The whole of `simplify_in_tiles` in the same way.
[[nodiscard]] SimplifyResult simplify_in_tiles(const TriangleMesh& original, const SimplifyOptions& options,
                                               const TileOptions& tiles, JobRunner& runner);

}  // namespace meshbound
