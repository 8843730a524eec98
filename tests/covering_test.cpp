// SPDX-License-Identifier: MIT
// Triangles that together cover another one in the texture: by their edges, without cutting anything.
#include "texture/covering.h"

#include <gtest/gtest.h>

#include <numeric>

namespace meshbound {
namespace covering_test {

TexturedTriangle in_texture(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  const Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  return {{origin, origin, origin}, {a, b, c}};
}

/// Texture coordinates here are multiples of 1/64.
constexpr ExactUnits units{-6, 0};

/// Whether these cover the triangle (0,0), (1,0), (0,1).
bool is_covered(const std::vector<TexturedTriangle>& by) {
  const TexturedTriangle whole = in_texture({0, 0}, {1, 0}, {0, 1});
  const ChartTriangle a = chart_triangle(whole, units);
  std::vector<ChartTriangle> charts;
  for (const TexturedTriangle& t : by) charts.push_back(chart_triangle(t, units));
  Overlay overlay(units);
  overlay.begin(a);
  for (const ChartTriangle& t : charts) overlay.add(t);
  std::vector<std::uint32_t> all(overlay.candidates());
  std::iota(all.begin(), all.end(), 0u);
  return Covering().is_complete(overlay, all);
}

const Eigen::Vector2d low(0, 0), right(1, 0), up(0, 1), inside(0.25, 0.375), far_right(2, -0.5), far_up(-0.5, 2);

std::vector<TexturedTriangle> fan() {
  return {in_texture(low, right, inside), in_texture(right, up, inside), in_texture(up, low, inside)};
}

TEST(Covering, OfATriangleByItself) { EXPECT_TRUE(is_covered({in_texture(low, right, up)})); }

TEST(Covering, OfAPartOfOne) {
  EXPECT_TRUE(is_covered({in_texture({-1, -1}, far_right, far_up)}));
  EXPECT_FALSE(is_covered({in_texture(low, {0.5, 0}, up)}));
  EXPECT_FALSE(is_covered({}));
}

TEST(Covering, ByAFan) {
  std::vector<TexturedTriangle> triangles = fan();
  EXPECT_TRUE(is_covered(triangles));
  triangles.push_back(in_texture({1, 1}, {2, 1}, {1, 2}));  // beside it
  EXPECT_TRUE(is_covered(triangles));
  triangles.erase(triangles.begin() + 1);
  EXPECT_FALSE(is_covered(triangles));
}

/// Which way round corners go does not matter: charts may be mirrored.
TEST(Covering, ByAFanOfBothOrientations) {
  std::vector<TexturedTriangle> triangles = fan();
  std::swap(triangles[1].coordinates[0], triangles[1].coordinates[1]);
  EXPECT_TRUE(is_covered(triangles));
}

/// Where two triangles lie on the same side of their common edge, nothing is on the other side, though the edge is
/// there twice.
TEST(Covering, IsNotThatOfAFold) {
  EXPECT_FALSE(is_covered({in_texture(low, {0.5, 0}, up), in_texture(low, up, {0.5, 0})}));
  EXPECT_FALSE(is_covered({in_texture({0.5, 0}, up, low), in_texture({0.5, 0}, up, {-1, 0})}));
}

/// Two sheets of it: twice the number everywhere.
TEST(Covering, ByTwoSheets) {
  std::vector<TexturedTriangle> triangles = fan();
  triangles.push_back(in_texture(low, right, up));
  EXPECT_TRUE(is_covered(triangles));
  triangles.erase(triangles.begin());  // a hole in one of them: it is covered still, which is not known
  EXPECT_FALSE(is_covered(triangles));
}

}  // namespace covering_test
}  // namespace meshbound
