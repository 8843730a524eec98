// SPDX-License-Identifier: MIT
// Limits of time: what a token makes of any number of seconds, and that no function takes seconds that are none.
#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <vector>

#include "meshbound/certificate.h"
#include "meshbound/distance.h"
#include "meshbound/error.h"
#include "meshbound/level_checker.h"
#include "meshbound/lod_chain.h"
#include "meshbound/penetration_depth.h"
#include "meshbound/scene.h"
#include "meshbound/similarity.h"
#include "meshbound/simplify.h"
#include "meshbound/stop_token.h"
#include "meshbound/tiles.h"
#include "meshbound/view_levels.h"
#include "reference/small_meshes.h"

namespace meshbound {
namespace time_limits_test {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::array no_seconds = {-1.0, -1e300, -infinity, std::numeric_limits<double>::quiet_NaN()};

TEST(StopToken, HasADeadlineForEveryNumberOfSeconds) {
  const auto from = StopToken::Clock::now();
  const auto deadline = [&](double seconds) { return StopToken{}.until(from, seconds).deadline; };
  for (const double seconds : {0.0, -1.0, -1e10, -1e300, -infinity, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_EQ(deadline(seconds), from) << seconds;
  EXPECT_EQ(deadline(2), from + std::chrono::seconds(2));
  for (const double seconds : {1e9, 1e300, infinity}) EXPECT_EQ(deadline(seconds), StopToken::Clock::time_point::max());
}

/// Every function that has a limit of time refuses the same numbers, also where it would not have looked at them.
TEST(TimeLimits, AreRefusedWhereTheyAreNegativeOrNoNumber) {
  const TriangleMesh cube = reference::cube(1), larger = reference::cube(2);
  const Bvh tree(cube), other(larger);
  const ClosedModel model(cube);
  const Shape shape(cube);
  const std::vector<TriangleMesh> models{cube};
  LevelChecker checker(cube);
  Scene scene;
  scene.add(model);
  for (const double seconds : no_seconds) {
    DistanceOptions distance;
    distance.budget.seconds = seconds;
    EXPECT_THROW((void)hausdorff_distance(cube, cube, distance), InvalidInput);
    EXPECT_THROW((void)hausdorff_distance(cube, larger, distance), InvalidInput);
    EXPECT_THROW((void)hausdorff_distance(tree, other, distance), InvalidInput);
    EXPECT_THROW((void)one_sided_hausdorff_distance(tree, other, distance), InvalidInput);
    EXPECT_THROW((void)check_tolerance(cube, cube, 1, distance), InvalidInput);
    EXPECT_THROW((void)check_tolerance(tree, other, 1, distance), InvalidInput);
    EXPECT_THROW((void)check_one_sided_tolerance(tree, other, 1, distance), InvalidInput);
    EXPECT_THROW((void)checker.check(larger, 1, distance), InvalidInput);
    EXPECT_THROW((void)checker.measure(larger, distance), InvalidInput);
    EXPECT_THROW((void)scene.check_tolerance(1, distance), InvalidInput);
    EXPECT_THROW((void)hausdorff_distance_in_tiles(cube, larger, distance), InvalidInput);
    SimilarityOptions similarity;
    similarity.distance = distance;
    EXPECT_THROW((void)nearest_shapes(shape, {}, similarity), InvalidInput);
    PenetrationOptions penetration;
    penetration.budget.seconds = seconds;
    EXPECT_THROW((void)penetration_depth(model, model, penetration), InvalidInput);
    EXPECT_THROW((void)scene.contacts(penetration), InvalidInput);
    CertificateOptions certificate;
    certificate.seconds = seconds;
    EXPECT_THROW((void)build_certificate(cube, cube, 0.1, certificate), InvalidInput);
    SimplifyOptions simplify;
    simplify.time_limit = seconds;
    EXPECT_THROW(LodChain(cube, simplify), InvalidInput);
    ViewOptions view;
    view.lod = simplify;
    EXPECT_THROW((void)view_levels(models, {}, {}, view), InvalidInput);
    simplify.tolerance = 0.1;
    EXPECT_THROW((void)simplify_with_bound(cube, simplify), InvalidInput);
    EXPECT_THROW((void)simplify_in_tiles(cube, simplify), InvalidInput);
  }
}

}  // namespace time_limits_test
}  // namespace meshbound
