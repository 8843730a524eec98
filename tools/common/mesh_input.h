// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <memory>
#include <string>

#include "common/tile_workers.h"
#include "meshbound/io.h"
#include "meshbound/report.h"
#include "meshbound/stop_token.h"

namespace meshbound::tools {

struct InputFile {
  MeshFile content;
  std::string sha256;  ///< of the bytes that were parsed; empty: not computed
};

/// Whether the extension is one of those that `format_of` knows.
[[nodiscard]] bool has_mesh_extension(const std::filesystem::path& path);

/// `read_mesh` for a tool. Throws `Interrupted` or `Stopped` as `stop` says.
[[nodiscard]] InputFile read_file(const std::string& path, bool with_checksum, const StopToken& stop,
                                  bool with_attributes = false);

/// What the reports say of a mesh that was read; `sha256` is that of its file.
[[nodiscard]] MeshReport report_of(const std::string& path, const MeshFile& content, const MeshSummary& summary,
                                   std::string sha256);

/// The mesh of `read_file`; `report` says what was read, `attributes` (null: not wanted) what goes with it.
[[nodiscard]] TriangleMesh read_input(const std::string& path, bool with_checksum, MeshReport& report,
                                      const StopToken& stop, MeshAttributes* attributes = nullptr);

/// As `read_input` for a mesh that workers are to keep, in their space.
[[nodiscard]] std::unique_ptr<StoredMesh> read_stored_input(const std::string& path, bool with_checksum,
                                                            MeshReport& report, const StopToken& stop,
                                                            TileWorkers& workers);

}  // namespace meshbound::tools
