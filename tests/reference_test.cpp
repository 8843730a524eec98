// SPDX-License-Identifier: MIT
// The oracles against answers known by hand: a wrong oracle would pass a wrong engine.
#include <gtest/gtest.h>

#include <cmath>

#include "meshbound/distance.h"
#include "reference/brute_force.h"
#include "reference/exact_distance.h"
#include "reference/hard_meshes.h"
#include "reference/point_triangle_cases.h"
#include "reference/small_meshes.h"

namespace meshbound::reference {
namespace reference_test {

using Eigen::Vector3d;

void expect_equal(const ExactLength& length, double value) {
  EXPECT_EQ(length.compare(value), 0) << length.approximate();
}

TEST(ExactDistance, IsExactInEveryRegion) {
  const Corners t = {Vector3d(0, 0, 0), Vector3d(4, 0, 0), Vector3d(0, 3, 0)};
  expect_equal(exact_distance(Vector3d(1, 1, 2), t), 2);            // face
  expect_equal(exact_distance(Vector3d(1, 1, 0), t), 0);            // on the face
  expect_equal(exact_distance(Vector3d(2, -3, 4), t), 5);           // edge
  expect_equal(exact_distance(Vector3d(-2, -3, 6), t), 7);          // corner
  expect_equal(exact_distance(Vector3d(2 + 3, 1.5 + 4, 0), t), 5);  // middle of the hypotenuse
}

TEST(ExactDistance, TakesDegenerateTrianglesAsSegmentsAndPoints) {
  const Vector3d a(0, 0, 0), b(2, 0, 0);
  expect_equal(exact_distance(Vector3d(0, 3, 4), {a, a, a}), 5);
  expect_equal(exact_distance(Vector3d(1, 3, 4), {a, b, b}), 5);
  expect_equal(exact_distance(Vector3d(5, 0, 4), {a, b, a}), 5);
  expect_equal(exact_distance(Vector3d(1.5, 3, 4), {a, Vector3d(1, 0, 0), b}), 5);
}

TEST(ExactDistance, SeesTheLastBitAtAnyScale) {
  for (const double s : {0x1p-530, 1.0, 0x1p515}) {
    const Corners t = {Vector3d(0, 0, 0), Vector3d(s, 0, 0), Vector3d(0, s, 0)};
    const ExactLength one = exact_distance(Vector3d(s / 4, s / 4, s), t);
    EXPECT_EQ(one.compare(s), 0);
    EXPECT_GT(one.compare(std::nextafter(s, 0.0)), 0);
    EXPECT_LT(one.compare(std::nextafter(s, 2 * s)), 0);
    EXPECT_EQ(one.approximate(), s);
    EXPECT_TRUE(one < exact_distance(Vector3d(s / 4, s / 4, std::nextafter(s, 2 * s)), t));
  }
}

TEST(BruteForce, ContainsKnownDistances) {
  const auto expect_contains = [](const Bounds& bounds, double value, double width) {
    EXPECT_LE(bounds.lower, value);
    EXPECT_GE(bounds.upper, value);
    EXPECT_LE(bounds.upper - bounds.lower, width * 1.01);
  };
  expect_contains(brute_force_one_sided(cube(2), cube(1), 1e-3), std::sqrt(3.0), 1e-3);
  expect_contains(brute_force_one_sided(cube(1), cube(2), 0.05), 1, 0.05);
  expect_contains(brute_force_symmetric(cube(1), cube(2), 0.05), std::sqrt(3.0), 0.05);
  const Vector3d a(0, 0, 0), b(4, 0, 0), c(2, 3, 0);
  const TriangleMesh ends = soup({{a, a, a}, {b, b, b}, {c, c, c}});
  expect_contains(brute_force_one_sided(single_triangle(a, b, c), ends, 1e-4), 13.0 / 6, 1e-4);
}

class AnyChoices final : public Choices {
 public:
  explicit AnyChoices(std::uint32_t seed) : random_(seed) {}
  Vector3d point() override { return random_.in_cube(); }
  unsigned below(unsigned n) override { return static_cast<unsigned>(random_.below(static_cast<int>(n))); }

 private:
  Random random_;
};

TEST(HardMesh, HasAboutAsManyTrianglesAsWereAskedForAndIsValid) {
  for (unsigned shape = 0; shape < hard_shapes; ++shape) {
    for (std::uint32_t seed = 0; seed < 200; ++seed) {
      AnyChoices choices(seed);
      const unsigned count = 1 + seed % 20;
      const TriangleMesh mesh = hard_mesh(static_cast<HardShape>(shape), choices, count);
      EXPECT_GE(mesh.triangles.size(), 1U) << shape << ' ' << seed;
      EXPECT_LE(mesh.triangles.size(), count + 2) << shape << ' ' << seed;
      EXPECT_NO_THROW(validate(mesh)) << shape << ' ' << seed;
    }
  }
}

TEST(HardMesh, SeamsAndSoupsAreTheSurfaceThatTheyWereCutFrom) {
  AnyChoices choices(1);
  const TriangleMesh sphere = icosphere(1);
  const TriangleMesh soup = unwelded(sphere), cut = with_seams(sphere, choices);
  EXPECT_EQ(soup.vertices.size(), 3 * sphere.triangles.size());
  EXPECT_GT(cut.vertices.size(), sphere.vertices.size());
  EXPECT_LT(cut.vertices.size(), soup.vertices.size());
  EXPECT_TRUE(same_surface(sphere, soup));
  EXPECT_TRUE(same_surface(sphere, cut));
}

}  // namespace reference_test
}  // namespace meshbound::reference
