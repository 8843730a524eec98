// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>

#include "meshbound/tiles.h"

namespace meshbound::tools {

/// Bytes: a number, or one with K, M, G or T, powers of 1024. Throws `InvalidInput` that names the option, also
/// for less than 1 MiB.
[[nodiscard]] std::uint64_t parse_memory(const std::string& option, const std::string& text);

/// Limits the memory for data of this process from here on: allocations beyond the limit fail.
void limit_memory(std::uint64_t bytes);

/// What the program named `tool` says where memory has run out: the limit, if there is one, who has set it, and what
/// helps.
[[nodiscard]] std::string out_of_memory(const std::string& tool);

/// The largest number of bytes that this process has held at once.
[[nodiscard]] std::uint64_t peak_memory();

/// "1234 MiB", rounded up.
[[nodiscard]] std::string in_mebibytes(double bytes);

/// Bytes for each triangle in work tile by tile: `whole` of all meshes, which are on disk, `tile` of a tile in work.
struct TileCost {
  double whole, tile;
};
/// Simplifying: the tiles of vertices, 6 bytes for each triangle where vertices are shared, and room for the result; a
/// tile at 0.02% of the diagonal (docs/scale.md).
inline constexpr TileCost cost_of_simplifying{16, 1100};
/// Measuring: the boxes of clusters and the summary of each mesh; the trees of a tile and of what is near it.
inline constexpr TileCost cost_of_measuring{8, 400};

/// Whether two meshes with this many vertices and triangles together can be compared in memory within every limit that
/// `threads_within` accepts for measuring them: their arrays, and tables of the positions and triangles of one of them,
/// which take up to 1.2 times as much as the arrays of both. It does not depend on the limit, so that no result does.
[[nodiscard]] bool fits_to_compare(std::size_t vertices, std::size_t triangles, const TileOptions& tiles);

/// How many of the wanted threads may work on tiles of this many triangles within a limit in
/// bytes. Throws `InvalidInput` that names `option` if not even one may.
[[nodiscard]] int threads_within(std::uint64_t limit, const std::string& option, std::size_t triangles,
                                 const TileOptions& tiles, const TileCost& cost, int wanted);

}  // namespace meshbound::tools
