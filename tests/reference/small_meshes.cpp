// SPDX-License-Identifier: MIT
#include "reference/small_meshes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <random>

namespace meshbound::reference {

using Eigen::Vector3d;

TriangleMesh soup(const std::vector<std::array<Vector3d, 3>>& triangles) {
  TriangleMesh mesh;
  for (const auto& t : triangles) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), t.begin(), t.end());
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

TriangleMesh single_triangle(const Vector3d& a, const Vector3d& b, const Vector3d& c) { return soup({{a, b, c}}); }

TriangleMesh unit_square(int n) {
  TriangleMesh mesh;
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) mesh.vertices.emplace_back(double(i) / n, double(j) / n, 0.0);
  }
  const auto at = [n](int i, int j) { return static_cast<std::uint32_t>(j * (n + 1) + i); };
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

TriangleMesh fan(std::uint32_t n) {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double angle = 2 * std::acos(-1.0) * i / n;
    mesh.vertices.emplace_back(std::cos(angle), std::sin(angle), 0);
    mesh.triangles.push_back({n, i, (i + 1) % n});
  }
  mesh.vertices.emplace_back(0, 0, 0);
  return mesh;
}

TriangleMesh needles(std::uint32_t n) {
  const Eigen::Quaterniond askew = Eigen::Quaterniond(3, 1, 2, 1).normalized();
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double angle = 2 * std::acos(-1.0) * i / n;
    for (const double end : {-10, 10})
      mesh.vertices.push_back(askew * Eigen::Vector3d(std::cos(angle), std::sin(angle), end));
    const std::uint32_t a = 2 * i, b = 2 * ((i + 1) % n);
    mesh.triangles.push_back({a, b, b + 1});
    mesh.triangles.push_back({a, b + 1, a + 1});
  }
  return mesh;
}

TriangleMesh cube(double half) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.emplace_back(i & 1 ? half : -half, i & 2 ? half : -half, i & 4 ? half : -half);
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

TriangleMesh subdivided(const TriangleMesh& mesh) {
  TriangleMesh result;
  result.vertices = mesh.vertices;
  std::map<std::array<std::uint32_t, 2>, std::uint32_t> midpoints;
  const auto midpoint = [&](std::uint32_t a, std::uint32_t b) {
    const auto [at, is_new] =
        midpoints.try_emplace({std::min(a, b), std::max(a, b)}, static_cast<std::uint32_t>(result.vertices.size()));
    if (is_new) result.vertices.push_back((mesh.vertices[a] + mesh.vertices[b]) / 2);
    return at->second;
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::uint32_t ab = midpoint(a, b), bc = midpoint(b, c), ca = midpoint(c, a);
    result.triangles.insert(result.triangles.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  return result;
}

TriangleMesh icosphere(int levels) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  TriangleMesh mesh;
  mesh.vertices = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                   {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (int level = 0; level < levels; ++level) mesh = subdivided(mesh);
  for (Vector3d& v : mesh.vertices) v.normalize();
  return mesh;
}

double inscribed_radius(const TriangleMesh& mesh) {
  double radius = std::numeric_limits<double>::infinity();
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vector3d& corner = mesh.vertices[a];
    const Vector3d normal = (mesh.vertices[b] - corner).cross(mesh.vertices[c] - corner).normalized();
    radius = std::min(radius, std::abs(normal.dot(corner)));
  }
  return radius;
}

TriangleMesh scaled(TriangleMesh mesh, double factor) {
  for (Vector3d& v : mesh.vertices) v *= factor;
  return mesh;
}

TriangleMesh moved(TriangleMesh mesh, const Vector3d& by) {
  for (Vector3d& v : mesh.vertices) v += by;
  return mesh;
}

TriangleMesh both(TriangleMesh a, const TriangleMesh& b) {
  const auto first = static_cast<std::uint32_t>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const auto& [i, j, k] : b.triangles) a.triangles.push_back({i + first, j + first, k + first});
  return a;
}

TriangleMesh random_soup(std::uint32_t seed, int count, double size) {
  std::mt19937 random(seed);
  const auto uniform = [&random](double low, double high) {
    return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
  };
  std::vector<std::array<Vector3d, 3>> triangles(static_cast<std::size_t>(count));
  for (auto& triangle : triangles) {
    const Vector3d centre(uniform(0, 1), uniform(0, 1), uniform(0, 1));
    for (Vector3d& corner : triangle) corner = centre + size * Vector3d(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
  }
  return soup(triangles);
}

}  // namespace meshbound::reference
