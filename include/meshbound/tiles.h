// SPDX-License-Identifier: MIT
/// Meshes whose trees and proofs would not fit into memory: simplified and measured tile by tile. The mesh itself is in
/// memory here; the tools keep it on disk.
#pragma once
#include <cstddef>

#include "meshbound/distance.h"
#include "meshbound/simplify.h"

namespace meshbound {

/// How a mesh is cut into tiles.
struct TileOptions {
  /// A tile has about so many triangles of the original, or twice as many once a first pass has simplified them. A tile
  /// under work takes up to 1.1 kB for each of this number (measured at 0.02% of the diagonal), a thread works on one
  /// tile at a time. The result depends on this number and not on the threads. `InvalidInput` for 0; simplification
  /// takes fewer than 8 for 8.
  std::size_t max_triangles = std::size_t{1} << 18;
};

/// As `simplify_with_bound`, tile by tile: the mesh is cut by planes into tiles of about equal size, each is simplified
/// with the vertices that it shares with others locked, then the mesh is cut elsewhere, up to three times, so that what
/// was a seam lies inside a tile. A tile goes on from the proof that the ones before have left: no tolerance is
/// divided. The verdict is that of `hausdorff_distance_in_tiles`.
///
/// Results are the same to the bit for any number of threads, but for `time_limit` and `cancel`. Takes one tolerance:
/// throws `InvalidInput` for levels, targets, `OnExceed::Stop`, `prune`, feature lines and angles, tolerances of faces,
/// texture coordinates, sides to keep, normal tolerances, looks and certificates; as `simplify_with_bound` otherwise.
/// `Effort::High` refines inside the first tiles only. Memory: about 80 bytes for each triangle of the original, the
/// original included, and the tiles under work. Expected O(n log n) time.
[[nodiscard]] SimplifyResult simplify_in_tiles(const TriangleMesh& original, const SimplifyOptions& options,
                                               const TileOptions& tiles = {});

/// As `hausdorff_distance`, tile by tile, with the same guarantee: a tile of one mesh is compared with the parts of the
/// other one that are near enough to matter, more of them where the first ones were not. Statistics are sums over the
/// tiles; a budget of subdivisions is that of a tile. Throws and takes threads as `hausdorff_distance`. Memory: both
/// meshes, 64 bytes for each triangle of the larger one, and the trees of the tiles under work.
[[nodiscard]] HausdorffDistance hausdorff_distance_in_tiles(const TriangleMesh& a, const TriangleMesh& b,
                                                            const DistanceOptions& options = {},
                                                            const TileOptions& tiles = {});

/// As `one_sided_hausdorff_distance`, tile by tile: measures h(A, B). Errors, memory and threads as above.
[[nodiscard]] OneSidedDistance one_sided_hausdorff_distance_in_tiles(const TriangleMesh& a, const TriangleMesh& b,
                                                                     const DistanceOptions& options = {},
                                                                     const TileOptions& tiles = {});

}  // namespace meshbound
