// SPDX-License-Identifier: MIT
#pragma once
#include <vector>

#include "common/gated_output.h"
#include "lod/pixel_limit.h"
#include "mesh/atomic_file.h"
#include "mesh/gltf_levels.h"
#include "meshbound/attributes.h"

namespace meshbound::tools {

/// Writes one GLB file with all levels, the finest first, as they stand in `outputs`: MSFT_lod, with shares of the
/// screen below which the proven error of a level covers at most so many pixels. `original` and `attributes` tell how
/// large what each node shows is. Throws `IoError`, `InvalidInput`.
void write_levels(AtomicFile& file, const std::vector<GatedOutput>& outputs, const TriangleMesh& original,
                  const MeshAttributes& attributes, const PixelLimit& limit, LevelVertices vertices);

}  // namespace meshbound::tools
