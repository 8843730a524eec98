// SPDX-License-Identifier: MIT
// Texture deviation where the coordinates of triangles lie on a line, as those of a palette of gradients: each belongs
// to a segment in space. Where coordinates were rounded, these sweep far between coordinates that hardly differ.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "meshbound/texture_deviation.h"
#include "reference/texture_oracle.h"
#include "textured_shapes.h"

namespace meshbound {
namespace gradient_test {

using namespace test;
using Random = std::mt19937_64;

TEST(TexelLength, DoesNotDependOnTheUnit) {
  for (const double unit : {0x1p-500, 0x1p-300, 1.0, 0x1p300, 0x1p500})
    for (const double of_texture : {0x1p-500, 0x1p-300, 0x1p300, 0x1p490}) {
      const TexturedMesh stretched = grid(2, [&](double s, double t) {
        return test::Corner{{unit * 4 * s, unit * 9 * t, 0}, {of_texture * s, of_texture * t}};
      });
      EXPECT_DOUBLE_EQ(texel_length(stretched, 512), unit / of_texture * 6.0 / 512);
    }
  const TexturedMesh strip = grid(2, [](double s, double t) { return test::Corner{{s, t, 0}, {s, 0.5}}; });
  EXPECT_EQ(texel_length(strip, 512), std::numeric_limits<double>::infinity());
}

/// Two coordinates between which no point has weights that are doubles.
constexpr double low = 0, high = 0x1p-200;

/// Two triangles between an edge with one coordinate and an edge with another.
void add_ribbon(TexturedMesh& mesh, const std::array<Eigen::Vector3d, 2>& from, double u,
                const std::array<Eigen::Vector3d, 2>& to, double v) {
  mesh.triangles.push_back(triangle({from[0], {u, 0}}, {to[0], {v, 0}}, {to[1], {v, 0}}));
  mesh.triangles.push_back(triangle({from[0], {u, 0}}, {to[1], {v, 0}}, {from[1], {u, 0}}));
}

/// The edge across the unit square at x, at a height.
std::array<Eigen::Vector3d, 2> across(double x, double height) {
  return {Eigen::Vector3d(x, 0, height), Eigen::Vector3d(x, 1, height)};
}

/// The unit square at a height, its texture coordinates from -1 to 1.
TexturedMesh square(double height) {
  TexturedMesh mesh;
  add_ribbon(mesh, across(0, height), -1, across(1, height), 1);
  return numbered(mesh);
}

/// The square without what lies between the two coordinates.
TexturedMesh parted_square() {
  TexturedMesh mesh;
  add_ribbon(mesh, across(0, 0), -1, across(0.5, 0), low);
  add_ribbon(mesh, across(0.5, 0), high, across(1, 0), 1);
  return mesh;
}

TEST(Gradient, IsFarInAThinGap) {
  const TextureDeviation found = measured(square(0), joined(parted_square(), square(5)), 1e-6);
  expect_value(found.a_to_b.bounds, 5, 1e-6);
  EXPECT_EQ(found.a_to_b.outcome, Outcome::Converged);
  EXPECT_LT(found.a_to_b.pieces, 5000U);
  ASSERT_TRUE(found.a_to_b.witness);
  EXPECT_NEAR(found.a_to_b.witness->distance, 5, 1e-6);
}

/// The square in 2 n^2 triangles, less one in the middle. The coordinate is the same along y.
TexturedMesh holed_square(int n) {
  TexturedMesh mesh;
  const auto corner = [n](int i, int j) {
    const double x = i / double(n);
    return test::Corner{{x, j / double(n), 0}, {2 * x - 1, 0}};
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      mesh.triangles.push_back(triangle(corner(i, j), corner(i + 1, j), corner(i + 1, j + 1)));
      if (i != n / 2 || j != n / 2)
        mesh.triangles.push_back(triangle(corner(i, j), corner(i + 1, j + 1), corner(i, j + 1)));
    }
  return numbered(mesh);
}

/// A facet of a wall in rows of triangles, all with the texture coordinates of two points, and a larger triangle with
/// these coordinates but for their last digits: their lines cross it along one line, which they hardly cross each other
/// on. Cuts that were chosen by rounded places of such points left the same piece over and over.
TEST(Gradient, IsBoundedWhereLinesHardlyCross) {
  const Eigen::Vector2d left(-0.00191055253, -0.000920073605), right(-0.00155447558, -0.00144234256);
  const auto at = [](const Eigen::Vector2d& uv, double z) { return Eigen::Vector3d(uv.x(), uv.y(), z); };
  TexturedMesh wall;
  constexpr int rows = 19;
  constexpr double height = 0.00022321613925321821;
  for (int j = 0; j < rows; ++j) {
    const double low_z = j * height, high_z = (j + 1) * height;
    wall.triangles.push_back(triangle({at(left, low_z), left}, {at(right, low_z), right}, {at(right, high_z), right}));
    wall.triangles.push_back(triangle({at(left, low_z), left}, {at(right, high_z), right}, {at(left, high_z), left}));
  }
  TexturedMesh large;
  large.triangles.push_back(triangle(
      {at(left, 0), left}, {at(right, 0.0015067089399592229), {-0.0015544755800000008, -0.0014423425599999987}},
      {at(left, 0.001213737757189374), {-0.0019105525300000003, -0.00092007360500000006}}));
  const TextureDeviation found = measured(numbered(large), numbered(wall), 1e-5);
  EXPECT_EQ(found.a_to_b.outcome, Outcome::Converged);
  EXPECT_LE(found.a_to_b.bounds.upper, 1e-5);
  EXPECT_LT(found.a_to_b.pieces, 1000U);
}

/// Cuts that only halve come near the edges of the small triangles in steps as small as the error bound.
TEST(Gradient, IsCutAlongEdges) {
  for (const int n : {5, 10}) {
    const TextureDeviation found = measured(square(0), holed_square(n), 1e-6);
    expect_value(found.a_to_b.bounds, 0.5 / n, 1e-6);  // in the middle of the longest way across the hole
    EXPECT_EQ(found.a_to_b.outcome, Outcome::Converged);
    EXPECT_LT(found.a_to_b.pieces, 6U * 2 * static_cast<unsigned>(n * n));
  }
}

/// One candidate rises from the square to 1 above it between the two coordinates, the other one comes down: the nearer
/// one is farthest in the middle.
TEST(Gradient, FollowsCandidatesThroughAThinGap) {
  TexturedMesh b = parted_square();
  add_ribbon(b, across(0.5, 0), low, across(0.5, 1), high);
  add_ribbon(b, across(0.5, 1), low, across(0.5, 0), high);
  const TextureDeviation found = measured(square(0), numbered(b), 1e-6);
  expect_value(found.a_to_b.bounds, 0.5, 1e-6);
  EXPECT_EQ(found.a_to_b.outcome, Outcome::Converged);
  EXPECT_LT(found.a_to_b.pieces, 5000U);
  expect_value(found.b_to_a.bounds, 1, 1e-6);
}

/// The unit square in 2 n^2 triangles, flat in two halves at two depths and a ramp between them.
TexturedMesh fine_step(int n, double depth, double further_depth) {
  TexturedMesh mesh;
  const auto at = [&](int i, int j) {
    const double x = i / static_cast<double>(n);
    return Corner{{x, j / static_cast<double>(n), -(2 * i < n ? depth : further_depth)}, {2 * x - 1, 0}};
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      mesh.triangles.push_back(triangle(at(i, j), at(i + 1, j), at(i + 1, j + 1)));
      mesh.triangles.push_back(triangle(at(i, j), at(i + 1, j + 1), at(i, j + 1)));
    }
  return numbered(mesh);
}

/// Pieces of a large triangle look at those of many that are near them; where the other mesh is beyond the tolerance,
/// near ones do not tell how far. That it is beyond suffices with a tolerance, without one it is told.
TEST(Gradient, OfALargeTriangleIsBoundedNearAndBeyondTheTolerance) {
  TextureDeviationOptions options;
  options.threads = 1;
  options.error_bound = 1e-3;
  for (const double further_depth : {0.02, 0.049, 0.051, 0.12}) {
    const TexturedMesh step = fine_step(20, 0.04, further_depth);
    const bool is_beyond = further_depth > 0.05;
    options.tolerance = 0.05;
    const OneSidedTextureDeviation decided = texture_deviation(square(0), step, options).a_to_b;
    EXPECT_EQ(decided.exceeding.size(), is_beyond ? 2U : 0U);
    EXPECT_EQ(decided.uncovered.upper, 0);
    EXPECT_EQ(decided.bounds.lower > 0.05, is_beyond);
    options.tolerance.reset();
    const Bounds told = texture_deviation(square(0), step, options).a_to_b.bounds;
    expect_value(is_beyond ? told : decided.bounds, std::max(0.04, further_depth), 1e-3);
    EXPECT_LE(decided.bounds.lower, told.upper);
    EXPECT_GE(decided.bounds.upper, told.lower);
  }
}

/// Triangles with few coordinates each, many of them next to each other.
TexturedMesh random_gradients(std::size_t count, Random& random) {
  std::uniform_int_distribution<int> place(0, 4), coarse(0, 2), fine(0, 3);
  TexturedMesh mesh;
  for (std::size_t t = 0; t < count; ++t) {
    const auto corner = [&] {
      const double u = (1 + coarse(random)) / 3.0 + 0x1p-52 * fine(random);
      return Corner{{0.25 * place(random), 0.25 * place(random), 0.25 * place(random)}, {u, 0}};
    };
    mesh.triangles.push_back(triangle(corner(), corner(), corner()));
  }
  return numbered(mesh);
}

/// The point of the triangle on edge `edge` with a coordinate between the two at its ends, and a way to corner `edge`.
reference::RationalWeights weights_between(int edge, int share, int way) {
  reference::RationalWeights weights;
  const mpq_class inner(way, 8), along(share, 8);
  const auto corner = static_cast<std::size_t>(edge);
  weights[corner] = inner;
  weights[(corner + 1) % 3] = (1 - inner) * along;
  weights[(corner + 2) % 3] = (1 - inner) * (1 - along);
  return weights;
}

TEST(Gradient, IsNeverExceededByAPoint) {
  Random random(3);
  std::uniform_int_distribution<int> share(0, 8), edge(0, 2);
  for (int trial = 0; trial < 40; ++trial) {
    const TexturedMesh a = random_gradients(4, random), b = random_gradients(12, random);
    mpq_class furthest = 0;
    for (const TexturedTriangle& t : a.triangles)
      for (int k = 0; k < 60; ++k)
        if (const auto squared =
                reference::squared_deviation_at(t, weights_between(edge(random), share(random), share(random)), b))
          furthest = std::max(furthest, *squared);
    const OneSidedTextureDeviation found = measured(a, b, 1e-3).a_to_b;
    EXPECT_LE(found.bounds.lower, found.bounds.upper);
    EXPECT_LE(reference::compare_root(furthest, found.bounds.upper), 0) << trial;
    EXPECT_NE(found.outcome, Outcome::BudgetExhausted) << trial;
  }
}

/// A piece that all candidates are known of may still be beyond the reach of the near ones: its search starts again and
/// takes in all of them anew. Without those that are not likely it had no end.
TEST(Gradient, LooksAtAllCandidatesWherePiecesAreBeyondReach) {
  Random random(3412);
  const TexturedMesh a = random_gradients(1, random), b = random_gradients(10, random);
  TextureDeviationOptions options;
  options.threads = 1;
  options.error_bound = 1e-3;
  options.max_pieces = 1000;
  const OneSidedTextureDeviation found = texture_deviation(a, b, options).a_to_b;
  EXPECT_EQ(found.outcome, Outcome::Converged);
  EXPECT_LE(found.bounds.upper - found.bounds.lower, 1e-3);
}

/// The only likely candidate of a triangle whose coordinates lie on a line may be far away; another one, which covers
/// the area around, is near.
TEST(Gradient, IsNearATriangleThatHasAnAreaInTheTexture) {
  const auto at = [](double z) { return triangle({{0, 0, z}, {0, 0}}, {{1, 0, z}, {1, 0}}, {{0, 1, z}, {0, 0}}); };
  TexturedMesh a, b;
  a.triangles = {at(0)};
  b.triangles = {triangle({{0, 0, 100}, {-1, -1}}, {{1, 0, 100}, {3, -1}}, {{0, 1, 100}, {0, 3}}), at(1)};
  const OneSidedTextureDeviation found = measured(numbered(a), numbered(b), 1e-6).a_to_b;
  expect_value(found.bounds, 1, 1e-6);
  EXPECT_EQ(found.outcome, Outcome::Converged);
}

/// What a candidate covers of an area may be a segment, and the farthest point is inside of it: at its end another
/// candidate is near.
TEST(Gradient, IsFarInsideOfASegment) {
  const Eigen::Vector2d p(0, 0.2), q(0.25, 0.75);
  const auto above = [](const Eigen::Vector2d& uv, double z) { return test::Corner{{uv.x(), uv.y(), z}, uv}; };
  TexturedMesh a, b;
  a.triangles = {triangle({{0, 0, 0}, {0, 0}}, {{1, 0, 0}, {1, 0}}, {{0, 1, 0}, {0, 1}})};
  b.triangles = {triangle(above(p, 1), above(q, 3), above(p, 1)),
                 triangle(above(q, 0.5), above(q, 0.5), above(q, 0.5))};
  const OneSidedTextureDeviation found = measured(numbered(a), numbered(b), 1e-6).a_to_b;
  expect_value(found.bounds, 3, 1e-6);
  EXPECT_EQ(found.outcome, Outcome::Converged);
}

/// The library takes coordinates whose distance is no double.
TEST(Gradient, OfADistanceBeyondDoublesIsInfinite) {
  const auto at = [](double z) {
    TexturedMesh mesh;
    mesh.triangles = {triangle({{0, 0, z}, {0, 0}}, {{1, 0, z}, {1, 0}}, {{0, 1, z}, {0, 1}})};
    return numbered(mesh);
  };
  EXPECT_EQ(measured(at(1.7e308), at(-1.7e308), 1e-6).a_to_b.bounds.upper, HUGE_VAL);
}

}  // namespace gradient_test
}  // namespace meshbound
