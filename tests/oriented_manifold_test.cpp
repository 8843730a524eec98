// SPDX-License-Identifier: GPL-3.0-or-later
#include "cgal/oriented_manifold.h"

#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <gtest/gtest.h>

#include <random>

namespace {

using Soup = std::vector<std::array<std::size_t, 3>>;
using meshbound::cgal::is_oriented_manifold;

bool cgal_says(const Soup& soup) { return CGAL::Polygon_mesh_processing::is_polygon_soup_a_polygon_mesh(soup); }

TEST(OrientedManifold, KnowsTheWaysInWhichTrianglesDoNotFit) {
  const Soup tetrahedron = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
  EXPECT_TRUE(is_oriented_manifold(tetrahedron, 4));
  EXPECT_TRUE(is_oriented_manifold({{0, 1, 2}, {2, 1, 3}}, 4));
  EXPECT_TRUE(is_oriented_manifold({{0, 1, 2}, {3, 4, 5}}, 6));
  EXPECT_FALSE(is_oriented_manifold({{0, 1, 2}, {1, 2, 3}}, 4)) << "neighbours of opposite orientation";
  EXPECT_FALSE(is_oriented_manifold({{0, 1, 2}, {2, 1, 3}, {4, 1, 2}}, 5)) << "three faces at an edge";
  EXPECT_FALSE(is_oriented_manifold({{0, 1, 2}, {0, 3, 4}}, 5)) << "two fans that meet in a vertex";
  EXPECT_FALSE(is_oriented_manifold({{0, 0, 1}}, 2)) << "equal corners";
  Soup rings = tetrahedron;
  for (const auto& corners : tetrahedron) {
    const auto moved = [](std::size_t v) { return v == 0 ? v : v + 3; };
    rings.push_back({moved(corners[0]), moved(corners[1]), moved(corners[2])});
  }
  EXPECT_FALSE(is_oriented_manifold(rings, 7)) << "two rings that meet in a vertex";
}

TEST(OrientedManifold, AgreesWithCgalOnRandomParts) {
  // Triangles of a closed grid, some missing, some turned over, some with a corner elsewhere.
  std::mt19937 random(7);
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random()) % n; };
  int manifold = 0, other = 0;
  for (int round = 0; round < 2000; ++round) {
    const std::size_t n = 3 + below(4);
    Soup soup;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        const std::size_t a = n * i + j, b = n * ((i + 1) % n) + j, c = n * ((i + 1) % n) + (j + 1) % n,
                          d = n * i + (j + 1) % n;
        if (below(8) != 0) soup.push_back({a, b, c});
        if (below(8) != 0) soup.push_back({a, c, d});
      }
    }
    if (soup.empty()) continue;
    if (below(4) == 0) std::swap(soup[below(soup.size())][0], soup.back()[1]);
    if (below(4) == 0) soup[below(soup.size())][below(3)] = below(n * n);
    const bool expected = cgal_says(soup);
    ASSERT_EQ(is_oriented_manifold(soup, n * n), expected) << "round " << round;
    ++(expected ? manifold : other);
  }
  EXPECT_GT(manifold, 20);
  EXPECT_GT(other, 200);
}

}  // namespace
