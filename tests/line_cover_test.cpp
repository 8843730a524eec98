// SPDX-License-Identifier: MIT
// Bounds of triangles whose texture coordinates lie on a line: by hand, and never below what rational arithmetic finds.
#include "texture/line_cover.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "chart_cases.h"
#include "reference/point_triangle_cases.h"
#include "reference/texture_oracle.h"
#include "textured_shapes.h"

namespace meshbound {
namespace line_cover_test {

using namespace test;
using Corner = test::Corner;

/// All coordinates here are multiples of 2^-70.
constexpr ExactUnits units{-70, -70};

std::optional<double> upper_of(const TexturedTriangle& a, const TexturedMesh& by, double min_upper = 0) {
  const std::vector<ChartTriangle> charts = charts_of(by.triangles, units);
  std::vector<const ChartTriangle*> candidates;
  for (const ChartTriangle& t : charts) candidates.push_back(&t);
  return LineCover(units).upper(chart_triangle(a, units), candidates, min_upper, 1e-6);
}

/// A wall over the unit square of lengths and heights, some way before the plane, under a texture from above.
TexturedMesh wall(int n, double before = 0, const Eigen::Vector2d& way = {1, 0}) {
  return grid(n, [&](double s, double t) { return Corner{{s, -before, t}, s * way}; });
}

/// The lower left half of a wall.
const TexturedTriangle half = triangle({{0, 0, 0}, {0, 0}}, {{1, 0, 0}, {1, 0}}, {{0, 0, 1}, {0, 0}});

TEST(LineCover, IsTheWayBetweenTwoWalls) {
  for (const int n : {1, 3, 8}) {
    const std::optional<double> upper = upper_of(half, wall(n, 0.25));
    ASSERT_TRUE(upper) << n;
    EXPECT_GE(*upper, 0.25) << n;
    EXPECT_NEAR(*upper, 0.25, 1e-12) << n;
    EXPECT_EQ(upper_of(half, wall(n, 0.25), 2), 2) << n;
  }
}

/// Coordinates on a line askew, of which doubles do not know that they are on it.
TEST(LineCover, IsKnownOnAnyLine) {
  for (const Eigen::Vector2d& way : {Eigen::Vector2d(0, 1), Eigen::Vector2d(0.75, 0.25), Eigen::Vector2d(-1, 3)}) {
    TexturedTriangle a = half;
    a.coordinates[1] = way;
    const std::optional<double> upper = upper_of(a, wall(8, 0.5, way));
    ASSERT_TRUE(upper) << way;
    EXPECT_NEAR(*upper, 0.5, 1e-12) << way;
  }
}

TEST(LineCover, IsNotKnownBesideTheLine) {
  TexturedMesh beside = wall(4);
  for (TexturedTriangle& t : beside.triangles)
    for (Eigen::Vector2d& uv : t.coordinates) uv.y() = 0x1p-60;
  EXPECT_EQ(upper_of(half, beside), std::nullopt);
  TexturedMesh askew = wall(4, 0, {1, 1});
  for (TexturedTriangle& t : askew.triangles)
    for (Eigen::Vector2d& uv : t.coordinates) uv.y() = uv.x() == 1 ? 0 : uv.y();  // some corners are on the line
  EXPECT_EQ(upper_of(half, askew), std::nullopt);
}

TEST(LineCover, IsNotKnownAtAHole) {
  for (std::size_t hole = 0; hole < 2; ++hole) {
    TexturedMesh open = wall(8);
    open.triangles.erase(open.triangles.begin() + static_cast<std::ptrdiff_t>(hole));  // at a corner of the triangle
    EXPECT_EQ(upper_of(half, open), std::nullopt);
  }
  TexturedMesh above = wall(8);
  above.triangles.pop_back();  // beyond the triangle
  EXPECT_TRUE(upper_of(half, above));
}

/// A triangle that is a segment in space, and one whose corners have one coordinate each but no way across.
TEST(LineCover, IsNotKnownWithoutAnArea) {
  EXPECT_EQ(upper_of(triangle({{0, 0, 0}, {0, 0}}, {{1, 0, 0}, {1, 0}}, {{0.5, 0, 0}, {0.5, 0}}), wall(2)),
            std::nullopt);
  EXPECT_EQ(upper_of(triangle({{0, 0, 0}, {0, 0}}, {{1, 0, 0}, {1, 0}}, {{0, 0, 0}, {0, 0}}), wall(2)), std::nullopt);
}

/// Triangles of a wall with moved vertices and coordinates that run along it, not at the same pace everywhere.
TexturedMesh random_wall(reference::Random& random, const Eigen::Vector2d& way) {
  constexpr int n = 4;
  Corner corners[n + 1][n + 1];
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j)
      corners[i][j] = {{i + random.below(5) / 16.0, random.below(9) / 16.0, j + random.below(5) / 16.0},
                       (i + random.below(7) / 24.0) * way};
  TexturedMesh mesh;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      if (random.below(60) == 0) continue;
      mesh.triangles.push_back(triangle(corners[i][j], corners[i + 1][j], corners[i + 1][j + 1]));
      mesh.triangles.push_back(triangle(corners[i][j], corners[i + 1][j + 1], corners[i][j + 1]));
    }
  return numbered(mesh);
}

TEST(LineCover, IsNeverBelowTheTruth) {
  reference::Random random(3);
  int known = 0, unknown = 0;
  double nearest = HUGE_VAL;
  for (int run = 0; run < 120; ++run) {
    const Eigen::Vector2d way = run % 3 == 0 ? Eigen::Vector2d(1, 0) : Eigen::Vector2d(1, run % 3 == 1 ? 2 : 0.25);
    const TexturedMesh by = random_wall(random, way);
    const auto corner = [&] {
      const double s = 0.5 + random.below(12) / 4.0, t = 0.5 + random.below(12) / 4.0;
      return Corner{{s, random.below(9) / 16.0, t}, s * way};
    };
    const TexturedTriangle a = triangle(corner(), corner(), corner());
    if (chart_triangle(a, units).chart != Chart::Segment) continue;
    const std::optional<double> upper = upper_of(a, by);
    if (!upper) {
      ++unknown;
      continue;
    }
    ++known;
    double worst = 0;
    for (int k = 0; k < 20; ++k) {
      const int p = random.below(17), q = random.below(17 - p);
      const reference::RationalWeights weights = {mpq_class(p / 16.0), mpq_class(q / 16.0),
                                                  mpq_class((16 - p - q) / 16.0)};
      const auto squared = reference::squared_deviation_at(a, weights, by);
      ASSERT_TRUE(squared) << run;
      ASSERT_LE(reference::compare_root(*squared, *upper), 0) << run;
      worst = std::max(worst, std::sqrt(squared->get_d()));
    }
    nearest = std::min(nearest, *upper - worst);
  }
  EXPECT_GT(known, 60);
  EXPECT_GT(unknown, 5);
  EXPECT_LT(nearest, 1e-3);  // where the worst point is a corner that is looked at
}

/// Walls that are cut in other ways, nine times as many triangles: without such charts each has hundreds of pieces.
TEST(LineCover, SparesPieces) {
  const auto pieces = [](int n) {
    const TextureDeviation found = measured(wall(n), wall(n - 2, 0.01), 1e-4);
    expect_value(found.bounds, 0.01, 1e-4);
    return found.a_to_b.pieces + found.b_to_a.pieces;
  };
  EXPECT_LT(pieces(48), 2 * pieces(16));
}

/// A rough surface whose layers have one texture: a floor, walls under a texture from above, and a height shown by a
/// strip of colours.
TexturedMesh layers(reference::Random& random, int kind, int n) {
  const auto rough = [&] { return random.below(5) / 64.0; };
  TexturedMesh mesh;
  for (int layer = 0; layer <= kind % 2; ++layer) {
    mesh = joined(mesh, grid(n, [&](double s, double t) {
                    Corner corner{{s, t + 0.2 * layer, 0.25 * s * t + 0.3 * layer + rough()}, {s, t}};
                    if (kind / 2 == 1) corner = {{s, 0.1 * layer + rough(), t}, {s, 0.5 * s}};
                    if (kind / 2 == 2) corner.uv = {s + 0.5 * s * t, 0.5};
                    return corner;
                  }));
  }
  return mesh;
}

/// With a tolerance all points of A are compared, by sheets and charts of lines first.
TEST(LineCover, LeavesBoundsOfMeshesRight) {
  reference::Random random(7);
  for (int run = 0; run < 120; ++run) {
    const TexturedMesh a = layers(random, run % 6, 2 + random.below(3)),
                       b = layers(random, run % 6, 2 + random.below(4));
    TextureDeviationOptions options;
    options.tolerance = (1 + random.below(20)) / 32.0;
    options.error_bound = *options.tolerance / 16;
    options.threads = 1;
    const OneSidedTextureDeviation found = texture_deviation(a, b, options).a_to_b;
    EXPECT_LE(found.bounds.lower, found.bounds.upper) << run;
    for (int k = 0; k < 40; ++k) {
      const TexturedTriangle& t =
          a.triangles[static_cast<std::size_t>(random.below(static_cast<int>(a.triangles.size())))];
      const int p = random.below(9), q = random.below(9 - p);
      const reference::RationalWeights weights = {mpq_class(p / 8.0), mpq_class(q / 8.0), mpq_class((8 - p - q) / 8.0)};
      const auto squared = reference::squared_deviation_at(t, weights, b);
      ASSERT_LE(squared ? reference::compare_root(*squared, found.bounds.upper) : 0, 0) << run;
    }
    if (!found.witness) continue;
    const auto& uv = found.witness->coordinate;
    EXPECT_TRUE(uv.allFinite()) << run;
    EXPECT_LE(found.bounds.lower, found.witness->distance * (1 + 1e-9)) << run;
  }
}

}  // namespace line_cover_test
}  // namespace meshbound
