// SPDX-License-Identifier: MIT

#include "mesh/split_vertices.h"
#include "mesh/writers.h"
#include "numeric/numbers_below.h"

namespace meshbound {
namespace {

/// Red, green, blue and opacity, all from 0 to 1; white where a vertex has no colour.
void put_colour(AtomicFile& file, const NamedAttribute& colours, std::uint32_t value) {
  for (std::size_t k = 0; k < 4; ++k) {
    const bool has_number = value != CornerAttribute::none && k < colours.width;
    // Whole numbers get a decimal point, by which readers tell the range 0 to 1 from 0 to 255.
    const double number = has_number ? colours.values[value * colours.width + k] : 1;
    if (number == 0 || number == 1)
      file.write(number == 0 ? (k == 3 ? "0.0\n" : "0.0 ") : (k == 3 ? "1.0\n" : "1.0 "));
    else
      put(file, number, k == 3 ? '\n' : ' ');
  }
}

void put_triangles(AtomicFile& file, const std::vector<Triangle>& triangles) {
  for (const Triangle& t : triangles) {
    file.write("3 ");
    put(file, t[0], ' ');
    put(file, t[1], ' ');
    put(file, t[2], '\n');
  }
}

void put_counts(AtomicFile& file, std::size_t vertices, std::size_t triangles) {
  put(file, vertices, ' ');
  put(file, triangles, ' ');
  file.write("0\n");
}

void write_coloured(AtomicFile& file, const TriangleMesh& mesh, const NamedAttribute& colours) {
  const SplitVertices split = split_vertices(mesh, numbers_below(mesh.triangles.size()), {&colours.index});
  file.write("COFF\n");
  put_counts(file, split.corners.size(), mesh.triangles.size());
  for (std::size_t v = 0; v < split.corners.size(); ++v) {
    put(file, mesh.vertices[split.source(mesh, v)], ' ');
    put_colour(file, colours, split.value(colours.index, v));
  }
  put_triangles(file, split.triangles);
}

}  // namespace

void write_off(AtomicFile& file, const TriangleMesh& mesh, const MeshAttributes& attributes) {
  if (const NamedAttribute* const colours = colours_of(attributes)) return write_coloured(file, mesh, *colours);
  file.write("OFF\n");
  put_counts(file, mesh.vertices.size(), mesh.triangles.size());
  for (const Eigen::Vector3d& p : mesh.vertices) put(file, p, '\n');
  put_triangles(file, mesh.triangles);
}

}  // namespace meshbound
