// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <string_view>

#include "mesh/mesh_source.h"
#include "meshbound/io.h"

namespace meshbound {

/// `read_mesh` for the content of a file, without access to the file system; the name decides the format.
[[nodiscard]] MeshFile parse_mesh(const std::filesystem::path& path, std::string_view bytes,
                                  const ReadOptions& options = {});

// One reader per format. Each throws `InvalidInput` for what is malformed; see `read_mesh`.
[[nodiscard]] MeshFile read_off(const MeshSource& source);
[[nodiscard]] MeshFile read_obj(const MeshSource& source);
[[nodiscard]] MeshFile read_ply(const MeshSource& source);
[[nodiscard]] MeshFile read_stl(const MeshSource& source);
[[nodiscard]] MeshFile read_gltf(const MeshSource& source);

}  // namespace meshbound
