// SPDX-License-Identifier: MIT
// How far faces turn: angles that can be computed by hand, and ties at edges.
#include "meshbound/normal_deviation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "meshbound/error.h"
#include "reference/small_meshes.h"

namespace meshbound {
namespace normal_deviation_test {

/// A square around the z axis, turned by an angle about the x axis.
TriangleMesh square(double degrees, double half = 1) {
  const double angle = degrees / 180 * std::numbers::pi, c = half * std::cos(angle), s = half * std::sin(angle);
  return {{{-half, -c, -s}, {half, -c, -s}, {half, c, s}, {-half, c, s}}, {{0, 1, 2}, {0, 2, 3}}};
}

NormalDeviation measured(const TriangleMesh& a, const TriangleMesh& b, double tolerance = 180, int threads = 1) {
  NormalDeviationOptions options;
  options.tolerance = tolerance;
  options.threads = threads;
  return normal_deviation(a, b, options);
}

TEST(NormalDeviation, IsTheAngleThatASquareIsTurnedBy) {
  const NormalDeviation found = measured(square(0, 0.5), square(30), 29);
  EXPECT_NEAR(found.degrees, 30, 1e-9);
  EXPECT_EQ(found.exceeding.size(), 2U);
  EXPECT_EQ(found.worst->from.triangle, 0U);
  EXPECT_TRUE(measured(square(0, 0.5), square(30), 31).exceeding.empty());
}

TEST(NormalDeviation, OfAMeshAndItselfIsZero) {
  const TriangleMesh cube = reference::cube(1);
  EXPECT_EQ(measured(cube, cube, 0).degrees, 0);
  EXPECT_TRUE(measured(cube, cube, 0).exceeding.empty());
}

TEST(NormalDeviation, OfAFaceThatIsTurnedOverIs180Degrees) {
  TriangleMesh over = square(0);
  for (Triangle& t : over.triangles) std::swap(t[0], t[1]);
  EXPECT_NEAR(measured(square(0), over).degrees, 180, 1e-9);
}

/// The centroid of the face is nearest to an edge, which two faces share: the one that turns least counts.
TEST(NormalDeviation, TakesTheLeastOfFacesThatAreEquallyNear) {
  const TriangleMesh roof{{{0, -1, 0}, {0, 1, 0}, {1, 0, -1}, {-1, 0, -0.25}}, {{0, 2, 1}, {0, 1, 3}}};
  const TriangleMesh above{{{-0.5, -0.5, 1}, {0.5, -0.5, 1}, {0, 1, 1}}, {{0, 1, 2}}};
  const NormalDeviation found = measured(above, roof);
  EXPECT_NEAR(found.degrees, std::atan(0.25) * 180 / std::numbers::pi, 1e-9);
  EXPECT_EQ(found.worst->nearest.triangle, 1U);
}

TEST(NormalDeviation, LeavesOutFacesWithoutArea) {
  TriangleMesh with_line = square(0);
  with_line.triangles.insert(with_line.triangles.begin(), {0, 1, 1});
  EXPECT_NEAR(measured(with_line, square(0)).degrees, 0, 1e-9);
  EXPECT_NEAR(measured(square(0), with_line).degrees, 0, 1e-9);
  const TriangleMesh line{{{0, 0, 0}, {1, 0, 0}}, {{0, 1, 1}}};
  EXPECT_FALSE(measured(line, square(0)).worst);
  EXPECT_THROW((void)measured(square(0), line), InvalidInput);
}

/// Squares of such coordinates overflow or underflow.
TEST(NormalDeviation, DoesNotDependOnTheUnitOfLength) {
  const NormalDeviation plain = measured(square(0, 0.5), square(30));
  for (const double unit : {0x1p-900, 0x1p600}) {
    const NormalDeviation found =
        measured(reference::scaled(square(0, 0.5), unit), reference::scaled(square(30), unit));
    EXPECT_DOUBLE_EQ(found.degrees, plain.degrees);
    EXPECT_TRUE((found.worst->nearest.position / unit).isApprox(plain.worst->nearest.position)) << unit;
  }
}

TEST(NormalDeviation, IsTheSameForAnyNumberOfThreads) {
  const TriangleMesh fine = reference::icosphere(4), coarse = reference::icosphere(2);
  const NormalDeviation one = measured(fine, coarse, 5, 1), four = measured(fine, coarse, 5, 4);
  EXPECT_EQ(one.degrees, four.degrees);
  EXPECT_EQ(one.worst->from.triangle, four.worst->from.triangle);
  EXPECT_EQ(one.exceeding.size(), four.exceeding.size());
  EXPECT_GT(one.degrees, 5);
}

TEST(NormalDeviation, RefusesAToleranceThatIsNone) {
  EXPECT_THROW((void)measured(square(0), square(0), -1), InvalidInput);
  EXPECT_THROW((void)measured(square(0), square(0), std::nan("")), InvalidInput);
}

}  // namespace normal_deviation_test
}  // namespace meshbound
