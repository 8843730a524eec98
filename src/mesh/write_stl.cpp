// SPDX-License-Identifier: MIT
#include <Eigen/Geometry>
#include <array>
#include <string>

#include "mesh/no_value.h"
#include "mesh/round_to_floats.h"
#include "mesh/stl_layout.h"
#include "mesh/writers.h"
#include "mesh/written_name.h"

namespace meshbound {
namespace {

using FacetCorners = std::array<Eigen::Vector3d, 3>;

FacetCorners rounded_corners(const TriangleMesh& mesh, const Triangle& t) {
  return {rounded_to_float(mesh.vertices[t[0]]), rounded_to_float(mesh.vertices[t[1]]),
          rounded_to_float(mesh.vertices[t[2]])};
}

/// Unit normal, or zero for a triangle without one. The corners are floats, so nothing can overflow in double.
Eigen::Vector3d normal_of(const FacetCorners& c) { return (c[1] - c[0]).cross(c[2] - c[0]).stableNormalized(); }

std::string name_of_solid(const TriangleLabels& groups, std::size_t t) {
  const bool has_name = !groups.empty() && groups.index[t] != no_value && !groups.names[groups.index[t]].empty();
  return has_name ? name_on_a_line(groups.names[groups.index[t]]) : name_of_unnamed_solid;
}

void write_text(AtomicFile& file, const TriangleMesh& mesh, const TriangleLabels& groups) {
  std::string solid;  // the open one
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (t == 0 || (!groups.empty() && groups.index[t] != groups.index[t - 1])) {
      if (t > 0) file.write("endsolid " + solid + "\n");
      solid = name_of_solid(groups, t);
      file.write("solid " + solid + "\n");
    }
    const FacetCorners corners = rounded_corners(mesh, mesh.triangles[t]);
    file.write("facet normal ");
    put(file, rounded_to_float(normal_of(corners)), '\n');
    file.write("outer loop\n");
    for (const Eigen::Vector3d& p : corners) {
      file.write("vertex ");
      put(file, p, '\n');
    }
    file.write("endloop\nendfacet\n");
  }
  file.write("endsolid " + solid + "\n");
}

void put_floats(AtomicFile& file, const Eigen::Vector3d& p) {
  for (const double x : p) put_little_endian(file, static_cast<float>(x));
}

void write_header(AtomicFile& file, const TriangleMesh& mesh) {
  std::string header = "binary STL by meshbound";  // must not start with "solid"
  header.resize(stl_count_offset);
  file.write(header);
  put_little_endian(file, static_cast<std::uint32_t>(mesh.triangles.size()));
}

void write_records(AtomicFile& file, const TriangleMesh& mesh, const FileShare& share) {
  for (std::size_t i = share.begin(mesh.triangles.size()); i < share.end(mesh.triangles.size()); ++i) {
    const FacetCorners corners = rounded_corners(mesh, mesh.triangles[i]);
    put_floats(file, normal_of(corners));
    for (const Eigen::Vector3d& p : corners) put_floats(file, p);
    put_little_endian(file, std::uint16_t{0});
  }
}

}  // namespace

void write_stl(AtomicFile& file, const TriangleMesh& mesh, const WriteOptions& options,
               const MeshAttributes& attributes) {
  if (options.ascii) {
    write_text(file, mesh, attributes.groups);
  } else {
    write_header(file, mesh);
    write_records(file, mesh, {});
  }
}

void write_stl_share(AtomicFile& file, const TriangleMesh& mesh, const FileShare& share) {
  if (share.index == 0) write_header(file, mesh);
  file.seek(stl_records_offset + share.begin(mesh.triangles.size()) * stl_record_size);
  write_records(file, mesh, share);
}

}  // namespace meshbound
