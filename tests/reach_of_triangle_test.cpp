// SPDX-License-Identifier: MIT
// What lies within a distance of a triangle, for guides.
#include "simplify/cover/reach_of_triangle.h"

#include <gtest/gtest.h>

#include <random>

namespace meshbound {
namespace reach_of_triangle_test {

using Corners = std::array<Vec3, 3>;

constexpr double distance = 0.1;

/// The reach of needles, of compact triangles and of triangles without area, and triangles with one corner just within
/// the distance.
TEST(ReachOfTriangle, MeetsWhatIsWithinTheDistance) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> anywhere(-1, 1), share(0, 1);
  const auto point = [&] { return Vec3{anywhere(random), anywhere(random), anywhere(random)}; };
  for (int i = 0; i < 20000; ++i) {
    Corners it{point(), point(), point()};
    if (i % 2 == 0) it[2] = it[0] + 1e-3 * (it[2] - it[0]);
    if (i % 7 == 0) it[1] = it[0];
    const double a = share(random), b = (1 - a) * share(random);
    const Vec3 inside = it[0] + a * (it[1] - it[0]) + b * (it[2] - it[0]), away = point();
    const Vec3 near = inside + 0.999 * distance / length(away) * away;
    EXPECT_TRUE(ReachOfTriangle(it, distance).meets({{near, near + away, near + 3.0 * away}})) << i;
    EXPECT_TRUE(ReachOfTriangle(it, distance).meets({{near - away, near - away, near + away}})) << i;
  }
}

/// Their boxes are one.
TEST(ReachOfTriangle, TellsNeedlesBesideEachOtherApart) {
  const Corners needle{{{0, 0, 0}, {10, 10, 10}, {10, 10.01, 10}}};
  const auto beside = [&](double by) {
    const Vec3 away{0, by, 0};
    return Corners{{needle[0] + away, needle[1] + away, needle[2] + away}};
  };
  const ReachOfTriangle reach(needle, distance);
  EXPECT_TRUE(reach.meets(beside(0.05)));
  EXPECT_TRUE(reach.meets(beside(-0.05)));
  EXPECT_FALSE(reach.meets(beside(0.5)));
  EXPECT_FALSE(reach.meets(beside(-0.5)));
  EXPECT_FALSE(reach.meets({{{20, 20, 20}, {30, 30, 30}, {30, 30.01, 30}}}));
}

}  // namespace reach_of_triangle_test
}  // namespace meshbound
