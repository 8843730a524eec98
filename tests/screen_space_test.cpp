// SPDX-License-Identifier: MIT
#include "meshbound/screen_space.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "meshbound/error.h"

namespace meshbound {
namespace screen_space_test {

constexpr double right_angle = std::numbers::pi / 2;

/// At 90 degrees and distance 540 a screen of 1080 pixels shows 1080 units: a pixel is a unit.
TEST(ScreenSpace, GivesTheLengthThatCoversThePixels) {
  EXPECT_NEAR(screen_space_tolerance({1080, right_angle}, 1, 540), 1, 1e-12);
  EXPECT_NEAR(screen_space_tolerance({1080, right_angle}, 0.5, 540), 0.5, 1e-12);
  EXPECT_NEAR(screen_space_tolerance({2160, right_angle}, 1, 540), 0.5, 1e-12);
  EXPECT_NEAR(screen_space_tolerance({1080, std::numbers::pi / 3}, 1, 540), std::tan(std::numbers::pi / 6), 1e-12);
}

/// Projects both ends of the length with a pinhole camera, without the formula.
TEST(ScreenSpace, AgreesWithAPinholeCamera) {
  const Screen screen{720, 0.8};
  const double distance = 37, focal = 360 / std::tan(0.4);
  const double tolerance = screen_space_tolerance(screen, 1.5, distance);
  const double y = 3;
  EXPECT_NEAR(focal * (y + tolerance) / distance - focal * y / distance, 1.5, 1e-9);
}

TEST(ScreenSpace, KeepsTheOrderOfTheDistancesAndInverts) {
  const Screen screen{1080, 1};
  const std::vector<double> distances = {10, 2, 50};
  const std::vector<double> tolerances = screen_space_tolerances(screen, 1, distances);
  ASSERT_EQ(tolerances.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(tolerances[i], screen_space_tolerance(screen, 1, distances[i]));
    EXPECT_NEAR(min_view_distance(screen, 1, tolerances[i]), distances[i], 1e-12 * distances[i]);
  }
  EXPECT_EQ(min_view_distance(screen, 1, 0), 0);
}

TEST(ScreenSpace, RefusesWhatIsNoView) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  for (const double wrong : {0.0, -1.0, nan, infinity}) {
    EXPECT_THROW((void)screen_space_tolerance({1080, 1}, wrong, 1), InvalidInput);
    EXPECT_THROW((void)screen_space_tolerance({1080, 1}, 1, wrong), InvalidInput);
    EXPECT_THROW((void)screen_space_tolerance({wrong, 1}, 1, 1), InvalidInput);
    EXPECT_THROW((void)screen_space_tolerance({1080, wrong}, 1, 1), InvalidInput);
  }
  EXPECT_THROW((void)screen_space_tolerance({1080, std::numbers::pi}, 1, 1), InvalidInput);
  EXPECT_THROW((void)min_view_distance({1080, 1}, 1, -1), InvalidInput);
  EXPECT_THROW((void)min_view_distance({1080, 1}, 1, nan), InvalidInput);
}

}  // namespace screen_space_test
}  // namespace meshbound
