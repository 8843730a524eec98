// SPDX-License-Identifier: MIT
// Texture deviation where triangles have one texture coordinate each, as those of one colour of a palette.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "meshbound/bvh.h"
#include "meshbound/distance.h"
#include "meshbound/texture_deviation.h"
#include "textured_shapes.h"

namespace meshbound {
namespace palette_test {

using namespace test;
using Random = std::mt19937_64;

/// Two colours side by side, the border between them at a line of the grid.
TexturedMesh two_colours(int n, int border, double height) {
  TexturedMesh mesh = grid(n, [=](double s, double t) { return Corner{{s, t, height}, {0, 0}}; });
  for (TexturedTriangle& t : mesh.triangles) {
    const double middle = (t.corners[0] + t.corners[1] + t.corners[2]).x() / 3;
    t.coordinates.fill({middle * n < border ? 0.25 : 0.75, 0.5});
  }
  return mesh;
}

TEST(Palette, DeviatesAsItsColoursDo) {
  const TexturedMesh coarse = two_colours(4, 2, 0), fine = two_colours(32, 16, 0.1), moved = two_colours(32, 18, 0.1);
  expect_value(measured(coarse, fine).bounds, 0.1);
  const TextureDeviation found = measured(coarse, moved);
  const double across = std::hypot(2.0 / 32, 0.1);
  expect_value(found.a_to_b.bounds, across);  // the right colour begins further right
  expect_value(found.b_to_a.bounds, across);  // the left one reaches further right
  ASSERT_TRUE(found.a_to_b.witness);
  EXPECT_EQ(found.a_to_b.witness->coordinate, Eigen::Vector2d(0.75, 0.5));
  EXPECT_NEAR(found.a_to_b.witness->from.position.x(), 0.5, 1e-12);
  EXPECT_NEAR(found.a_to_b.witness->distance, across, 1e-12);
  EXPECT_EQ(coarse.triangles[found.a_to_b.witness->from.triangle].coordinates[0].x(), 0.75);
}

/// A chart has the colour at one point, which is nearer than what has that colour only.
TEST(Palette, TakesAPointOfAChartWhereThatIsNearer) {
  TexturedMesh a, b = two_colours(4, 4, 1);
  a.triangles.push_back(triangle({{0, 0, 0}, {0.25, 0.5}}, {{0.01, 0, 0}, {0.25, 0.5}}, {{0, 0.01, 0}, {0.25, 0.5}}));
  expect_value(measured(numbered(a), b).a_to_b.bounds, 1);
  const TexturedMesh chart = grid(1, [](double s, double t) { return Corner{{s - 0.25, t - 0.5, 0.1}, {s, t}}; });
  expect_value(measured(numbered(a), joined(b, chart)).a_to_b.bounds, std::hypot(0.01, 0.1));
}

TEST(Palette, NamesEachTriangleBeyondTheTolerance) {
  TextureDeviationOptions options;
  options.tolerance = 0.11;
  options.threads = 1;
  const TexturedMesh a = two_colours(32, 16, 0), b = two_colours(32, 18, 0.1);
  const TextureDeviation found = texture_deviation(a, b, options);
  EXPECT_EQ(found.a_to_b.exceeding.size(), 2u * 32u);  // the squares right of the border: from there to 1/16 beyond
  for (const TextureWitness& witness : found.a_to_b.exceeding) {
    EXPECT_GT(witness.distance, 0.11);
    EXPECT_LT(witness.from.position.x(), 0.5 + 1.0 / 32);
  }
}

TriangleMesh surface_of(const TexturedMesh& mesh) {
  TriangleMesh soup;
  for (const TexturedTriangle& t : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.vertices.size());
    soup.vertices.insert(soup.vertices.end(), t.corners.begin(), t.corners.end());
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

/// Triangles of one colour, large and small, far beyond a tolerance and within it: the distance of plain surfaces.
TEST(Palette, OfOneColourDeviatesByThePlainDistance) {
  Random random(5);
  const auto soup_of_one_colour = [&](std::size_t count, double scale) {
    std::uniform_real_distribution<double> at(-1, 1);
    TexturedMesh mesh;
    for (std::size_t i = 0; i < count; ++i) {
      const Eigen::Vector3d middle(at(random), at(random), at(random));
      const double size = std::pow(10, at(random) - 0.5);
      const auto corner = [&] {
        const Eigen::Vector3d away(at(random), at(random), at(random));
        return Corner{scale * (middle + size * away), {0.5, 0.5}};
      };
      mesh.triangles.push_back(triangle(corner(), corner(), corner()));
    }
    return numbered(mesh);
  };
  for (int i = 0; i < 60; ++i) {
    const double scale = i % 12 == 0 ? 0x1p530 : i % 12 == 6 ? 0x1p-530 : 1;  // squares overflow, underflow
    const TexturedMesh a = soup_of_one_colour(8, scale), b = soup_of_one_colour(8, scale);
    TextureDeviationOptions options;
    options.error_bound = 1e-3 * scale;
    options.threads = 1;
    options.tolerance = scale * std::pow(10, std::uniform_real_distribution(-2.0, 0.3)(random));
    const TextureDeviation found = texture_deviation(a, b, options);
    const Bvh surface_of_a(surface_of(a)), surface_of_b(surface_of(b));
    const Bounds truth = one_sided_hausdorff_distance(surface_of_a, surface_of_b).bounds;
    EXPECT_LE(found.a_to_b.bounds.lower, truth.upper);
    EXPECT_GE(found.a_to_b.bounds.upper, truth.lower);
    if (scale != 1) continue;  // witnesses are rounded by plain squares
    for (const TextureWitness& witness : found.a_to_b.exceeding) {
      const Bounds there = closest_point(surface_of_b, witness.from.position).distance;
      EXPECT_LE(witness.distance, there.upper + 1e-12);
      EXPECT_GE(witness.distance, there.lower - 1e-12);
    }
  }
}

}  // namespace palette_test
}  // namespace meshbound
