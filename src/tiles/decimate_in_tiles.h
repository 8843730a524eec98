// SPDX-License-Identifier: MIT
#pragma once
#include "meshbound/tiles.h"

namespace meshbound {

/// As `simplify_in_tiles`, without the measurement of the level.
[[nodiscard]] SimplifyResult decimate_in_tiles(const TriangleMesh& original, const SimplifyOptions& options,
                                               const TileOptions& tiles);

}  // namespace meshbound
