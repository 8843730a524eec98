// SPDX-License-Identifier: MIT
#pragma once
#include <atomic>
#include <cstddef>
#include <filesystem>

#include "meshbound/attributes.h"
#include "meshbound/error.h"
#include "meshbound/stop_token.h"
#include "meshbound/triangle_mesh.h"

namespace meshbound {

/// The formats that are read and written. `Gltf` is glTF 2 as a text, `Glb` glTF 2 in one binary file.
enum class FileFormat { Off, Obj, Ply, Stl, Gltf, Glb };

/// From the extension of `path`, upper or lower case. Throws `InvalidInput` when it is none of ours.
[[nodiscard]] FileFormat format_of(const std::filesystem::path& path);

/// What a file tells about its mesh beyond the triangles. A `TriangleMesh` does not hold it, so whoever writes the mesh
/// again loses it. Counts of what stands in the file, used by a face or not.
struct DroppedAttributes {
  std::size_t texture_coordinates = 0;  ///< `vt` (OBJ), and vertices or corners with such coordinates
  std::size_t normals = 0;              ///< other than the facet normals of STL, which follow from the corners
  std::size_t colours = 0;              ///< of vertices and faces; OBJ does not carry an opacity other than 1
  std::size_t materials = 0;            ///< names in `usemtl`, or libraries where there are none; texture files (PLY)
  std::size_t groups = 0;               ///< names of groups and objects (OBJ); solids where a file has several (STL)
  std::size_t smoothing_groups = 0;     ///< OBJ
  std::size_t facet_attributes = 0;     ///< binary STL: facets whose attribute bytes are not 0
  std::size_t other_properties = 0;     ///< PLY and glTF: properties of any other name, once each
  std::size_t scene_objects = 0;        ///< glTF: textures, cameras, lights, animations, skins
  std::size_t other_elements = 0;       ///< `MeshFile::ignored_elements`, where no `MeshAttributes::document` has them

  [[nodiscard]] bool operator==(const DroppedAttributes&) const = default;  ///< equality of all counts
};

/// A mesh as read, and what the reader had to do to make triangles of it.
struct MeshFile {
  TriangleMesh mesh;                      ///< model units, as in the file
  std::size_t triangulated_polygons = 0;  ///< faces of more than three corners, split into triangles
  std::size_t decoded_strips = 0;         ///< triangle strips and fans (PLY `tristrips`, glTF)
  std::size_t ignored_elements = 0;       ///< faces of fewer than three corners, lines and points
  DroppedAttributes dropped;              ///< what the file holds beyond `mesh` and `attributes`
  std::size_t rest_pose_parts = 0;        ///< glTF: primitives with a skin or morph targets, read without these
  MeshAttributes attributes;              ///< when they were asked for
};

/// How a file is read.
struct ReadOptions {
  const std::atomic<bool>* cancel = nullptr;  ///< reading ends with `Interrupted` soon after this is set; not owned
  /// Reading ends with `Stopped` soon after this point in time; the largest one: never.
  StopToken::Clock::time_point deadline = StopToken::Clock::time_point::max();
  bool attributes = false;  ///< read `MeshFile::attributes`, too
};

/// Reads OFF, OBJ, PLY (ascii, binary of either byte order, float and double), STL (ascii, binary; corners welded by
/// exact coordinates) or glTF 2 (.glb, .gltf). Polygons are split into fans from their first corner. Degenerate and
/// duplicate triangles are kept. Of glTF it is the default scene that is read, as it stands there in rest: all
/// triangles of its meshes, each placed by its node (a mesh of several nodes several times), without skins and morph
/// targets; a placed vertex is the float of the file under the matrix of the node, computed in doubles, and corners of
/// a node are welded by exact coordinates. Throws `IoError` when the file cannot be read, `Interrupted` and `Stopped`
/// as the options say, `InvalidInput` with path, line or byte offset and defect when it is malformed, holds no faces, a
/// non-finite used coordinate or an index out of range. O(size), one pass, never allocates more than the file can
/// justify.
[[nodiscard]] MeshFile read_mesh(const std::filesystem::path& path, const ReadOptions& options = {});

/// How a file is written.
struct WriteOptions {
  bool ascii = false;             ///< PLY and STL: text instead of binary
  bool single_precision = false;  ///< every coordinate is rounded to a float, as it always is in STL; PLY stores floats
  const std::atomic<bool>* cancel = nullptr;  ///< writing ends with `Interrupted` soon after this is set; not owned
  /// Writing ends with `Stopped` soon after this point in time; the largest one: never.
  StopToken::Clock::time_point deadline = StopToken::Clock::time_point::max();
};

/// The mesh that `read_mesh` gives back after `write_mesh` without attributes, bit for bit: coordinates rounded to the
/// precision of the file format; for STL and glTF vertices welded, numbered as the triangles reach them, unused ones
/// dropped. The order of triangles is kept. Throws `InvalidInput` when a coordinate leaves the range of float or
/// `validate` refuses the mesh. O(n).
[[nodiscard]] TriangleMesh rounded_for(const std::filesystem::path& path, const TriangleMesh& mesh,
                                       const WriteOptions& options = {});

/// Writes the mesh, and those of its attributes that the format carries (`carried_by`), to a temporary name in the same
/// folder, then renames: `path` either keeps what it had or holds the whole
/// mesh. Symbolic links are followed, also to a file that is not there yet; a file that is replaced leaves its
/// permissions to the new one; devices and FIFOs are written to as they are. Throws `IoError` (also when the disk is
/// full, and for a file that grants writing to nobody, whoever asks), `InvalidInput` for an unknown extension, for
/// attributes of another number of triangles and where `rounded_for` does, `Interrupted` and `Stopped` as the options
/// say; nothing is written then. O(n). Safe to call from several threads, as is all of this header.
void write_mesh(const std::filesystem::path& path, const TriangleMesh& mesh, const WriteOptions& options = {},
                const MeshAttributes& attributes = {});

/// The attributes that files of this format carry, texture coordinates as precisely as such files hold them; `lost` is
/// increased by what the others held, in the counts of `MeshFile::dropped`. O(n).
[[nodiscard]] MeshAttributes carried_by(FileFormat format, MeshAttributes attributes, DroppedAttributes& lost);

/// Whether files of this format are read and written with any `MeshAttributes`: all but STL, of which only text is,
/// with its solids as `groups`.
[[nodiscard]] bool carries_attributes(FileFormat format);

}  // namespace meshbound
