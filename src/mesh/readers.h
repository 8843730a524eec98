// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <optional>
#include <string_view>

#include "mesh/file_share.h"
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

/// What a file of which each share is read by itself holds.
struct MeshCounts {
  std::optional<std::size_t> vertices;  ///< absent in STL, where corners become vertices when they are compared
  std::size_t triangles = 0;
};

/// For a binary STL, and a binary PLY whose lists are all triangles as far as its size tells: what it holds. Nothing
/// for any other file, also for one that is damaged. Throws `IoError`.
[[nodiscard]] std::optional<MeshCounts> counts_for_shares(const std::filesystem::path& path, const StopToken& stop);

/// Gives `into` a share of the vertices and triangles of a file that has such counts: of a PLY as they are numbered
/// there, of an STL the vertices and triangles that `read_mesh_into` would find in these records alone. The `MeshFile`
/// tells of the whole, but `dropped.facet_attributes` of the share. Nothing where `read_mesh_into` must look at the
/// whole file, which may then be refused. Throws `IoError`, and as `stop` says.
[[nodiscard]] std::optional<MeshFile> read_share(const std::filesystem::path& path, const FileShare& share,
                                                 const StopToken& stop, MeshInSpace& into);

/// Whether a file of this size that begins with `start`, 84 bytes or the whole file, is a binary STL.
[[nodiscard]] bool is_binary_stl(std::string_view start, std::size_t size);

/// The parts of `counts_for_shares` and `read_share` for one format; these throw `InvalidInput` for what is malformed.
[[nodiscard]] std::optional<MeshCounts> ply_counts(const MeshSource& source);
[[nodiscard]] std::optional<MeshCounts> stl_counts(const MeshSource& source);
[[nodiscard]] std::optional<MeshFile> read_ply_share(const MeshSource& source, const FileShare& share);
[[nodiscard]] std::optional<MeshFile> read_stl_share(const MeshSource& source, const FileShare& share);

// One reader per format. Each throws `InvalidInput` for what is malformed; see `read_mesh`.
[[nodiscard]] MeshFile read_off(const MeshSource& source);
[[nodiscard]] MeshFile read_obj(const MeshSource& source);
[[nodiscard]] MeshFile read_ply(const MeshSource& source);
[[nodiscard]] MeshFile read_stl(const MeshSource& source);
[[nodiscard]] MeshFile read_gltf(const MeshSource& source);

}  // namespace meshbound
