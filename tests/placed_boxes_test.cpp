// SPDX-License-Identifier: MIT
// Boxes in a texture that many triangles share, found by their places in space as well.
#include "simplify/cover/placed_boxes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "geometry/eigen_vec3.h"
#include "reference/point_triangle_cases.h"
#include "simplify/texture/texture_map.h"
#include "texture/charts.h"
#include "textured_shapes.h"

namespace meshbound {
namespace placed_boxes_test {

Eigen::AlignedBox3d random_box(reference::Random& random, int below) {
  Eigen::AlignedBox3d box;
  for (int corner = 0; corner < 2; ++corner)
    box.extend(Eigen::Vector3d(random.below(below), random.below(below), random.below(2)));
  return box;
}

TEST(PlacedBoxes, FindsTheBoxesThatMeetBothInTheOrderOfTheTexture) {
  reference::Random random(1);
  for (const int size : {3, 200}) {  // in the texture: with 3 many boxes meet, with 200 few
    std::vector<Eigen::AlignedBox3d> in_texture, in_space;
    for (int i = 0; i < 600; ++i) {
      in_texture.push_back(random_box(random, size));
      in_space.push_back(random_box(random, 12));
    }
    for (int i = 0; i < 600; i += 7) in_texture[static_cast<std::size_t>(i)].setEmpty();
    const PlacedBoxes boxes(in_texture, in_space);
    for (int query = 0; query < 100; ++query) {
      const Eigen::AlignedBox3d texture = random_box(random, size), space = random_box(random, 12);
      std::vector<std::uint32_t> found, expected;
      boxes.find(texture, space, found);
      const auto misses_space = [&](std::uint32_t i) { return !in_space[i].intersects(space); };
      if (size > 3) found.erase(std::remove_if(found.begin(), found.end(), misses_space), found.end());
      for (const std::uint32_t i : boxes.in_texture().order())
        if (in_texture[i].intersects(texture) && !misses_space(i)) expected.push_back(i);
      ASSERT_EQ(found, expected) << size;
    }
  }
}

TEST(BoxTree, FindsOneBoxAfterTheOther) {
  reference::Random random(2);
  for (const std::size_t count : {0, 1, 8, 9, 3000}) {
    std::vector<Eigen::AlignedBox3d> boxes;
    for (std::size_t i = 0; i < count; ++i) boxes.push_back(random_box(random, 12));
    const BoxTree tree(boxes);
    for (int query = 0; query < 30; ++query) {
      const Eigen::AlignedBox3d box = random_box(random, 12);
      std::vector<std::uint32_t> at_once, one_by_one;
      tree.find(box, at_once);
      BoxTree::Search search(tree, box);
      while (const std::optional<std::uint32_t> index = search.next()) one_by_one.push_back(*index);
      EXPECT_EQ(one_by_one, at_once);
      EXPECT_FALSE(search.next());
      EXPECT_EQ(tree.meets(box), !at_once.empty());
    }
  }
}

constexpr int cards = 400;  ///< unit squares in a row, each with the whole texture

/// The corners of one half of a card, which stands upright at x = 2 `card`.
std::array<Eigen::Vector3d, 3> half_of_card(int card, bool is_upper) {
  const Eigen::Vector3d at(2.0 * card, 0, 0), x(1, 0, 0), z(0, 0, 1);
  return {at, is_upper ? (at + x + z).eval() : (at + x).eval(), is_upper ? (at + z).eval() : (at + x + z).eval()};
}

std::array<Eigen::Vector2d, 3> coordinates_of_half(bool is_upper) {
  if (is_upper) return {Eigen::Vector2d(0, 0), Eigen::Vector2d(1, 1), Eigen::Vector2d(0, 1)};
  return {Eigen::Vector2d(0, 0), Eigen::Vector2d(1, 0), Eigen::Vector2d(1, 1)};
}

TEST(Charts, LookAtFewOfTheTrianglesThatShareATexture) {
  TexturedMesh mesh;
  for (int card = 0; card < cards; ++card)
    for (const bool is_upper : {false, true})
      mesh.triangles.push_back({half_of_card(card, is_upper), coordinates_of_half(is_upper),
                                static_cast<std::uint32_t>(mesh.triangles.size())});
  const Charts charts(mesh);
  ChartCandidates found;
  for (const ChartTriangle& t : charts.triangles()) {
    charts.find_candidates(t, 0.5, found);
    ASSERT_EQ(found.near, std::vector<const ChartTriangle*>{&t});
    EXPECT_LE(found.indices.size(), 16U);
  }
  charts.find_others(charts.triangles().front(), found);
  EXPECT_EQ(found.others.size(), mesh.triangles.size() - 1);
}

// Triangles B that lie in a grid cover a half plane of the texture each, every other one all of it.
TEST(TextureDeviation, ForgetsTrianglesFarFromAPiece) {
  constexpr int n = 12;
  constexpr double step = 1.0 / n;
  reference::Random random(1);
  TexturedMesh b;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double turn = 0.001 * random.below(6283), size = 20;
      const auto towards = [](double angle) { return Eigen::Vector2d(std::cos(angle), std::sin(angle)); };
      const auto corner = [&](double x, double y, double turned) {
        const Eigen::Vector2d edge = (i + j) % 2 == 1 ? (size / 2 * towards(turn)).eval() : Eigen::Vector2d(0, 0);
        return test::Corner{{(i + x) * step, (j + y) * step, 0},
                            Eigen::Vector2d(0.3, 0.3) + edge + size * towards(turn + turned)};
      };
      constexpr double third = 2 * std::numbers::pi / 3;
      b.triangles.push_back(test::triangle(corner(0, 0, 0), corner(1, 0, third), corner(0, 1, 2 * third)));
    }
  const TexturedMesh a{{test::triangle({{0, 0, 0}, {0, 0}}, {{1, 0, 0}, {1, 0}}, {{0, 1, 0}, {0, 1}})}, {}};
  const OneSidedTextureDeviation found = test::measured(a, test::numbered(b), 1e-4).a_to_b;
  EXPECT_LE(found.bounds.upper - found.bounds.lower, 1e-4);
  EXPECT_LT(found.pieces, 2400U);  // 4,000 where all stay
}

TEST(Atlas, LooksAtFewOfTheTrianglesThatShareATexture) {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
  std::vector<CornerCoordinates> coordinates;
  for (int card = 0; card < cards; ++card)
    for (const bool is_upper : {false, true}) {
      const auto first = static_cast<std::uint32_t>(vertices.size());
      for (const Eigen::Vector3d& p : half_of_card(card, is_upper)) vertices.push_back(to_vec3(p));
      triangles.push_back({first, first + 1, first + 2});
      coordinates.push_back(coordinates_of_half(is_upper));
    }
  const Atlas atlas(vertices, triangles, coordinates, {});
  std::vector<std::uint32_t> found;
  for (int card = 0; card < cards; ++card) {
    const Vec3 p{2.0 * card + 0.25, 0.125, 0.75};
    EXPECT_EQ(atlas.squared_distance({0.25, 0.75}, 0, p, 0.5, found), 0.125 * 0.125);
    EXPECT_LE(found.size(), 16U);
    EXPECT_GT(atlas.squared_distance({0.5, 0.125}, 0, p, 0.1, found), 0.1 * 0.1);
    EXPECT_EQ(atlas.squared_distance({1.5, 0.125}, 0, p, 0.1, found), 0);
    EXPECT_EQ(atlas.squared_distance({0.25, 0.75}, 1, p, 0.5, found), 0);
    EXPECT_GT(atlas.squared_distance_of_far_point({0.25, 0.75}, 0, p, 0.5, found), 0.25);
  }
}

}  // namespace placed_boxes_test
}  // namespace meshbound
