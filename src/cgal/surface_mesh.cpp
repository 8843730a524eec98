// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshbound/cgal/surface_mesh.h"

#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "cgal/manifold_polygons.h"
#include "cgal/oriented_manifold.h"

namespace meshbound::cgal {
namespace {

namespace PMP = CGAL::Polygon_mesh_processing;
using Point = Kernel::Point_3;

Point to_point(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

/// For each vertex the first one, in order of index, that has its coordinates. -0 and 0 are equal.
std::vector<std::uint32_t> first_of_equal_vertices(const std::vector<Eigen::Vector3d>& vertices) {
  std::vector<std::uint32_t> order(vertices.size()), first(vertices.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](std::uint32_t v) { return std::tuple(vertices[v].x(), vertices[v].y(), vertices[v].z(), v); };
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool repeats = i > 0 && vertices[order[i]] == vertices[order[i - 1]];
    first[order[i]] = repeats ? first[order[i - 1]] : order[i];
  }
  return first;
}

/// Triangles with three different corners, each set of corners once: indices into `triangles`, ascending.
std::vector<std::uint32_t> distinct_triangles(const std::vector<Triangle>& triangles) {
  const auto key = [&](std::uint32_t t) {
    Triangle corners = triangles[t];
    std::sort(corners.begin(), corners.end());
    return corners;
  };
  std::vector<std::pair<Triangle, std::uint32_t>> keyed;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const Triangle corners = key(t);
    if (corners[0] != corners[1] && corners[1] != corners[2]) keyed.emplace_back(corners, t);
  }
  std::sort(keyed.begin(), keyed.end());
  std::vector<std::uint32_t> kept;
  for (std::size_t i = 0; i < keyed.size(); ++i) {
    if (i == 0 || keyed[i].first != keyed[i - 1].first) kept.push_back(keyed[i].second);
  }
  std::sort(kept.begin(), kept.end());
  return kept;
}

}  // namespace

SurfaceMesh to_surface_mesh(const TriangleMesh& mesh) {
  SurfaceMesh result;
  for (const Eigen::Vector3d& p : mesh.vertices) result.add_vertex(to_point(p));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& corners = mesh.triangles[t];
    const auto face = result.add_face(SurfaceMesh::Vertex_index(corners[0]), SurfaceMesh::Vertex_index(corners[1]),
                                      SurfaceMesh::Vertex_index(corners[2]));
    if (face == SurfaceMesh::null_face())
      throw InvalidInput("triangle " + std::to_string(t) +
                         " does not fit a 2-manifold with those before it; use manifold_copy to split the mesh");
  }
  return result;
}

ManifoldPolygons manifold_polygons(const TriangleMesh& soup) {
  const std::vector<std::uint32_t> first = first_of_equal_vertices(soup.vertices);
  std::vector<Triangle> welded = soup.triangles;
  for (Triangle& corners : welded) {
    for (std::uint32_t& v : corners) v = first[v];
  }
  ManifoldPolygons copy;
  copy.triangle_of_face = distinct_triangles(welded);
  copy.dropped_triangles = soup.triangles.size() - copy.triangle_of_face.size();
  if (copy.triangle_of_face.empty())
    throw InvalidInput("there is no surface to simplify: every triangle has two equal corners");

  constexpr std::uint32_t unused = 0xffffffff;
  std::vector<std::uint32_t> compact(soup.vertices.size(), unused);
  std::vector<Point>& points = copy.points;
  std::vector<Polygon>& polygons = copy.polygons;
  polygons.reserve(copy.triangle_of_face.size());
  for (const std::uint32_t t : copy.triangle_of_face) {
    Polygon polygon{};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t v = welded[t][i];
      if (compact[v] == unused) {
        compact[v] = static_cast<std::uint32_t>(points.size());
        points.push_back(to_point(soup.vertices[v]));
        copy.vertex_of_vertex.push_back(v);
      }
      polygon[i] = compact[v];
    }
    polygons.push_back(polygon);
  }
  if (!is_oriented_manifold(polygons, points.size())) {
    copy.split = true;
    const std::size_t before = points.size();
    PMP::orient_polygon_soup(points, polygons);
    // Duplicates are appended; each has a corner in a polygon whose other copy of the soup we know.
    copy.vertex_of_vertex.resize(points.size(), unused);
    for (std::size_t f = 0; f < polygons.size() && points.size() > before; ++f) {
      const Triangle& corners = welded[copy.triangle_of_face[f]];
      for (const std::size_t v : polygons[f]) {
        if (copy.vertex_of_vertex[v] != unused) continue;
        for (const std::uint32_t corner : corners) {
          if (to_point(soup.vertices[corner]) == points[v]) copy.vertex_of_vertex[v] = corner;
        }
      }
    }
    if (!is_oriented_manifold(polygons, points.size()))
      throw InvalidInput("the triangles cannot be arranged as a 2-manifold, which decimation needs; repair the mesh");
  }
  return copy;
}

SurfaceMesh to_surface_mesh(const std::vector<Kernel::Point_3>& points, const std::vector<Polygon>& polygons) {
  SurfaceMesh mesh;
  PMP::polygon_soup_to_polygon_mesh(points, polygons, mesh);
  if (mesh.number_of_faces() != polygons.size() || mesh.number_of_vertices() != points.size())
    throw InvalidInput("the triangles cannot be arranged as a 2-manifold, which decimation needs; repair the mesh");
  return mesh;
}

ManifoldCopy to_manifold_copy(ManifoldPolygons polygons) {
  ManifoldCopy copy;
  copy.mesh = to_surface_mesh(polygons.points, polygons.polygons);
  copy.triangle_of_face = std::move(polygons.triangle_of_face);
  copy.vertex_of_vertex = std::move(polygons.vertex_of_vertex);
  copy.dropped_triangles = polygons.dropped_triangles;
  copy.split = polygons.split;
  return copy;
}

ManifoldCopy manifold_copy(const TriangleMesh& soup) { return to_manifold_copy(manifold_polygons(soup)); }

}  // namespace meshbound::cgal
