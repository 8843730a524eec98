// SPDX-License-Identifier: MIT
// Textures around points that thousands of triangles have as a corner.
#include "simplify/cover/hubs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/boxes.h"
#include "simplify/texture/texture_map.h"
#include "texture/charts.h"
#include "textured_shapes.h"

namespace meshbound {
namespace hubs_test {

using test::Corner;
using test::expect_value;
using test::measured;

constexpr double whole_turn = 2 * std::numbers::pi;

/// Sectors of a disc around (0.5, 0.5) in the texture, at a height in space, from one angle to another.
TexturedMesh disc(int sectors, double height, double from = 0, double to = whole_turn) {
  const auto rim = [=](int i) {
    const double angle = i == sectors && to - from == whole_turn ? from : from + (to - from) * i / sectors;
    const Eigen::Vector2d p(0.5 + 0.5 * std::cos(angle), 0.5 + 0.5 * std::sin(angle));
    return Corner{{p.x(), p.y(), height}, p};
  };
  TexturedMesh mesh;
  for (int i = 0; i < sectors; ++i)
    mesh.triangles.push_back(test::triangle({{0.5, 0.5, height}, {0.5, 0.5}}, rim(i), rim(i + 1)));
  return test::numbered(mesh);
}

Hubs hubs_of(const TexturedMesh& mesh) {
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const TexturedTriangle& t : mesh.triangles) boxes.push_back(box_in_texture(t));
  return {mesh.triangles, boxes};
}

std::vector<std::uint32_t> found_by(const Hubs& hubs, const TexturedTriangle& t) {
  std::vector<std::uint32_t> found;
  hubs.find(t.coordinates, t.material, found);
  std::sort(found.begin(), found.end());
  EXPECT_EQ(std::adjacent_find(found.begin(), found.end()), found.end());
  return found;
}

TEST(Hubs, AreFoundWhereManyTrianglesHaveACorner) {
  const TexturedMesh many = disc(500, 0), few = disc(20, 0);
  EXPECT_TRUE(hubs_of(few).empty());
  TexturedMesh cards = few;
  for (int i = 0; i < 20; ++i) cards = test::joined(cards, few);
  EXPECT_TRUE(hubs_of(cards).empty());
  const Hubs hubs = hubs_of(many);
  ASSERT_FALSE(hubs.empty());
  for (std::uint32_t i = 0; i < many.triangles.size(); ++i) {
    const TexturedTriangle& t = many.triangles[i];
    const std::vector<std::uint32_t> found = found_by(hubs, t);
    EXPECT_TRUE(hubs.has(i));
    EXPECT_TRUE(std::binary_search(found.begin(), found.end(), i));
    EXPECT_LE(found.size(), 3U);
    std::vector<std::uint32_t> touching;
    hubs.find_touching(t.coordinates, t.material, touching);
    EXPECT_EQ(touching.size(), 1U);
  }
}

// The hub is in the middle of two discs; their rims, and what lies off them, are looked for as well.
TEST(Atlas, FindsPointsAroundAHub) {
  const TexturedMesh mesh = test::joined(disc(300, 1), disc(200, 0.5));
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
  std::vector<CornerCoordinates> coordinates;
  for (const TexturedTriangle& t : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(vertices.size());
    for (const Eigen::Vector3d& p : t.corners) vertices.push_back(to_vec3(p));
    triangles.push_back({first, first + 1, first + 2});
    coordinates.push_back(t.coordinates);
  }
  const Atlas atlas(vertices, triangles, coordinates, {});
  std::vector<std::uint32_t> found;
  for (int i = 0; i < 100; ++i)
    for (const double distance : {0.0, 1e-5, 0.25, 0.49, 0.51}) {
      const double angle = whole_turn * i / 100, x = 0.5 + distance * std::cos(angle),
                   y = 0.5 + distance * std::sin(angle);
      const bool is_off = distance > 0.5;
      EXPECT_NEAR(atlas.squared_distance({x, y}, 0, {x, y, 0.75}, 0.1, found), is_off ? 0 : 0.0625, 1e-9);
      EXPECT_NEAR(atlas.squared_distance({x, y}, 0, {x, y, 0.5}, 0.1, found), 0, 1e-9);
      EXPECT_LE(found.size(), 12U);
      EXPECT_NEAR(atlas.squared_distance_of_far_point({x, y}, 0, {x, y, 0.5}, 0.1, found), is_off ? 0 : 0.25, 1e-9);
      EXPECT_EQ(atlas.squared_distance_of_far_point({x, y}, 0, {x, y, 0.5}, 0.6, found), 0);
    }
}

/// Triangles with the hub as a corner and others off it, in all directions, also in that where angles start again.
TEST(Hubs, FindWhatLiesInTheDirectionsOfATriangle) {
  constexpr int sectors = 500, directions = 90;
  constexpr double turn = 0.25;
  const Hubs hubs = hubs_of(disc(sectors, 0));
  for (const double from : {0.0, 0.25})  // distance of the first corner from the hub
    for (int i = 0; i < directions; ++i) {
      const auto at = [&](double distance, double by) {
        const double angle = whole_turn * i / directions + by;
        return Corner{{0, 0, by}, {0.5 + distance * std::cos(angle), 0.5 + distance * std::sin(angle)}};
      };
      const std::vector<std::uint32_t> found =
          found_by(hubs, test::triangle(at(from, 0), at(0.75, -turn / 2), at(0.75, turn / 2)));
      EXPECT_GE(found.size(), sectors * (turn / whole_turn) - 1) << i;
      EXPECT_LE(found.size(), sectors * (turn / whole_turn) + 4) << i;
    }
}

TEST(Hubs, FindAllTrianglesAroundAHubInside) {
  const TexturedTriangle large =
      test::triangle({{0, 0, 0}, {0.2, 0.2}}, {{1, 0, 0}, {0.9, 0.3}}, {{0, 1, 0}, {0.4, 0.9}});
  EXPECT_EQ(found_by(hubs_of(disc(500, 0)), large).size(), 500U);
}

// The discs cover each other but for slivers along the rim, where they look for all that may cover these.
TEST(TextureDeviation, LooksAtFewTrianglesAroundAHub) {
  for (const int n : {400, 800}) {
    const TextureDeviation found = measured(disc(n, 0), disc(n - 101, 0.25));
    for (const OneSidedTextureDeviation& direction : {found.a_to_b, found.b_to_a}) {
      expect_value(direction.bounds, 0.25);
      EXPECT_LT(direction.pairs, 40U * static_cast<unsigned>(n));
    }
    EXPECT_GT(found.a_to_b.uncovered.upper, 0);
  }
}

/// Two discs have one texture: the nearer one counts, also at the hub.
TEST(TextureDeviation, TakesTheNearestPlaceOfAHub) {
  const TexturedMesh stack = test::joined(disc(300, 1), disc(300, 0.5));
  const TextureDeviation found = measured(disc(200, 0), stack);
  expect_value(found.a_to_b.bounds, 0.5);
  expect_value(found.b_to_a.bounds, 1);
}

/// A triangle in a gap between the sectors has the coordinate of the hub alone with them. Of two places of the hub the
/// nearer one counts, whichever of them comes first.
TEST(TextureDeviation, MeasuresWhereOnlyTheHubIsShared) {
  const TexturedMesh gap = test::joined(disc(300, 1, 0.5, whole_turn - 0.5), disc(300, 0.75, 0.5, whole_turn - 0.5));
  for (const double height : {0.25, 1.5}) {
    const TextureDeviation found = measured(disc(1, height, -0.25, 0.25), gap);
    expect_value(found.a_to_b.bounds, 0.5);
    expect_value(found.b_to_a.bounds, 0.75);
    EXPECT_NEAR(found.a_to_b.uncovered.upper, 1, 1e-9);
  }
}

}  // namespace hubs_test
}  // namespace meshbound
