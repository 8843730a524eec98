// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <vector>

#include "meshbound/simplify.h"
#include "meshbound/stop_token.h"
#include "simplify/proven_mesh.h"

namespace meshbound {

/// What the simplification of one tile starts from. All numbers are those of the tile.
struct TileInput {
  TriangleMesh original;
  std::optional<ProvenMesh> start;  ///< absent: the original itself
  std::vector<bool> locked;         ///< by vertex of the start
  std::vector<bool> at_rim;         ///< by vertex of the start: the whole mesh may have more triangles around it
};

/// A tile that has been simplified.
struct TileOutput {
  ProvenMesh proven;
  std::vector<std::uint32_t> source_vertex;    ///< by vertex of `proven.mesh`: the vertex of the start
  std::vector<std::uint32_t> source_triangle;  ///< by triangle of `proven.mesh`: the triangle of the start
  std::vector<std::uint32_t> kept;             ///< originals that are part of the result as they are, beside the mesh
  std::vector<std::uint32_t>
      turned;  ///< triangles of `proven.mesh` that face the other way than in the start, ascending
  EndedBy ended_by = EndedBy::NothingFits;
  CollapseCounts counts;
  std::size_t dropped_triangles = 0;  ///< as in `SimplifyResult`
  bool split = false;                 ///< as in `SimplifyResult`
};

/// Simplifies a tile until nothing fits or `stop` ends it; the tile may then be unchanged. Uses only these options:
/// tolerance, effort, boundary, placements, precision, threads and driver. Throws as `simplify_with_bound`.
[[nodiscard]] TileOutput simplify_tile(const TileInput& input, const SimplifyOptions& options, const StopToken& stop);

}  // namespace meshbound
