// SPDX-License-Identifier: MIT
#include "geometry/prepared_triangle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace prepared_triangle_test {

using namespace meshbound;

TEST(PreparedTriangle, GivesWhatClosestOnTriangleGivesToTheLastBit) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  const auto point = [&](double scale) {
    return Vec3{scale * coordinate(random), scale * coordinate(random), scale * coordinate(random)};
  };
  for (int k = 0; k < 20000; ++k) {
    // Good ones, needles, segments and points.
    const Vec3 ab = point(1), ac = k % 4 == 0   ? point(1)
                                   : k % 4 == 1 ? 0.5 * ab + point(1e-9)
                                   : k % 4 == 2 ? 0.5 * ab
                                                : Vec3{0, 0, 0};
    const CornerTriangle<double> t{point(1), k % 8 == 7 ? Vec3{0, 0, 0} : ab, ac};
    const PreparedTriangle prepared(t);
    for (int i = 0; i < 4; ++i) {
      const Vec3 p = point(2);
      const TriangleOffset<double> expected = closest_on_triangle(t, p), found = prepared.closest(p);
      EXPECT_EQ(found.squared_distance, expected.squared_distance);
      EXPECT_EQ(found.offset.x, expected.offset.x);
      EXPECT_EQ(found.offset.y, expected.offset.y);
      EXPECT_EQ(found.offset.z, expected.offset.z);
      const double squared = expected.squared_distance, less = std::nextafter(squared, 0.0);
      EXPECT_TRUE(prepared.is_within(p, squared));
      EXPECT_FALSE(prepared.is_within(p, less)) << squared;
    }
  }
}

}  // namespace prepared_triangle_test
