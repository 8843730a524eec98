// SPDX-License-Identifier: MIT
#include "fuzz/lattice_solids.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "reference/small_meshes.h"
#include "solids.h"

namespace meshbound::fuzz {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using reference::CellSolid;
using solids::box;

CellSolid convex(TriangleMesh mesh) { return {mesh, {mesh}}; }

CellSolid tetrahedron(const Choose& choose) {
  TriangleMesh mesh;
  for (int i = 0; i < 4; ++i) mesh.vertices.emplace_back(choose(7), choose(7), choose(7));
  const Vector3d &a = mesh.vertices[0], &b = mesh.vertices[1], &c = mesh.vertices[2], &d = mesh.vertices[3];
  const double volume = (b - a).dot((c - a).cross(d - a));
  if (volume == 0) return convex(box({0, 0, 0}, {2, 2, 2}));
  if (volume < 0) std::swap(mesh.vertices[2], mesh.vertices[3]);
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  return convex(mesh);
}

CellSolid wedge(const Choose& choose) {
  const double w = 1 + choose(5), h = 1 + choose(5), z = 1 + choose(5), top = choose(6);
  TriangleMesh mesh;
  for (const double at : {0.0, z}) {
    mesh.vertices.emplace_back(0, 0, at);
    mesh.vertices.emplace_back(w, 0, at);
    mesh.vertices.emplace_back(top, h, at);
  }
  mesh.triangles = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}};
  return convex(mesh);
}

/// The union of cubes of a grid of lines, some of which are filled: its surface has a square for each side between a
/// filled and an empty cube. The caller sees to it that no edge or vertex has more than one fan.
CellSolid filled_cubes(const std::array<std::vector<double>, 3>& lines,
                       const std::function<bool(int, int, int)>& is_filled) {
  CellSolid solid;
  const auto filled = [&](const std::array<int, 3>& at) {
    for (std::size_t k = 0; k < 3; ++k)
      if (at[k] < 0 || at[k] + 1 >= static_cast<int>(lines[k].size())) return false;
    return is_filled(at[0], at[1], at[2]);
  };
  const auto corner = [&](const std::array<int, 3>& at) {
    return Vector3d(lines[0][static_cast<std::size_t>(at[0])], lines[1][static_cast<std::size_t>(at[1])],
                    lines[2][static_cast<std::size_t>(at[2])]);
  };
  std::map<std::array<int, 3>, std::uint32_t> vertices;
  const auto vertex = [&](const std::array<int, 3>& at) {
    const auto [found, is_new] = vertices.try_emplace(at, static_cast<std::uint32_t>(solid.surface.vertices.size()));
    if (is_new) solid.surface.vertices.push_back(corner(at));
    return found->second;
  };
  for (int x = 0; x + 1 < static_cast<int>(lines[0].size()); ++x)
    for (int y = 0; y + 1 < static_cast<int>(lines[1].size()); ++y)
      for (int z = 0; z + 1 < static_cast<int>(lines[2].size()); ++z) {
        const std::array<int, 3> at{x, y, z};
        if (!filled(at)) continue;
        solid.cells.push_back(box(corner(at), corner({x + 1, y + 1, z + 1})));
        for (std::size_t axis = 0; axis < 3; ++axis)
          for (const int step : {-1, 1}) {
            std::array<int, 3> next = at;
            next[axis] += step;
            if (filled(next)) continue;
            std::array<int, 3> p = at;
            if (step > 0) ++p[axis];
            std::array<int, 3> q = p, r = p, s = p;
            const std::size_t i = (axis + 1) % 3, j = (axis + 2) % 3;
            ++q[i], ++r[i], ++r[j], ++s[j];
            if (step < 0) std::swap(q, s);
            solid.surface.triangles.push_back({vertex(p), vertex(q), vertex(r)});
            solid.surface.triangles.push_back({vertex(p), vertex(r), vertex(s)});
          }
      }
  return solid;
}

std::vector<double> ascending(const Choose& choose, int count) {
  std::vector<double> values{static_cast<double>(choose(3))};
  while (static_cast<int>(values.size()) < count) values.push_back(values.back() + 1 + choose(3));
  return values;
}

CellSolid bent(const Choose& choose) {
  const unsigned shape = choose(5);
  const std::array<std::vector<double>, 3> lines{ascending(choose, 4), ascending(choose, 4),
                                                 ascending(choose, shape == 3 ? 4 : 2)};
  return filled_cubes(lines, [shape](int x, int y, int z) {
    switch (shape) {
      case 0:  // L
        return x == 0 || y == 0;
      case 1:  // U
        return x != 1 || y == 0;
      case 2:  // ring
        return x != 1 || y != 1;
      case 3:  // hollow box
        return x != 1 || y != 1 || z != 1;
      default:  // two boxes
        return x != 1;
    }
  });
}

CellSolid mapped(CellSolid solid, const Matrix3d& linear, const Vector3d& shift) {
  const bool is_mirrored = linear.determinant() < 0;
  const auto map = [&](TriangleMesh& mesh) {
    for (Vector3d& v : mesh.vertices) v = linear * v + shift;
    if (is_mirrored) mesh = solids::reversed(mesh);
  };
  map(solid.surface);
  for (TriangleMesh& cell : solid.cells) map(cell);
  return solid;
}

}  // namespace

CellSolid lattice_solid(const Choose& choose) {
  const unsigned kind = choose(6);
  CellSolid solid;
  if (kind == 0) solid = tetrahedron(choose);
  if (kind == 1) solid = wedge(choose);
  if (kind == 2) solid = convex(box({0, 0, 0}, {1.0 + choose(4), 1.0 + choose(4), 1.0 + choose(4)}));
  if (kind >= 3) solid = bent(choose);
  Matrix3d linear = Matrix3d::Identity();
  // Exchanges axes, mirrors, shears.
  for (unsigned i = choose(4); i > 0; --i) {
    const auto row = static_cast<int>(choose(3)),
               other = static_cast<int>((static_cast<unsigned>(row) + 1 + choose(2)) % 3);
    switch (choose(3)) {
      case 0:
        linear.row(row).swap(linear.row(other));
        break;
      case 1:
        linear.row(row) *= -1;
        break;
      default:
        linear.row(row) += linear.row(other);
    }
  }
  const Vector3d shift(static_cast<double>(choose(6)), static_cast<double>(choose(6)), static_cast<double>(choose(6)));
  return mapped(std::move(solid), linear, shift);
}

}  // namespace meshbound::fuzz
