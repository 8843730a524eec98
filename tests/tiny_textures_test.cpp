// SPDX-License-Identifier: MIT
// Texture deviation of meshes whose coordinates are a few thousand steps of the smallest double: what it is at any
// other size, to a step.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "meshbound/error.h"
#include "texture/texture_comparison.h"
#include "textured_shapes.h"

namespace meshbound {
namespace tiny_textures_test {

using namespace test;

constexpr double step = std::numeric_limits<double>::denorm_min();

/// A wavy sheet of n x n squares, 20,000 units wide, whose coordinates are whole units.
TexturedMesh sheet(int n, double unit) {
  return grid(n, [unit](double s, double t) {
    const double height = std::floor(2000 * std::sin(9 * s + 5 * t));
    return Corner{{std::floor(20000 * s) * unit, std::floor(20000 * t) * unit, height * unit}, {s, t}};
  });
}

/// The error bound of 0 is what a small share of such a mesh rounds to.
TextureDeviationOptions options(double unit) {
  TextureDeviationOptions options;
  options.error_bound = 1e-6 * unit;
  options.max_pieces = 2000;
  options.threads = 1;
  return options;
}

void expect_same(const OneSidedTextureDeviation& tiny, const OneSidedTextureDeviation& usual) {
  EXPECT_EQ(tiny.outcome, Outcome::Converged);
  EXPECT_EQ(tiny.bounds.lower, std::floor(usual.bounds.lower) * step);
  EXPECT_EQ(tiny.bounds.upper, std::ceil(usual.bounds.upper) * step);
  ASSERT_TRUE(tiny.witness);
  EXPECT_NEAR(((tiny.witness->from.position - tiny.witness->nearest.position) / step).norm(), usual.bounds.lower, 2);
}

TEST(TinyTextures, AreMeasuredToAStepOfTheSmallestDouble) {
  const TextureDeviation usual = texture_deviation(sheet(6, 1), sheet(4, 1), options(1));
  ASSERT_EQ(usual.a_to_b.outcome, Outcome::Converged);
  const TextureDeviation tiny = texture_deviation(sheet(6, step), sheet(4, step), options(step));
  expect_same(tiny.a_to_b, usual.a_to_b);
  expect_same(tiny.b_to_a, usual.b_to_a);
  TextureComparison comparison;
  for (int time = 0; time < 2; ++time)
    EXPECT_EQ(comparison.measure({sheet(6, step), sheet(4, step)}, options(step)).bounds.upper, tiny.bounds.upper);
}

TEST(TinyTextures, ListWhatIsBeyondTheTolerance) {
  TextureDeviationOptions with_tolerance = options(step);
  with_tolerance.tolerance = 300 * step;
  const TextureDeviation found = texture_deviation(sheet(6, step), sheet(4, step), with_tolerance);
  EXPECT_FALSE(found.a_to_b.exceeding.empty());
  for (const TextureWitness& witness : found.a_to_b.exceeding) EXPECT_GT(witness.distance, 290 * step);
  with_tolerance.tolerance = std::numeric_limits<double>::max();
  EXPECT_TRUE(texture_deviation(sheet(6, step), sheet(4, step), with_tolerance).a_to_b.exceeding.empty());
  with_tolerance.tolerance = -step;
  EXPECT_THROW((void)texture_deviation(sheet(6, step), sheet(4, step), with_tolerance), InvalidInput);
}

}  // namespace tiny_textures_test
}  // namespace meshbound
