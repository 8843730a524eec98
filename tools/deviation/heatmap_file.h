// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

#include "deviation/deviation_scale.h"
#include "mesh/atomic_file.h"
#include "meshbound/bounds.h"
#include "meshbound/triangle_mesh.h"

namespace meshbound::tools {

/// Writes a mesh as binary PLY with, for each vertex, its coordinates (double), the upper bound of its deviation
/// (`quality`, double, model units) and its colour on the scale (`red`, `green`, `blue`). Comments of the header say
/// what the numbers are. `deviations` has one entry for each vertex. The caller commits the file. Throws as
/// `AtomicFile`.
void write_heatmap(AtomicFile& file, const TriangleMesh& mesh, const std::vector<Bounds>& deviations,
                   const DeviationScale& scale, const std::string& description);

}  // namespace meshbound::tools
