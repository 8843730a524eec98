// SPDX-License-Identifier: MIT
// Texture deviation of meshes that are points, or larger or smaller than numbers whose squares are numbers.
#include <gtest/gtest.h>

#include "meshbound/texture_deviation.h"
#include "textured_shapes.h"

namespace meshbound {
namespace texture_magnitude_test {

using namespace test;

TEST(TextureDeviation, HasItsWitnessAtAllMagnitudes) {
  for (const double scale : {1e200, 1e160, 1.0, 1e-160, 1e-200}) {
    const auto at_height = [&](double height) {
      return grid(2, [=](double s, double t) { return Corner{scale * Eigen::Vector3d(s, t, height), {s, t}}; });
    };
    const TextureDeviation found = measured(at_height(0), at_height(0.25), 1e-9 * scale);
    ASSERT_TRUE(found.a_to_b.witness) << scale;
    EXPECT_NEAR(found.a_to_b.witness->distance / scale, 0.25, 1e-12) << scale;
    EXPECT_NEAR(found.a_to_b.witness->nearest.position.z() / scale, 0.25, 1e-12) << scale;
  }
}

/// A share of A's size would be 0, which no number of pieces reaches.
TEST(TextureDeviation, OfAPointHasTheErrorBoundOfBothMeshes) {
  const Corner point{{0.3, 0.2, 0}, {1, 1}};
  const TexturedMesh a = numbered({{triangle(point, point, point)}, {}});
  const Eigen::Vector2d all(1, 1);
  const TexturedMesh b =
      numbered({{triangle({{0.948152, 0.18932, 0.638496}, all}, {{0.0946722, 0.185464, 0.731392}, all},
                          {{0.757815, 0.901603, 0.29603}, all}),
                 triangle({{0.1, 0.6, 0.3}, {2, 1}}, {{0.6, 0.9, 0.4}, {1, 1}}, {{0.6, 0.7, 0.1}, {1, 0}})},
                {}});
  const TextureDeviation found = texture_deviation(a, b);
  EXPECT_LT(found.a_to_b.pieces, 1000u);
  EXPECT_EQ(found.a_to_b.outcome, Outcome::Converged);
}

}  // namespace texture_magnitude_test
}  // namespace meshbound
