// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "decimation/decimation_options.h"
#include "mesh/stored_mesh.h"
#include "meshbound/attributes.h"
#include "meshbound/line_mesh.h"
#include "meshbound/report.h"
#include "meshbound/stop_token.h"
#include "meshbound/triangle_mesh.h"

namespace meshbound::tools {

/// A mesh to decimate, as it was read.
struct Original {
  TriangleMesh mesh;                   ///< empty where there are workers on tiles
  std::unique_ptr<StoredMesh> stored;  ///< for these
  MeshAttributes attributes;           ///< as outputs carry them
  /// Texture coordinates and materials as IN has them, which what was written is compared with: where its texture is
  /// bounded.
  MeshAttributes texture_as_read;
  std::vector<Edge> feature_edges;   ///< seams of the attributes, and the edges of --feature-edges
  std::vector<std::uint32_t> looks;  ///< by triangle, see `SimplifyOptions::looks`
  double diagonal = 0;
  double rounding = 0;  ///< what the frames of nodes may move vertices by, model units
};

/// Reads and validates the input; its checksum is computed where a document is to name it. Attributes come along where
/// files like `output` carry them. Throws `Stopped` as `stop` says.
[[nodiscard]] Original read_original(const DecimationOptions& options, const std::filesystem::path& output,
                                     bool with_checksum, const StopToken& stop, MeshReport& report);

}  // namespace meshbound::tools
