// SPDX-License-Identifier: MIT
#include "attributes/seams.h"

#include <algorithm>
#include <string>

#include "geometry/position_table.h"
#include "mesh/mesh_arrays.h"
#include "meshbound/error.h"
#include "numeric/no_index.h"
#include "proof/edge_neighbours.h"

namespace meshbound {
namespace {

void check_size(std::size_t size, std::size_t triangles, const char* what) {
  if (size != 0 && size != triangles)
    throw InvalidInput(std::string(what) + " are given for " + std::to_string(size) + " triangles, but the mesh has " +
                       std::to_string(triangles));
}

bool is_equal(const CornerAttribute& attribute, std::uint32_t a, std::uint32_t b) {
  if (a == b) return true;
  if (a == CornerAttribute::none || b == CornerAttribute::none) return false;
  return attribute.values[a] == attribute.values[b];
}

/// The corner of a triangle at a position, given by its first vertex.
std::size_t corner_at(const Triangle& triangle, const std::vector<std::uint32_t>& first, std::uint32_t position) {
  for (std::size_t k = 0; k < 3; ++k)
    if (first[triangle[k]] == position) return k;
  return 0;
}

/// Whether two triangles differ along the edge of `t` from corner k to the next.
bool differ(const TriangleMesh& mesh, const MeshAttributes& attributes, const std::vector<std::uint32_t>& first,
            std::uint32_t t, std::size_t k, std::uint32_t other) {
  const auto& materials = attributes.materials.index;
  if (!materials.empty() && materials[t] != materials[other]) return true;
  const CornerAttribute& coordinates = attributes.texture_coordinates;
  if (coordinates.empty()) return false;
  for (const std::size_t corner : {k, (k + 1) % 3}) {
    const std::size_t there = corner_at(mesh.triangles[other], first, first[mesh.triangles[t][corner]]);
    if (!is_equal(coordinates, coordinates.index[t][corner], coordinates.index[other][there])) return true;
  }
  return false;
}

/// Numbers the components of the triangles that hang together across edges that are no seams.
void number_charts(Charts& charts) {
  const std::size_t triangles = charts.neighbours.size();
  charts.chart_of.assign(triangles, no_index);
  std::vector<std::uint32_t> open;
  for (std::uint32_t start = 0; start < triangles; ++start) {
    if (charts.chart_of[start] != no_index) continue;
    open.assign(1, start);
    charts.chart_of[start] = charts.count;
    while (!open.empty()) {
      const std::uint32_t t = open.back();
      open.pop_back();
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t other = charts.neighbours[t][k];
        if (other == no_index || charts.is_seam[t][k] != 0 || charts.chart_of[other] != no_index) continue;
        charts.chart_of[other] = charts.count;
        open.push_back(other);
      }
    }
    ++charts.count;
  }
}

}  // namespace

Charts charts(const TriangleMesh& mesh, const MeshAttributes& attributes) {
  const std::size_t triangles = mesh.triangles.size();
  check_size(attributes.texture_coordinates.index.size(), triangles, "texture coordinates");
  check_size(attributes.normals.index.size(), triangles, "normals");
  check_size(attributes.materials.index.size(), triangles, "materials");
  check_size(attributes.groups.index.size(), triangles, "groups");
  Charts result;
  const std::vector<Vec3> positions = positions_of(mesh);
  result.first = first_at_position(positions);
  result.neighbours = edge_neighbours(positions, mesh.triangles);
  result.is_seam.resize(triangles, {0, 0, 0});
  for (std::uint32_t t = 0; t < triangles; ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t other = result.neighbours[t][k];
      if (other != no_index && differ(mesh, attributes, result.first, t, k, other)) result.is_seam[t][k] = 1;
    }
  }
  number_charts(result);
  return result;
}

std::vector<Edge> seams(const TriangleMesh& mesh, const MeshAttributes& attributes) {
  const Charts all = charts(mesh, attributes);
  std::vector<Edge> edges;
  if (attributes.texture_coordinates.empty() && attributes.materials.empty()) return edges;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t other = all.neighbours[t][k];
      const bool is_line = other == no_index || (all.is_seam[t][k] != 0 && t < other);
      if (is_line) edges.push_back({mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]});
    }
  }
  return edges;
}

}  // namespace meshbound
