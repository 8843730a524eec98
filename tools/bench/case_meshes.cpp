// SPDX-License-Identifier: GPL-3.0-or-later
#include "case_meshes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "datasets/analytic_meshes.h"
#include "meshbound/mesh_summary.h"

namespace meshbound::bench {
namespace {

using Eigen::Vector3d;

/// Numbers that do not depend on the standard library's distributions.
class Random {
 public:
  explicit Random(std::uint32_t seed) : engine_(seed) {}
  double uniform(double low, double high) { return low + (high - low) * static_cast<double>(engine_()) / 4294967296.0; }
  std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(engine_()) % n; }
  Vector3d in_cube(double half) {
    const double x = uniform(-half, half), y = uniform(-half, half), z = uniform(-half, half);
    return {x, y, z};
  }

 private:
  std::mt19937 engine_;
};

std::uint32_t add_vertex(TriangleMesh& mesh, const Vector3d& position) {
  mesh.vertices.push_back(position);
  return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
}

void add_triangle(TriangleMesh& mesh, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const std::uint32_t first = add_vertex(mesh, a);
  add_vertex(mesh, b);
  add_vertex(mesh, c);
  mesh.triangles.push_back({first, first + 1, first + 2});
}

Vector3d on_circle(std::size_t i, std::size_t count, double height) {
  const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count);
  return {std::cos(angle), std::sin(angle), height};
}

/// Triangles from `centre` to the `count` vertices of a ring that begins at `first`.
void add_fan(TriangleMesh& mesh, std::uint32_t centre, std::uint32_t first, std::uint32_t count) {
  for (std::uint32_t i = 0; i < count; ++i) mesh.triangles.push_back({centre, first + i, first + (i + 1) % count});
}

constexpr double cylinder_height = 4;

/// `rows` rows of `sides` quadrilaterals.
TriangleMesh cylinder_wall(std::size_t sides, std::size_t rows) {
  TriangleMesh mesh;
  for (std::size_t i = 0; i <= rows; ++i)
    for (std::size_t j = 0; j < sides; ++j)
      add_vertex(mesh, on_circle(j, sides, cylinder_height * static_cast<double>(i) / static_cast<double>(rows)));
  for (std::size_t i = 0; i < rows; ++i) {
    for (std::size_t j = 0; j < sides; ++j) {
      const auto a = static_cast<std::uint32_t>(i * sides + j);
      const auto b = static_cast<std::uint32_t>(i * sides + (j + 1) % sides);
      const auto above = static_cast<std::uint32_t>(sides);
      mesh.triangles.push_back({a, b, b + above});
      mesh.triangles.push_back({a, b + above, a + above});
    }
  }
  return mesh;
}

TriangleMesh random_manifold(Random& random) {
  const auto count = [&](std::uint32_t low, std::uint32_t high) { return low + random.below(high - low + 1); };
  switch (random.below(5)) {
    case 0:
      return datasets::uv_sphere(random.uniform(0.3, 1), count(3, 19), count(3, 36));
    case 1:
      return datasets::torus(1, random.uniform(0.1, 0.9), count(3, 36), count(3, 18));
    case 2:
      return datasets::box({random.uniform(0.1, 1), random.uniform(0.1, 1), 1},
                           {count(1, 10), count(1, 10), count(1, 10)});
    case 3:
      return datasets::gear(1, random.uniform(0.1, 1), count(3, 20), count(4, 8), count(1, 3));
    default:
      return datasets::terrain(1, count(1, 25), random.below(1000));
  }
}

/// Moves every vertex by up to this share of the diagonal in each coordinate.
void roughen(TriangleMesh& mesh, double share, Random& random) {
  const double distance = share * bounding_box_diagonal(mesh);
  for (Vector3d& vertex : mesh.vertices) vertex += random.in_cube(distance);
}

}  // namespace

TriangleMesh unwelded(const TriangleMesh& mesh) {
  TriangleMesh soup;
  for (const auto& [a, b, c] : mesh.triangles) add_triangle(soup, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
  return soup;
}

TriangleMesh flat_square(std::size_t cells) {
  TriangleMesh mesh;
  const auto side = static_cast<std::uint32_t>(cells + 1);
  for (std::uint32_t j = 0; j < side; ++j)
    for (std::uint32_t i = 0; i < side; ++i)
      add_vertex(mesh, {i / static_cast<double>(cells), j / static_cast<double>(cells), 0});
  for (std::uint32_t j = 0; j + 1 < side; ++j) {
    for (std::uint32_t i = 0; i + 1 < side; ++i) {
      const std::uint32_t a = j * side + i;
      mesh.triangles.push_back({a, a + 1, a + side + 1});
      mesh.triangles.push_back({a, a + side + 1, a + side});
    }
  }
  return mesh;
}

TriangleMesh fan(std::size_t count) {
  TriangleMesh mesh;
  const std::uint32_t apex = add_vertex(mesh, {0, 0, 0.5});
  for (std::size_t i = 0; i < count; ++i) add_vertex(mesh, on_circle(i, count, 0));
  add_fan(mesh, apex, apex + 1, static_cast<std::uint32_t>(count));
  return mesh;
}

TriangleMesh capped_cylinder(std::size_t sides) {
  TriangleMesh mesh = cylinder_wall(sides, 1);
  const auto ring = static_cast<std::uint32_t>(sides);
  add_fan(mesh, add_vertex(mesh, {0, 0, cylinder_height}), ring, ring);
  const std::size_t top = mesh.triangles.size();
  add_fan(mesh, add_vertex(mesh, {0, 0, 0}), 0, ring);
  for (std::size_t i = top; i < mesh.triangles.size(); ++i) std::swap(mesh.triangles[i][1], mesh.triangles[i][2]);
  return mesh;
}

TriangleMesh open_cylinder(std::size_t count) {
  const auto sides = std::max<std::size_t>(3, static_cast<std::size_t>(std::sqrt(static_cast<double>(count))));
  return cylinder_wall(sides, std::max<std::size_t>(1, count / (2 * sides)));
}

TriangleMesh chain_on_axis(std::size_t count) {
  TriangleMesh mesh;
  for (std::size_t i = 0; i <= count; ++i)
    add_vertex(mesh, {0, 0, cylinder_height * static_cast<double>(i) / static_cast<double>(count)});
  for (std::uint32_t i = 0; i < count; ++i) mesh.triangles.push_back({i, i + 1, i + 1});
  return mesh;
}

TriangleMesh needle_stack(std::size_t count) {
  constexpr double thickness = 1e-3;
  Random random(8);
  TriangleMesh mesh;
  for (std::size_t i = 0; i < count; ++i) {
    const Vector3d beside = random.in_cube(thickness),
                   end = Vector3d(0, 0, cylinder_height) + random.in_cube(thickness);
    add_triangle(mesh, beside, end, end + Vector3d(thickness, 0, 0));
  }
  return mesh;
}

TriangleMesh star(std::size_t count) {
  constexpr double width = 0.1;
  Random random(7);
  TriangleMesh mesh;
  const std::uint32_t centre = add_vertex(mesh, {0, 0, 0});
  for (std::size_t i = 0; i < count; ++i) {
    const Vector3d end = random.in_cube(2);
    const std::uint32_t a = add_vertex(mesh, end), b = add_vertex(mesh, end + random.in_cube(width));
    mesh.triangles.push_back({centre, a, b});
  }
  return mesh;
}

TriangleMesh around_an_edge(std::size_t count) {
  TriangleMesh mesh;
  const std::uint32_t from = add_vertex(mesh, {0, 0, 0}), to = add_vertex(mesh, {0, 0, 1});
  for (std::size_t i = 0; i < count; ++i)
    mesh.triangles.push_back({from, to, add_vertex(mesh, on_circle(i, count, 0.5))});
  return mesh;
}

TriangleMesh large_random_triangles(std::size_t count) {
  Random random(3);
  TriangleMesh mesh;
  for (std::size_t i = 0; i < count; ++i) {
    const Vector3d a = random.in_cube(2), b = random.in_cube(2), c = random.in_cube(2);
    add_triangle(mesh, a, b, c);
  }
  return mesh;
}

TriangleMesh overlapping_layer(std::size_t count, double height, double shift) {
  Random corners(3), shifts(5);
  TriangleMesh mesh;
  const auto corner = [&] {
    Vector3d at = corners.in_cube(2) + shifts.in_cube(shift);
    at.z() = height;
    return at;
  };
  for (std::size_t i = 0; i < count; ++i) {
    const Vector3d a = corner(), b = corner(), c = corner();
    add_triangle(mesh, a, b, c);
  }
  return mesh;
}

MeshPair random_pair(std::uint32_t seed) {
  Random random(seed);
  MeshPair pair;
  pair.a = random_manifold(random);
  const double scale = 1 / bounding_box_diagonal(pair.a);
  for (Vector3d& vertex : pair.a.vertices) vertex *= scale;
  const bool is_copy = random.below(3) == 0;
  pair.b = is_copy ? pair.a : random_manifold(random);
  if (!is_copy)
    for (Vector3d& vertex : pair.b.vertices) vertex *= scale;
  if (random.below(2) == 0) roughen(pair.a, 0.03, random);
  if (is_copy || random.below(2) == 0) roughen(pair.b, std::pow(10.0, random.uniform(-6, -1)), random);
  const Vector3d offset = random.below(2) == 0 ? Vector3d(0, 0, 0) : random.in_cube(0.5);
  for (Vector3d& vertex : pair.b.vertices) vertex += offset;
  return pair;
}

}  // namespace meshbound::bench
