// SPDX-License-Identifier: MIT
/// Results of tiles as bytes, for other processes and for files that a later run goes on from.
#pragma once
#include <string>
#include <string_view>

#include "meshbound/distance.h"
#include "tiles/tile_run.h"

namespace meshbound {

/// What a tile started from, as far as it says what to expect of the result. All numbers are those of the tile.
struct TileStart {
  TriangleMesh mesh;
  std::vector<std::uint32_t> near;  ///< as in `ProvenMesh`
  NumberLists cover;  ///< by original: triangles of `mesh` near it; empty where the tile does not cover it anew
};

/// What differs from the start: a result that hardly changed takes hardly any bytes, and one that changed takes about a
/// byte for each edge of the original that lies between triangles of the result. Covers of originals that have none in
/// `start` are left out. O(n log n).
[[nodiscard]] std::string packed_tile(TileOutput output, const TileStart& start);

/// Throws `InvalidInput` for bytes that `packed_tile` cannot have written for this start; most others give a result
/// that is none. Indices are in range in any case.
[[nodiscard]] TileOutput unpacked_tile(std::string_view bytes, const TileStart& start);

/// A distance with all its statistics.
[[nodiscard]] std::string packed_distance(const OneSidedDistance& distance);
/// Throws `InvalidInput` for other bytes than those of `packed_distance`.
[[nodiscard]] OneSidedDistance unpacked_distance(std::string_view bytes);

}  // namespace meshbound
