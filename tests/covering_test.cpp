// SPDX-License-Identifier: MIT
// What triangles leave uncovered of another one in the texture, by their edges.
#include "texture/covering.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "chart_cases.h"
#include "reference/point_triangle_cases.h"
#include "texture/chart_edges.h"

namespace meshbound {
namespace covering_test {

/// Texture coordinates here are multiples of 1/64.
constexpr ExactUnits units{-6, 0};

/// The triangle (0,0), (1,0), (0,1), and others as its candidates.
struct Case {
  explicit Case(std::vector<TexturedTriangle> by, bool is_linked = true) : triangles(std::move(by)) {
    if (is_linked) link_across_edges(charts);
    overlay.begin(a);
    for (const ChartTriangle& t : charts) overlay.add(t);
    all.resize(overlay.candidates());
    std::iota(all.begin(), all.end(), 0u);
  }
  TexturedTriangle whole = in_texture({0, 0}, {1, 0}, {0, 1});
  ChartTriangle a = chart_triangle(whole, units);
  std::vector<TexturedTriangle> triangles;
  std::vector<ChartTriangle> charts = charts_of(triangles, units);
  Overlay overlay = Overlay(units);
  std::vector<std::uint32_t> all;
};

/// The share of the triangle that these are found to leave uncovered; -1 where that is not decided.
double uncovered_share(const std::vector<TexturedTriangle>& by) {
  Case test(by);
  const auto pieces = Covering().uncovered(test.overlay, test.all);
  if (!pieces) return -1;
  double share = 0;
  for (const Overlay::Polygon& piece : *pieces) share += test.overlay.share(piece).value;
  return share;
}

const Eigen::Vector2d low(0, 0), right(1, 0), up(0, 1), inside(0.25, 0.375), far_right(2, -0.5), far_up(-0.5, 2);

std::vector<TexturedTriangle> fan() {
  return {in_texture(low, right, inside), in_texture(right, up, inside), in_texture(up, low, inside)};
}

/// Edges between two triangles cancel only where both are among the candidates that are asked about.
TEST(Covering, OfSomeOfTheCandidates) {
  Case test(fan());
  const std::vector<std::uint32_t> two = {0, 2};
  const auto of_all = Covering().uncovered(test.overlay, test.all);
  EXPECT_TRUE(of_all && of_all->empty());
  const auto pieces = Covering().uncovered(test.overlay, two);
  ASSERT_TRUE(pieces);
  ASSERT_EQ(pieces->size(), 1u);
  EXPECT_NEAR(test.overlay.share(pieces->front()).value, 0.375, 1e-12);
}

TEST(Covering, LeavesNothingOfAFan) {
  EXPECT_EQ(uncovered_share(fan()), 0);
  EXPECT_EQ(uncovered_share({in_texture({-1, -1}, far_right, far_up)}), 0);
}

/// Which way round corners go does not matter: charts may be mirrored.
TEST(Covering, LeavesNothingOfAFanOfBothOrientations) {
  std::vector<TexturedTriangle> triangles = fan();
  std::swap(triangles[1].coordinates[0], triangles[1].coordinates[1]);
  EXPECT_EQ(uncovered_share(triangles), 0);
}

/// Where two triangles lie on the same side of their common edge, nothing is on the other side, though the edge is
/// there twice.
TEST(Covering, LeavesWhatLiesBesideAFold) {
  EXPECT_NEAR(uncovered_share({in_texture(low, {0.5, 0}, up), in_texture(low, up, {0.5, 0})}), 0.5, 1e-12);
  EXPECT_NEAR(uncovered_share({in_texture({0.5, 0}, up, low), in_texture({0.5, 0}, up, {-1, 0})}), 0.5, 1e-12);
}

TEST(Covering, LeavesTheRest) {
  EXPECT_NEAR(uncovered_share({}), 1, 1e-12);
  EXPECT_NEAR(uncovered_share({in_texture(low, {0.5, 0}, up)}), 0.5, 1e-12);
  EXPECT_NEAR(uncovered_share({fan()[0], fan()[2]}), 0.375, 1e-12);  // what the second of them covers
  EXPECT_NEAR(uncovered_share({in_texture({0.25, 0.25}, {0.5, 0.25}, {0.25, 0.5})}), 15.0 / 16, 1e-12);
}

/// The hole in one of two sheets is no hole.
TEST(Covering, LeavesNothingWhereAnotherSheetCovers) {
  std::vector<TexturedTriangle> triangles = fan();
  triangles[0] = in_texture(low, right, up);
  EXPECT_NEAR(uncovered_share(triangles), 0, 1e-12);
}

/// Triangles on a coarse grid, of which many touch, overlap or are there twice, turned either way.
std::vector<TexturedTriangle> random_triangles(reference::Random& random) {
  const auto point = [&] { return Eigen::Vector2d((random.below(11) - 1) / 8.0, (random.below(11) - 1) / 8.0); };
  std::vector<TexturedTriangle> triangles;
  for (int k = random.below(8); k >= 0; --k) {
    TexturedTriangle t = in_texture(point(), point(), point());
    if (chart_triangle(t, units).chart != Chart::Area) continue;
    triangles.push_back(t);
    if (random.below(4) == 0) triangles.push_back(t);
  }
  return triangles;
}

/// It does not matter what is known of the triangles across edges.
TEST(Covering, IsTheSameForTrianglesThatAreNotLinked) {
  reference::Random random(11);
  Covering covering;
  int linked = 0, complete = 0;
  for (int run = 0; run < 500; ++run) {
    std::vector<TexturedTriangle> triangles = random_triangles(random);
    if (run % 2 == 0) {  // often covered
      triangles.resize(std::min<std::size_t>(triangles.size(), 1));
      for (const TexturedTriangle& t : fan()) triangles.push_back(t);
    }
    Case with(triangles), without(triangles, false);
    for (const ChartTriangle& t : with.charts) linked += t.across[0] != nullptr ? 1 : 0;
    const auto left = covering.uncovered(with.overlay, with.all), also = covering.uncovered(without.overlay, with.all);
    ASSERT_EQ(left.has_value(), also.has_value()) << run;
    ASSERT_EQ(left ? left->size() : 0, also ? also->size() : 0) << run;
    complete += left && left->empty() ? 1 : 0;
  }
  EXPECT_GT(linked, 100);
  EXPECT_GT(complete, 20);
}

/// A point is in a piece that is left just where it is in no candidate, for points on no line of the grid.
TEST(Covering, LeavesThePointsThatNoCandidateHas) {
  reference::Random random(7);
  int decided = 0;
  for (int run = 0; run < 500; ++run) {
    Case test(random_triangles(random));
    const auto pieces = Covering().uncovered(test.overlay, test.all);
    if (!pieces) continue;
    ++decided;
    for (int k = 0; k < 40; ++k) {
      const std::array<double, 3> weights = {random.uniform(0, 1) + 0x1p-20, random.uniform(0, 1) + 0x1p-20,
                                             random.uniform(0, 1) + 0x1p-20};
      const Overlay::Node point = Overlay::given(weights);
      const bool has_candidate =
          std::any_of(test.all.begin(), test.all.end(), [&](std::uint32_t c) { return test.overlay.covers(c, point); });
      const bool is_left = std::any_of(pieces->begin(), pieces->end(), [&](const Overlay::Polygon& piece) {
        return std::all_of(piece.begin(), piece.end(), [&](const Overlay::PolygonCorner& corner) {
          int inner = 0;
          for (const auto& other : piece)
            if (inner == 0) inner = test.overlay.side(corner.to_next, other.node);
          return test.overlay.side(corner.to_next, point) * inner > 0;
        });
      });
      ASSERT_EQ(is_left, !has_candidate) << run;
    }
  }
  EXPECT_GT(decided, 450);
}

}  // namespace covering_test
}  // namespace meshbound
