// SPDX-License-Identifier: MIT
#include "meshbound/mesh_view.h"

#include <cmath>
#include <cstring>
#include <string>

#include "meshbound/error.h"

namespace meshbound {
namespace {

/// False for NaN, as every comparison with it is.
bool usable(const Eigen::Vector3d& p) {
  return std::abs(p.x()) <= largest_coordinate && std::abs(p.y()) <= largest_coordinate &&
         std::abs(p.z()) <= largest_coordinate;
}

bool all_usable(const MeshView& view) {
  bool all = true;
  for (std::size_t i = 0; i < view.vertex_count(); ++i) all = all && usable(view.vertex(i));
  return all;
}

}  // namespace

std::size_t MeshView::triples(std::size_t size, const char* what) {
  if (size % 3 != 0)
    throw InvalidInput("a mesh view of " + std::to_string(size) + " " + what +
                       ": the number must be a multiple of three");
  return size / 3;
}

MeshView::MeshView(const TriangleMesh& mesh)
    : MeshView(reinterpret_cast<const double*>(mesh.vertices.data()), mesh.vertices.size(), sizeof(Eigen::Vector3d),
               reinterpret_cast<const std::uint32_t*>(mesh.triangles.data()), mesh.triangles.size()) {}

TriangleMesh to_triangle_mesh(const MeshView& view) {
  TriangleMesh mesh;
  mesh.vertices.resize(view.vertex_count());
  mesh.triangles.resize(view.triangle_count());
  for (std::size_t i = 0; i < view.vertex_count(); ++i) mesh.vertices[i] = view.vertex(i);
  for (std::size_t i = 0; i < view.triangle_count(); ++i) mesh.triangles[i] = view.triangle(i);
  return mesh;
}

void validate(const MeshView& view) {
  if (view.triangle_count() == 0) throw InvalidInput("the mesh has no triangles: nothing to measure");
  // Checks each vertex once instead of each corner. Only where a vertex is unusable does it matter whether a triangle
  // uses it.
  const bool check_corners = !all_usable(view);
  for (std::size_t i = 0; i < view.triangle_count(); ++i) {
    for (const std::uint32_t v : view.triangle(i)) {
      if (v >= view.vertex_count())
        throw InvalidInput("triangle " + std::to_string(i) + " refers to vertex " + std::to_string(v) +
                           ", but there are only " + std::to_string(view.vertex_count()));
      if (check_corners && !usable(view.vertex(v)))
        throw InvalidInput("vertex " + std::to_string(v) + " of triangle " + std::to_string(i) +
                           " has a coordinate that is not finite or is beyond 2^1000; repair or rescale the mesh");
    }
  }
}

}  // namespace meshbound
