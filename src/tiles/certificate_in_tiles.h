// SPDX-License-Identifier: MIT
#pragma once
#include <optional>

#include "mesh/stored_mesh.h"
#include "meshbound/certificate.h"
#include "meshbound/tiles.h"
#include "tiles/tile_jobs.h"

namespace meshbound {

/// As `build_certificate`, tile by tile; `runner` works on the tiles. Where that are several processes, each calls this
/// with the same meshes and options, and the first one gets the certificate, the others an empty one. The bytes depend
/// on the tiles, not on who works. `options.lines` must be absent. In memory: the certificate, 4 bytes for each
/// triangle of the larger mesh and 4 for each of its vertices, and the trees of the tiles under work; proofs are kept
/// in the space of the mesh that they are of, 48 bytes for each piece.
[[nodiscard]] std::optional<Certificate> certify_in_tiles(const StoredMesh& original, const StoredMesh& simplified,
                                                          double tolerance, const CertificateOptions& options,
                                                          const TileOptions& tiles, JobRunner& runner);

}  // namespace meshbound
