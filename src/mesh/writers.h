// SPDX-License-Identifier: MIT
#pragma once
#include <bit>
#include <charconv>

#include "mesh/atomic_file.h"
#include "mesh/file_share.h"
#include "meshbound/io.h"
#include "numeric/byte_order.h"

namespace meshbound {

struct GltfContent;

/// `write_mesh` into a file that the caller commits, in the format that the extension of `path` names.
void write_mesh(AtomicFile& file, const std::filesystem::path& path, const TriangleMesh& mesh,
                const WriteOptions& options, const MeshAttributes& attributes = {});

/// Whether a file of this format has coordinates that are floats.
[[nodiscard]] bool stores_floats(FileFormat format, const WriteOptions& options);

/// Whether several processes can write a mesh without attributes together: as binary PLY or STL.
[[nodiscard]] bool is_written_in_shares(const std::filesystem::path& path, const WriteOptions& options);
/// Writes a share of what `write_mesh` does for such a mesh, where it belongs in the file.
void write_share(AtomicFile& file, const std::filesystem::path& path, const TriangleMesh& mesh,
                 const WriteOptions& options, const FileShare& share);

// One writer per format, for a mesh that `write_mesh` has found to be valid and within the range of the format.
void write_off(AtomicFile& file, const TriangleMesh& mesh, const MeshAttributes& attributes);
void write_obj(AtomicFile& file, const TriangleMesh& mesh, const MeshAttributes& attributes);
void write_ply(AtomicFile& file, const TriangleMesh& mesh, const WriteOptions& options,
               const MeshAttributes& attributes);
void write_ply_share(AtomicFile& file, const TriangleMesh& mesh, const WriteOptions& options, const FileShare& share);
/// As text with a solid for each run of triangles in one group.
void write_stl(AtomicFile& file, const TriangleMesh& mesh, const WriteOptions& options,
               const MeshAttributes& attributes);
void write_stl_share(AtomicFile& file, const TriangleMesh& mesh, const FileShare& share);
void write_gltf(AtomicFile& file, FileFormat format, const TriangleMesh& mesh, const MeshAttributes& attributes);
void write_gltf(AtomicFile& file, FileFormat format, GltfContent content);

/// Writes a number and then the character `after`: an integer, or the shortest decimal that reads back as the same
/// double (at most 17 digits).
template <class Number>
void put(AtomicFile& file, Number value, char after) {
  constexpr std::size_t longest = 32;  // characters: sign, 17 digits, point, exponent
  char* const from = file.room(longest);
  char* const to = std::to_chars(from, from + longest - 1, value).ptr;
  *to = after;
  file.use(to + 1);
}

inline void put(AtomicFile& file, const Eigen::Vector3d& p, char after) {
  put(file, p.x(), ' ');
  put(file, p.y(), ' ');
  put(file, p.z(), after);
}

template <class T>
void put_little_endian(AtomicFile& file, T value) {
  char* const to = file.room(sizeof(T));
  store_number(value, to, std::endian::little);
  file.use(to + sizeof(T));
}

}  // namespace meshbound
