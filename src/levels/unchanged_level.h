// SPDX-License-Identifier: MIT
#pragma once
#include "mesh/round_to_floats.h"
#include "meshbound/simplify.h"
#include "numeric/numbers_below.h"

namespace meshbound {

/// Makes the mesh of a level the original, rounded where the options ask for floats, with its sources and texture
/// coordinates. Everything else of the level stays.
inline void take_unchanged(const TriangleMesh& original, const SimplifyOptions& options, SimplifiedLevel& level) {
  level.mesh = original;
  if (options.precision == Precision::Single) round_to_floats(level.mesh);
  level.source_vertex = numbers_below(original.vertices.size());
  level.source_triangle = numbers_below(original.triangles.size());
  level.texture_coordinates = options.texture_coordinates;
}

}  // namespace meshbound
