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

/// As `read_mesh` without attributes; `into` takes the mesh, and the `MeshFile` has none. Binary PLY and STL are read
/// with little in memory (of STL the positions of all vertices), of other files all bytes. `reader` gets all bytes.
[[nodiscard]] MeshFile read_mesh_into(const std::filesystem::path& path, const StopToken& stop, MeshInSpace& into,
                                      const FileWindow::Reader& reader = {});
/// Reads the bytes of a file as `parse_mesh` does, without attributes, into `into`.
[[nodiscard]] MeshFile parse_mesh_into(const std::filesystem::path& path, std::string_view bytes, const StopToken& stop,
                                       MeshInSpace& into);

/// Whether a file of this size that begins with `start`, 84 bytes or the whole file, is a binary STL.
[[nodiscard]] bool is_binary_stl(std::string_view start, std::size_t size);

// One reader per format. Each throws `InvalidInput` for what is malformed; see `read_mesh`.
[[nodiscard]] MeshFile read_off(const MeshSource& source);
[[nodiscard]] MeshFile read_obj(const MeshSource& source);
[[nodiscard]] MeshFile read_ply(const MeshSource& source);
[[nodiscard]] MeshFile read_stl(const MeshSource& source);
[[nodiscard]] MeshFile read_gltf(const MeshSource& source);

}  // namespace meshbound
