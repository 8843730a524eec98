// SPDX-License-Identifier: MIT
// Closed solids that touch along edges stay closed in tiles, each of which knows only some of the faces of such an
// edge.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "meshbound/mesh_summary.h"
#include "meshbound/tiles.h"

namespace meshbound {
namespace crowded_tiles_test {

double uniform(std::mt19937& random, double from, double to) {
  return from + (to - from) * static_cast<double>(random()) / static_cast<double>(std::mt19937::max());
}

/// Closed prisms over triangles, all with one edge on the z axis, from 0 to 1. Each side is cut into `cells` by `cells`
/// squares.
TriangleMesh wedges(std::mt19937& random, int count, int cells) {
  TriangleMesh mesh;
  for (int wedge = 0; wedge < count; ++wedge) {
    const double width = 2 * std::numbers::pi / count, from = wedge * width,
                 to = from + width * uniform(random, 0.2, 0.95);
    const std::array<Eigen::Vector2d, 3> corners{
        {{0, 0}, {std::cos(from), std::sin(from)}, {std::cos(to), std::sin(to)}}};
    std::map<std::array<int, 4>, std::uint32_t> numbers;
    const auto vertex = [&](std::array<int, 3> weights, int layer) {
      const auto next = static_cast<std::uint32_t>(mesh.vertices.size());
      const auto found = numbers.try_emplace({weights[0], weights[1], weights[2], layer}, next);
      if (found.second) {
        const Eigen::Vector2d p = (weights[0] * corners[0] + weights[1] * corners[1] + weights[2] * corners[2]) / cells;
        mesh.vertices.emplace_back(p.x(), p.y(), static_cast<double>(layer) / cells);
      }
      return found.first->second;
    };
    for (std::size_t side = 0; side < 3; ++side) {
      const auto at = [&](int along, int layer) {
        std::array<int, 3> weights{};
        weights[side] = cells - along;
        weights[(side + 1) % 3] = along;
        return vertex(weights, layer);
      };
      for (int i = 0; i < cells; ++i) {
        for (int layer = 0; layer < cells; ++layer) {
          mesh.triangles.push_back({at(i, layer), at(i + 1, layer), at(i + 1, layer + 1)});
          mesh.triangles.push_back({at(i, layer), at(i + 1, layer + 1), at(i, layer + 1)});
        }
      }
    }
    for (const int layer : {0, cells}) {
      const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        mesh.triangles.push_back(layer > 0 ? Triangle{a, b, c} : Triangle{a, c, b});
      };
      const auto at = [&](int i, int j) { return vertex({cells - i - j, i, j}, layer); };
      for (int i = 0; i < cells; ++i) {
        for (int j = 0; i + j < cells; ++j) {
          add(at(i, j), at(i + 1, j), at(i, j + 1));
          if (i + j + 1 < cells) add(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
        }
      }
    }
  }
  return mesh;
}

/// 3 by 3 by 3 unit cubes of which two in five are full: the faces between full and empty ones, each cut into `cells`
/// by `cells` squares.
TriangleMesh voxels(std::mt19937& random, int cells) {
  std::array<bool, 27> is_full{};
  for (bool& full : is_full) full = random() % 5 < 2;
  const auto full = [&](const Eigen::Vector3i& at) {
    return at.minCoeff() >= 0 && at.maxCoeff() < 3 &&
           is_full[static_cast<std::size_t>(9 * at.x() + 3 * at.y() + at.z())];
  };
  TriangleMesh mesh;
  std::map<std::array<int, 3>, std::uint32_t> numbers;
  const auto vertex = [&](const Eigen::Vector3i& p) {
    const auto next = static_cast<std::uint32_t>(mesh.vertices.size());
    const auto found = numbers.try_emplace({p.x(), p.y(), p.z()}, next);
    if (found.second) mesh.vertices.push_back(p.cast<double>() / cells);
    return found.first->second;
  };
  for (int cube = 0; cube < 27; ++cube) {
    const Eigen::Vector3i at(cube / 9, cube / 3 % 3, cube % 3);
    for (int side = 0; side < 6 && full(at); ++side) {
      const int axis = side / 2;
      const Eigen::Vector3i out = (side % 2 == 0 ? 1 : -1) * Eigen::Vector3i::Unit(axis);
      if (full(at + out)) continue;
      Eigen::Vector3i u = Eigen::Vector3i::Unit((axis + 1) % 3), v = Eigen::Vector3i::Unit((axis + 2) % 3);
      const Eigen::Vector3i first = cells * (at + (side % 2 == 0 ? out : Eigen::Vector3i::Zero().eval()));
      if (side % 2 != 0) std::swap(u, v);
      for (int i = 0; i < cells; ++i) {
        for (int j = 0; j < cells; ++j) {
          const Eigen::Vector3i a = first + i * u + j * v;
          mesh.triangles.push_back({vertex(a), vertex(a + u), vertex(a + u + v)});
          mesh.triangles.push_back({vertex(a), vertex(a + u + v), vertex(a + v)});
        }
      }
    }
  }
  return mesh;
}

/// Edges, by position, along which not as many triangles run one way as the other: borders, and where a face has been
/// turned over.
std::size_t unbalanced_edges(const TriangleMesh& mesh) {
  using Point = std::array<double, 3>;
  std::map<std::pair<Point, Point>, int> balance;
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d &p = mesh.vertices[t[k]], &q = mesh.vertices[t[(k + 1) % 3]];
      const Point a{p.x(), p.y(), p.z()}, b{q.x(), q.y(), q.z()};
      balance[std::minmax(a, b)] += a < b ? 1 : -1;
    }
  }
  std::size_t unbalanced = 0;
  for (const auto& edge : balance) unbalanced += edge.second != 0 ? 1 : 0;
  return unbalanced;
}

std::size_t used_vertices(const TriangleMesh& mesh) {
  std::set<std::uint32_t> used;
  for (const Triangle& corners : mesh.triangles) used.insert(corners.begin(), corners.end());
  return used.size();
}

void expect_closed(const TriangleMesh& mesh, double share_of_tile, double tolerance) {
  ASSERT_EQ(unbalanced_edges(mesh), 0U);
  SimplifyOptions options;
  options.tolerance = tolerance * bounding_box_diagonal(mesh);
  options.threads = 1;
  const auto max_triangles = static_cast<std::size_t>(share_of_tile * static_cast<double>(mesh.triangles.size()));
  const SimplifiedLevel level = simplify_in_tiles(mesh, options, {max_triangles}).last();
  EXPECT_EQ(level.verdict, Verdict::Within);
  EXPECT_EQ(level.turned_faces, 0U);
  EXPECT_EQ(unbalanced_edges(level.mesh), 0U);
  EXPECT_EQ(used_vertices(level.mesh), level.mesh.vertices.size());
}

/// The last three are what a first pass has split at one position, and vertices whose triangles all stay.
TEST(CrowdedTiles, KeepSolidsClosedThatTouchAlongAnEdge) {
  const std::set<int> found_by_search = {133, 249, 289};
  std::mt19937 random(3);
  for (int trial = 0; trial < 290; ++trial) {
    SCOPED_TRACE(trial);
    const int count = 2 + static_cast<int>(random() % 4), cells = 3 + static_cast<int>(random() % 5);
    const TriangleMesh mesh = wedges(random, count, cells);
    const double tolerance = std::pow(10, uniform(random, -4, -1.5)), share = uniform(random, 0.15, 0.6);
    if (trial < 60 || found_by_search.contains(trial)) expect_closed(mesh, share, tolerance);
  }
}

/// So coarse that touching solids come to share triangles, as they do in the last trial.
TEST(CrowdedTiles, KeepVoxelsClosed) {
  const std::set<int> found_by_search = {185};
  std::mt19937 random(4);
  for (int trial = 0; trial < 186; ++trial) {
    SCOPED_TRACE(trial);
    const TriangleMesh mesh = voxels(random, 2 + static_cast<int>(random() % 3));
    if (mesh.triangles.empty()) continue;
    const double tolerance = uniform(random, 0.01, 0.13), share = uniform(random, 0.15, 0.6);
    if (trial < 60 || found_by_search.contains(trial)) expect_closed(mesh, share, tolerance);
  }
}

}  // namespace crowded_tiles_test
}  // namespace meshbound
