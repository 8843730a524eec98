// SPDX-License-Identifier: MIT
// Triangles that share an edge in space and in the texture.
#include "texture/chart_edges.h"

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "chart_cases.h"
#include "reference/point_triangle_cases.h"

namespace meshbound {
namespace chart_edges_test {

constexpr ExactUnits units{-6, 0};

/// Triangles of a mesh, linked.
struct Case {
  explicit Case(std::vector<TexturedTriangle> of) : triangles(std::move(of)) { link_across_edges(charts); }
  /// The number of the triangle across an edge; -1 if there is none.
  [[nodiscard]] int across(std::size_t triangle, std::size_t corner) const {
    const ChartTriangle* other = charts[triangle].across[corner];
    return other == nullptr ? -1 : static_cast<int>(other - charts.data());
  }
  std::vector<TexturedTriangle> triangles;
  std::vector<ChartTriangle> charts = charts_of(triangles, units);
};

const Eigen::Vector2d low(0, 0), right(1, 0), up(0, 1), both(1, 1);

TEST(ChartEdges, JoinTwoTriangles) {
  const Case square({in_texture(low, right, up), in_texture(right, both, up)});
  EXPECT_EQ(square.across(0, 0), 1);
  EXPECT_EQ(square.across(1, 1), 0);
  for (const auto& [t, k] : {std::pair(0, 1), std::pair(0, 2), std::pair(1, 0), std::pair(1, 2)})
    EXPECT_EQ(square.across(static_cast<std::size_t>(t), static_cast<std::size_t>(k)), -1);
}

/// Which way round their corners go does not matter, nor the sign of a zero.
TEST(ChartEdges, JoinMirroredTriangles) {
  const Case square({in_texture(low, right, both), in_texture(up, both, {-0.0, -0.0})});
  EXPECT_EQ(square.across(0, 1), 1);
  EXPECT_EQ(square.across(1, 0), 0);
}

TEST(ChartEdges, DoNotJoinWhatLiesOnOneSide) {
  const Case fold({in_texture(low, right, up), in_texture(low, right, both)});
  for (std::size_t t = 0; t < 2; ++t)
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(fold.across(t, k), -1) << t << k;
}

TEST(ChartEdges, DoNotJoinMoreThanTwo) {
  for (const TexturedTriangle& third : {in_texture(right, both, up), in_texture(low, right, up)}) {
    const Case three({in_texture(low, right, up), in_texture(right, both, up), third});
    for (std::size_t t = 0; t < 3; ++t)
      for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(three.across(t, k), -1) << t << k;
  }
}

TEST(ChartEdges, DoNotJoinMaterials) {
  const Case square({in_texture(low, right, up), in_texture(right, both, up, 0, 1)});
  EXPECT_EQ(square.across(0, 0), -1);
  EXPECT_EQ(square.across(1, 1), -1);
}

/// Two sheets with the same texture, as where a chart serves both sides of a model: each has its own edges.
TEST(ChartEdges, JoinWithinEachSheet) {
  const Case sheets({in_texture(low, right, up), in_texture(right, both, up), in_texture(low, right, up, 1),
                     in_texture(up, both, right, 1)});
  EXPECT_EQ(sheets.across(0, 0), 1);
  EXPECT_EQ(sheets.across(1, 1), 0);
  EXPECT_EQ(sheets.across(2, 0), 3);
  EXPECT_EQ(sheets.across(3, 1), 2);
}

TEST(ChartEdges, DoNotJoinAcrossASeam) {
  std::vector<TexturedTriangle> triangles = {in_texture(low, right, up), in_texture(right, both, up)};
  for (Eigen::Vector2d& uv : triangles[1].coordinates) uv.x() += 2;
  EXPECT_EQ(Case(triangles).across(0, 0), -1);
}

/// The edge between them is a seam, though another edge of the neighbour has the same ends in the texture.
TEST(ChartEdges, DoNotJoinOtherEdgesThanTheCommonOne) {
  std::vector<TexturedTriangle> triangles = {in_texture(low, right, up), in_texture(right, both, up)};
  triangles[1].coordinates = {up, right, both};  // the edge from both to up, in space, has them
  const Case test(triangles);
  for (std::size_t t = 0; t < 2; ++t)
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(test.across(t, k), -1) << t << k;
}

/// Edges come in pairs, whatever lies where: a covering counts on that.
TEST(ChartEdges, AreMutual) {
  reference::Random random(8);
  const auto number = [&] { return random.below(3) / 2.0; };
  int joined = 0;
  for (int run = 0; run < 2000; ++run) {
    std::vector<TexturedTriangle> triangles;
    for (int k = 0; k < 8; ++k) {
      TexturedTriangle& t = triangles.emplace_back();
      for (std::size_t i = 0; i < 3; ++i) {
        t.corners[i] = {number(), number(), 0};
        t.coordinates[i] = random.below(4) == 0 ? Eigen::Vector2d(number(), number()) : t.corners[i].head<2>();
      }
    }
    const Case test(triangles);
    using Ends = std::array<Eigen::Vector2d, 2>;
    const auto ends_of = [&](std::size_t t, std::size_t k) {  // with the triangle on the left
      const auto& uv = triangles[t].coordinates;
      const Ends ends = {uv[(k + 1) % 3], uv[(k + 2) % 3]};
      return test.charts[t].turned ? Ends{ends[1], ends[0]} : ends;
    };
    for (std::size_t t = 0; t < triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        const int other = test.across(t, k);
        if (other < 0) continue;
        ++joined;
        const Ends ends = ends_of(t, k), back = {ends[1], ends[0]};
        int partners = 0;
        for (std::size_t j = 0; j < 3; ++j) {
          const auto o = static_cast<std::size_t>(other);
          if (test.across(o, j) == static_cast<int>(t) && ends_of(o, j) == back) ++partners;
        }
        ASSERT_EQ(partners, 1) << run;
      }
  }
  EXPECT_GT(joined, 200);
}

/// The edge is the same in the texture only.
TEST(ChartEdges, DoNotJoinWhatIsApartInSpace) {
  const Case square({in_texture(low, right, up), in_texture(right, both, up, 1)});
  EXPECT_EQ(square.across(0, 0), -1);
}

TEST(ChartEdges, LeaveTrianglesWithoutArea) {
  const Case flat({in_texture(low, right, up), in_texture(right, {0.5, 0.5}, up)});
  EXPECT_EQ(flat.across(0, 0), -1);
}

/// As found by comparing each edge with all others, on a coarse grid where edges are often shared.
TEST(ChartEdges, AreThoseOfAllPairs) {
  reference::Random random(3);
  const auto point = [&] { return Eigen::Vector2d(random.below(4) / 4.0, random.below(4) / 4.0); };
  int joined = 0;
  for (int run = 0; run < 1000; ++run) {
    std::vector<TexturedTriangle> triangles;
    for (int k = 0; k < 12; ++k) {
      const int material = random.below(2);
      triangles.push_back(in_texture(point(), point(), point(), material, static_cast<std::uint32_t>(material)));
    }
    const Case test(triangles);
    using Key = std::tuple<std::uint32_t, double, double, double, double>;
    std::map<Key, std::vector<std::pair<std::size_t, bool>>> users;  // each with the side that it is on
    const auto ends_of = [&](std::size_t t, std::size_t k) {
      const auto& uv = triangles[t].coordinates;
      auto ends = std::pair(uv[(k + 1) % 3], uv[(k + 2) % 3]);
      const bool is_turned = test.charts[t].turned;
      const bool is_back = std::tie(ends.second.x(), ends.second.y()) < std::tie(ends.first.x(), ends.first.y());
      if (is_back) std::swap(ends.first, ends.second);
      return std::pair(Key(triangles[t].material, ends.first.x(), ends.first.y(), ends.second.x(), ends.second.y()),
                       is_back != is_turned);
    };
    for (std::size_t t = 0; t < triangles.size(); ++t)
      for (std::size_t k = 0; test.charts[t].chart == Chart::Area && k < 3; ++k) {
        const auto [key, side] = ends_of(t, k);
        users[key].emplace_back(t, side);
      }
    for (std::size_t t = 0; t < triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        int expected = -1;
        if (test.charts[t].chart == Chart::Area) {
          const auto& all = users[ends_of(t, k).first];
          if (all.size() == 2 && all[0].second != all[1].second)
            expected = static_cast<int>(all[0].first == t ? all[1].first : all[0].first);
        }
        ASSERT_EQ(test.across(t, k), expected) << run;
        joined += expected >= 0 ? 1 : 0;
      }
  }
  EXPECT_GT(joined, 500);
}

}  // namespace chart_edges_test
}  // namespace meshbound
