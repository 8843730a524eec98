// SPDX-License-Identifier: MIT
#include <limits>
#include <string>

#include "mesh/writers.h"

namespace meshbound {
namespace {

std::string header_of(const TriangleMesh& mesh, const WriteOptions& options) {
  const std::string real = options.single_precision ? "float" : "double";
  const bool fits_int = mesh.vertices.size() <= std::numeric_limits<std::int32_t>::max();
  return std::string("ply\nformat ") + (options.ascii ? "ascii" : "binary_little_endian") + " 1.0\nelement vertex " +
         std::to_string(mesh.vertices.size()) + "\nproperty " + real + " x\nproperty " + real + " y\nproperty " + real +
         " z\nelement face " + std::to_string(mesh.triangles.size()) + "\nproperty list uchar " +
         (fits_int ? "int" : "uint") + " vertex_indices\nend_header\n";
}

void write_text(AtomicFile& file, const TriangleMesh& mesh, bool single_precision) {
  // Floats are printed as the doubles they are equal to, so that readers of either kind get the same number.
  for (const Eigen::Vector3d& p : mesh.vertices) put(file, single_precision ? rounded_to_float(p) : p, '\n');
  for (const Triangle& t : mesh.triangles) {
    file.write("3 ");
    put(file, t[0], ' ');
    put(file, t[1], ' ');
    put(file, t[2], '\n');
  }
}

void write_binary(AtomicFile& file, const TriangleMesh& mesh, bool single_precision) {
  for (const Eigen::Vector3d& p : mesh.vertices) {
    for (const double x : p) {
      if (single_precision) {
        put_little_endian(file, static_cast<float>(x));
      } else {
        put_little_endian(file, x);
      }
    }
  }
  for (const Triangle& t : mesh.triangles) {
    put_little_endian(file, std::uint8_t{3});
    for (const std::uint32_t v : t) put_little_endian(file, v);
  }
}

}  // namespace

void write_ply(AtomicFile& file, const TriangleMesh& mesh, const WriteOptions& options) {
  file.write(header_of(mesh, options));
  if (options.ascii) {
    write_text(file, mesh, options.single_precision);
  } else {
    write_binary(file, mesh, options.single_precision);
  }
}

}  // namespace meshbound
