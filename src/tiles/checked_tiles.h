// SPDX-License-Identifier: MIT
#pragma once
#include "meshbound/error.h"
#include "meshbound/tiles.h"

namespace meshbound {

/// The options; throws `InvalidInput` for tiles without triangles.
inline const TileOptions& checked(const TileOptions& tiles) {
  if (tiles.max_triangles == 0) throw InvalidInput("a tile must have room for 1 triangle or more");
  return tiles;
}

}  // namespace meshbound
