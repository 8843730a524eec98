// SPDX-License-Identifier: MIT
#include "deviation/display_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include "deviation/rounded_point.h"
#include "mesh/first_use.h"
#include "meshbound/mesh_summary.h"
#include "meshbound/transform.h"
#include "numeric/sort_unique.h"

namespace meshbound::tools {
namespace {

using Eigen::Vector3d;

/// For each vertex the vertex that represents its cell, in a grid of `cells` cells along the longest side of the box.
std::vector<std::uint32_t> clusters(const TriangleMesh& mesh, const std::vector<Bounds>& vertices,
                                    const Eigen::AlignedBox3d& box, double cells) {
  const double cell = box.sizes().maxCoeff() / cells;
  std::unordered_map<std::uint64_t, std::uint32_t> furthest;
  std::vector<std::uint64_t> keys(mesh.vertices.size());
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    std::uint64_t key = 0;
    for (int k = 0; k < 3; ++k) {
      const double at = (mesh.vertices[v][k] - box.min()[k]) / cell;
      constexpr double max_cell = 0x1p20;
      key = (key << 21) | static_cast<std::uint64_t>(at >= 0 && at <= max_cell ? at : 0);
    }
    keys[v] = key;
    const auto [found, is_new] = furthest.try_emplace(key, v);
    if (!is_new && vertices[v].upper > vertices[found->second].upper) found->second = v;
  }
  std::vector<std::uint32_t> representative(mesh.vertices.size());
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) representative[v] = furthest[keys[v]];
  return representative;
}

/// The triangles whose corners stand for three different vertices, without repetitions.
std::vector<Triangle> between_clusters(const TriangleMesh& mesh, const std::vector<std::uint32_t>& representative) {
  std::vector<Triangle> triangles;
  for (const Triangle& t : mesh.triangles) {
    Triangle r{representative[t[0]], representative[t[1]], representative[t[2]]};
    if (r[0] == r[1] || r[1] == r[2] || r[2] == r[0]) continue;
    std::rotate(r.begin(), std::min_element(r.begin(), r.end()), r.end());
    triangles.push_back(r);
  }
  sort_unique(triangles);
  return triangles;
}

/// The triangles between clusters, and those of the mesh itself around a vertex that stands for its cluster and that
/// none of them reaches: the tip of a peak that is narrower than a cell.
std::vector<Triangle> clustered_triangles(const TriangleMesh& mesh, const std::vector<std::uint32_t>& representative) {
  std::vector<Triangle> triangles = between_clusters(mesh, representative);
  std::vector<bool> is_reached(mesh.vertices.size(), false);
  for (const Triangle& t : triangles)
    for (const std::uint32_t v : t) is_reached[v] = true;
  for (const Triangle& t : mesh.triangles)
    if (std::any_of(t.begin(), t.end(), [&](std::uint32_t v) { return representative[v] == v && !is_reached[v]; }))
      triangles.push_back(t);
  return triangles;
}

/// Keeps only the vertices that triangles use, with their deviations.
void take_used(const TriangleMesh& mesh, const std::vector<Bounds>& vertices, DisplayMesh& display) {
  FirstUse number(mesh.vertices.size());
  for (Triangle& t : display.mesh.triangles) t = number(t);
  for (const std::uint32_t v : number.used()) {
    display.mesh.vertices.push_back(mesh.vertices[v]);
    display.deviations.push_back(vertices[v]);
    display.errors.push_back(0);
  }
}

std::vector<Edge> edges_of(const std::vector<Triangle>& triangles) {
  std::vector<Edge> edges;
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k)
      edges.push_back({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])});
  sort_unique(edges);
  return edges;
}

DisplayMesh reduced(const TriangleMesh& mesh, const std::vector<Bounds>& vertices, std::size_t max_triangles,
                    const DeviationOptions& options) {
  DisplayMesh display;
  display.is_reduced = true;
  const Eigen::AlignedBox3d box = used_bounding_box(mesh);
  // A surface that fills its box has some 12 triangles for each cell of a side; most need a finer grid.
  double coarse = 1, fine = std::max(2.0, 2 * std::sqrt(static_cast<double>(max_triangles)));
  constexpr int steps = 8;
  for (int i = 0; i < steps; ++i) {
    options.stop.check();
    const double cells = std::floor((coarse + fine) / 2);
    std::vector<Triangle> triangles = clustered_triangles(mesh, clusters(mesh, vertices, box, cells));
    if (triangles.size() > max_triangles) {
      fine = cells;
    } else {
      coarse = cells;
      display.mesh.triangles = std::move(triangles);
    }
  }
  take_used(mesh, vertices, display);
  display.edges = edges_of(display.mesh.triangles);
  return display;
}

double longest_edge(const TriangleMesh& mesh, const Triangle& t) {
  double longest = 0;
  for (std::size_t k = 0; k < 3; ++k)
    longest = std::max(longest, (mesh.vertices[t[(k + 1) % 3]] - mesh.vertices[t[k]]).stableNorm());
  return longest;
}

/// Into how many parts the edges of each triangle are cut so that a part is at most `length` long.
std::vector<std::uint32_t> cuts(const TriangleMesh& mesh, double length) {
  constexpr double max_cuts = 64;
  std::vector<std::uint32_t> parts;
  parts.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles)
    parts.push_back(static_cast<std::uint32_t>(std::clamp(std::ceil(longest_edge(mesh, t) / length), 1.0, max_cuts)));
  return parts;
}

std::size_t triangles_after(const std::vector<std::uint32_t>& cuts) {
  std::size_t count = 0;
  for (const std::size_t n : cuts) count += n * n;
  return count;
}

/// Adds a triangle cut into n * n equal ones. Its corners are shared with neighbouring triangles, points between
/// corners are not.
void add_cut(DisplayMesh& display, const Triangle& t, std::uint32_t n) {
  TriangleMesh& mesh = display.mesh;
  const std::array<Vector3d, 3> corners = {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
  std::vector<std::uint32_t> number;  // row by row, from `a` to the edge b c
  for (std::uint32_t i = 0; i <= n; ++i) {
    for (std::uint32_t j = 0; j <= i; ++j) {
      if (i == 0 || (i == n && (j == 0 || j == n))) {
        number.push_back(i == 0 ? t[0] : j == 0 ? t[1] : t[2]);
        continue;
      }
      const double u = static_cast<double>(i - j) / n, v = static_cast<double>(j) / n;
      number.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
      const RoundedPoint point = rounded_point(corners, u, v);
      mesh.vertices.push_back(point.position);
      display.errors.push_back(point.error);
    }
  }
  const auto at = [&](std::uint32_t i, std::uint32_t j) { return number[i * (i + 1) / 2 + j]; };
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j <= i; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      if (j < i) mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
}

DisplayMesh refined(const TriangleMesh& whole, const std::vector<Bounds>& vertices, const Bvh& other,
                    std::size_t max_triangles, const DeviationOptions& options) {
  DisplayMesh used;
  used.mesh.triangles = whole.triangles;
  take_used(whole, vertices, used);
  const TriangleMesh& mesh = used.mesh;
  DisplayMesh display;
  double fine = 0, coarse = bounding_box_diagonal(mesh);  // no edge is longer
  std::vector<std::uint32_t> parts(mesh.triangles.size(), 1);
  constexpr int steps = 24;
  for (int i = 0; i < steps && coarse > 0; ++i) {
    const double length = (fine + coarse) / 2;
    std::vector<std::uint32_t> tried = cuts(mesh, length);
    if (triangles_after(tried) > max_triangles) {
      fine = length;
    } else {
      coarse = length;
      parts = std::move(tried);
    }
  }
  display.mesh.vertices = mesh.vertices;
  display.errors = used.errors;
  for (std::size_t t = 0; t < parts.size(); ++t) add_cut(display, mesh.triangles[t], parts[t]);
  display.edges = edges_of(mesh.triangles);
  display.deviations = display_deviations(display, other, options);
  return display;
}

/// As `display_mesh`, with a limit of triangles alone.
DisplayMesh of_at_most(std::size_t max_triangles, const TriangleMesh& mesh, const std::vector<Bounds>& vertices,
                       const Bvh& other, const DeviationOptions& options) {
  DisplayMesh display = mesh.triangles.size() > max_triangles ? reduced(mesh, vertices, max_triangles, options)
                                                              : refined(mesh, vertices, other, max_triangles, options);
  display.faces = mesh.triangles.size();
  return display;
}

}  // namespace

std::size_t packed_size(const DisplayMesh& display, std::size_t deviation_sets) {
  const std::size_t of_vertex = 3 * sizeof(float) + deviation_sets * sizeof(std::uint16_t);
  const std::size_t bytes = display.mesh.vertices.size() * of_vertex +
                            display.mesh.triangles.size() * sizeof(Triangle) + display.edges.size() * sizeof(Edge);
  return bytes / 3 * 4;  // in base64
}

DisplayMesh display_mesh(const TriangleMesh& mesh, const std::vector<Bounds>& vertices, const Bvh& other,
                         const DisplayLimits& limits, const DeviationOptions& options) {
  std::size_t max_triangles = limits.max_triangles;
  for (;;) {
    DisplayMesh display = of_at_most(max_triangles, mesh, vertices, other, options);
    const std::size_t size = packed_size(display, limits.deviation_sets);
    if (size <= limits.max_size || max_triangles == 0) return display;
    // Sizes do not shrink in proportion: a reduced mesh has as many edges as it shows, a refined one those of `mesh`.
    constexpr double margin = 0.95;
    const double share = margin * static_cast<double>(limits.max_size) / static_cast<double>(size);
    max_triangles = static_cast<std::size_t>(share * static_cast<double>(max_triangles));
  }
}

std::vector<Bounds> display_deviations(const DisplayMesh& display, const Bvh& other, const DeviationOptions& options) {
  std::vector<Bounds> deviations = vertex_deviations(display.mesh, other, options);
  for (std::size_t v = 0; v < deviations.size(); ++v) deviations[v] = widened(deviations[v], display.errors[v]);
  return deviations;
}

}  // namespace meshbound::tools
