// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>
#include <string>

#include "mesh/attribute_check.h"
#include "mesh/round_to_floats.h"
#include "mesh/weld.h"
#include "mesh/writers.h"
#include "meshbound/error.h"
#include "meshbound/io.h"
#include "meshbound/mesh_view.h"

namespace meshbound {
namespace {

void refuse_beyond_float(const std::filesystem::path& path, const TriangleMesh& mesh) {
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    for (const double x : mesh.vertices[i])
      if (std::isfinite(x) && !std::isfinite(static_cast<float>(x)))
        throw InvalidInput(path.string() + ": vertex " + std::to_string(i) +
                           " has a coordinate beyond the range of float; write doubles (OFF, OBJ, PLY) or rescale");
  }
}

void refuse_unwritable(const std::filesystem::path& path, FileFormat format, const TriangleMesh& mesh,
                       const WriteOptions& options) {
  try {
    validate(mesh);
  } catch (const InvalidInput& defect) {
    throw InvalidInput(path.string() + ": not written: " + defect.what());
  }
  if (stores_floats(format, options)) refuse_beyond_float(path, mesh);
  if (format == FileFormat::Stl && !options.ascii && mesh.triangles.size() > std::numeric_limits<std::uint32_t>::max())
    throw InvalidInput(path.string() + ": a binary STL holds at most 2^32-1 triangles; write PLY");
}

/// Whether the reader of a format makes vertices at equal positions one and drops those that no triangle uses.
bool is_welded_when_read(FileFormat format) {
  return format == FileFormat::Stl || format == FileFormat::Gltf || format == FileFormat::Glb;
}

/// Vertices at equal positions become one, in the order the triangles reach them, as these readers do.
TriangleMesh welded(const TriangleMesh& mesh) {
  TriangleMesh result;
  result.triangles.reserve(mesh.triangles.size());
  Welder welder;
  for (const Triangle& t : mesh.triangles) {
    Triangle& corners = result.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d& p = mesh.vertices[t[k]];
      corners[k] = welder.index_of(p);
      if (corners[k] == result.vertices.size()) result.vertices.push_back(p);
    }
  }
  return result;
}

}  // namespace

bool stores_floats(FileFormat format, const WriteOptions& options) {
  return format == FileFormat::Stl || format == FileFormat::Gltf || format == FileFormat::Glb ||
         options.single_precision;
}

TriangleMesh rounded_for(const std::filesystem::path& path, const TriangleMesh& mesh, const WriteOptions& options) {
  const FileFormat format = format_of(path);
  refuse_unwritable(path, format, mesh, options);
  TriangleMesh result = mesh;
  if (stores_floats(format, options)) round_to_floats(result);
  return is_welded_when_read(format) ? welded(result) : result;
}

void write_mesh(AtomicFile& file, const std::filesystem::path& path, const TriangleMesh& mesh,
                const WriteOptions& options, const MeshAttributes& attributes) {
  const FileFormat format = format_of(path);
  refuse_unwritable(path, format, mesh, options);
  check_attributes(attributes, mesh.triangles.size());
  if (options.single_precision && (format == FileFormat::Off || format == FileFormat::Obj)) {
    WriteOptions as_they_are = options;
    as_they_are.single_precision = false;
    return write_mesh(file, path, rounded_for(path, mesh, options), as_they_are, attributes);
  }
  switch (format) {
    case FileFormat::Off:
      return write_off(file, mesh, attributes);
    case FileFormat::Obj:
      return write_obj(file, mesh, attributes);
    case FileFormat::Ply:
      return write_ply(file, mesh, options, attributes);
    case FileFormat::Stl:
      return write_stl(file, mesh, options, attributes);
    case FileFormat::Gltf:
    case FileFormat::Glb:
      return write_gltf(file, format, mesh, attributes);
  }
}

bool is_written_in_shares(const std::filesystem::path& path, const WriteOptions& options) {
  const FileFormat format = format_of(path);
  return !options.ascii && (format == FileFormat::Ply || format == FileFormat::Stl);
}

void write_share(AtomicFile& file, const std::filesystem::path& path, const TriangleMesh& mesh,
                 const WriteOptions& options, const FileShare& share) {
  const FileFormat format = format_of(path);
  refuse_unwritable(path, format, mesh, options);
  if (format == FileFormat::Stl)
    write_stl_share(file, mesh, share);
  else
    write_ply_share(file, mesh, options, share);
}

void write_mesh(const std::filesystem::path& path, const TriangleMesh& mesh, const WriteOptions& options,
                const MeshAttributes& attributes) {
  (void)format_of(path);  // an unknown extension is the better message where both are wrong
  AtomicFile file(path, AtomicFile::Stream::Direct, {options.deadline, options.cancel});
  write_mesh(file, path, mesh, options, attributes);
  file.commit();
}

}  // namespace meshbound
