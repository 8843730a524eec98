// SPDX-License-Identifier: MIT
// closest_point() against exact integer arithmetic: its bounds contain the distance, always, and are tight.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "meshbound/bvh.h"
#include "meshbound/error.h"
#include "reference/exact_distance.h"
#include "reference/small_meshes.h"

namespace meshbound {
namespace {

using Eigen::Vector3d;
using reference::Corners;
using reference::ExactLength;

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// Width that the bounds of a single query may have, in units of epsilon * (size of the triangle + distance): the
/// engine rounds every constant of its error model up (src/numeric/rounding.h). It must stay far below any tolerance.
constexpr double allowed_width = 32768;

/// The same where a direction or a height is mostly rounding: points next to the surface, slivers, needles. The bounds
/// hold there too, but the closest point that the engine constructs may be this far from the true one.
constexpr double allowed_width_next_to_surface = 0x1p13;

class Random {
 public:
  explicit Random(std::uint32_t seed) : engine_(seed) {}
  double uniform(double low, double high) { return low + (high - low) * static_cast<double>(engine_()) / 4294967296.0; }
  int below(int n) { return static_cast<int>(engine_() % static_cast<std::uint32_t>(n)); }
  Vector3d in_cube() { return {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)}; }
  double power_of_ten(double low, double high) { return std::pow(10.0, uniform(low, high)); }
  double sign() { return below(2) == 0 ? -1 : 1; }

 private:
  std::mt19937 engine_;
};

struct Configuration {
  Corners triangle;
  Vector3d query;
};

double size_of(const Corners& t) {
  double size = 0;
  for (const Vector3d& corner : t) size = std::max(size, (corner - t[0]).cwiseAbs().maxCoeff());
  return size;
}

std::string describe(const Configuration& c) {
  std::ostringstream text;
  text << std::hexfloat;
  for (const Vector3d& v : c.triangle) text << '(' << v.x() << ' ' << v.y() << ' ' << v.z() << ") ";
  text << "query (" << c.query.x() << ' ' << c.query.y() << ' ' << c.query.z() << ')';
  return text.str();
}

/// The claim itself; `allowed` is the width that the bounds may have, in the unit of `allowed_width`.
void check(const Configuration& c, double allowed = allowed_width) {
  const auto [p, q, r] = c.triangle;
  const Bvh bvh(reference::single_triangle(p, q, r), {1});
  const ClosestPoint answer = closest_point(bvh, c.query);
  const ExactLength exact = reference::exact_distance(c.query, c.triangle);
  const double distance = exact.approximate();
  EXPECT_GE(exact.compare(answer.distance.lower), 0)
      << describe(c) << " lower " << answer.distance.lower << " > " << distance;
  EXPECT_LE(exact.compare(answer.distance.upper), 0)
      << describe(c) << " upper " << answer.distance.upper << " < " << distance;
  const double unit = epsilon * (size_of(c.triangle) + distance) + 4 * std::numeric_limits<double>::denorm_min();
  const double width = (answer.distance.upper - answer.distance.lower) / unit;
  EXPECT_LE(width, allowed) << describe(c) << " distance " << distance;
}

void check_many(std::uint32_t seed, int count, const std::function<Configuration(Random&)>& make,
                double allowed = allowed_width) {
  Random random(seed);
  for (int i = 0; i < count && !testing::Test::HasFailure(); ++i) check(make(random), allowed);
}

Configuration generic(Random& random) {
  return {{random.in_cube(), random.in_cube(), random.in_cube()}, 2 * random.in_cube()};
}

Vector3d inside(Random& random, const Corners& t) {
  const double u = random.uniform(0, 1), v = random.uniform(0, 1 - u);
  return t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]);
}

/// Corners almost or exactly on a line, at any ratio of height to length.
Corners sliver(Random& random) {
  const Vector3d a = random.in_cube(), b = random.in_cube();
  const Vector3d between = a + random.uniform(-0.2, 1.2) * (b - a);
  return {a, b, between + random.power_of_ten(-18, -2) * random.in_cube()};
}

Corners needle(Random& random) {
  const Vector3d a = random.in_cube();
  return {a, a + random.power_of_ten(-18, -2) * random.in_cube(), random.in_cube()};
}

TEST(PointTriangleBounds, ContainTheDistanceOfRandomPoints) { check_many(1, 40000, generic); }

TEST(PointTriangleBounds, ContainTheDistanceOfPointsNearTheSurface) {
  check_many(
      2, 10000,
      [](Random& random) {
        Configuration c = generic(random);
        c.query = inside(random, c.triangle) + random.power_of_ten(-20, -1) * random.in_cube();
        return c;
      },
      allowed_width_next_to_surface);
}

TEST(PointTriangleBounds, ContainTheDistanceToSlivers) {
  check_many(
      3, 10000,
      [](Random& random) {
        return Configuration{sliver(random), random.in_cube()};
      },
      allowed_width_next_to_surface);
  check_many(
      4, 10000,
      [](Random& random) {
        const Corners t = sliver(random);
        return Configuration{t, inside(random, t) + random.power_of_ten(-18, 0) * random.in_cube()};
      },
      allowed_width_next_to_surface);
}

TEST(PointTriangleBounds, ContainTheDistanceToNeedles) {
  check_many(
      5, 10000,
      [](Random& random) {
        return Configuration{needle(random), random.in_cube()};
      },
      allowed_width_next_to_surface);
  check_many(
      6, 5000,
      [](Random& random) {
        const Corners t = needle(random);
        return Configuration{t, inside(random, t) + random.power_of_ten(-18, 0) * random.in_cube()};
      },
      allowed_width_next_to_surface);
}

TEST(PointTriangleBounds, ContainTheDistanceToZeroAreaTriangles) {
  check_many(7, 6000, [](Random& random) {
    const Vector3d a = random.in_cube(), b = random.in_cube();
    const std::array<Corners, 4> shapes = {Corners{a, a, a}, Corners{a, b, b}, Corners{a, b, a},
                                           Corners{a, b, a + 0.5 * (b - a)}};
    return Configuration{shapes[static_cast<std::size_t>(random.below(4))], random.in_cube()};
  });
}

TEST(PointTriangleBounds, ContainTheDistanceOnIntegerGrids) {
  // Small integers hit every tie: coplanar and coincident points, bisectors, corners, edges, collinear corners.
  check_many(8, 10000, [](Random& random) {
    const auto grid = [&random] { return Vector3d(random.below(4), random.below(4), random.below(2)); };
    return Configuration{{grid(), grid(), grid()}, grid()};
  });
}

TEST(PointTriangleBounds, ContainTheDistanceOfPointsOnTheBoundariesOfRegions) {
  check_many(9, 6000, [](Random& random) {
    const Corners t = {random.in_cube(), random.in_cube(), random.in_cube()};
    const Vector3d normal = (t[1] - t[0]).cross(t[2] - t[0]);
    const Vector3d outward = (t[1] - t[0]).cross(normal);
    const std::array<Vector3d, 3> bases = {t[0], 0.5 * (t[0] + t[1]), t[1]};
    const Vector3d base = bases[static_cast<std::size_t>(random.below(3))];
    const double up = random.below(2) * random.uniform(-2, 2), out = random.below(2) * random.uniform(-1, 1);
    return Configuration{t, base + up * normal + out * outward};
  });
}

TEST(PointTriangleBounds, ContainTheDistanceAtAnyScale) {
  check_many(10, 6000, [](Random& random) {
    Configuration c = generic(random);
    const double scale = random.power_of_ten(-160, 155);
    for (Vector3d& corner : c.triangle) corner *= scale;
    c.query *= scale;
    return c;
  });
}

TEST(PointTriangleBounds, ContainTheDistanceBetweenDifferentScales) {
  check_many(11, 4000, [](Random& random) {
    Configuration c = generic(random);
    const double scale = random.power_of_ten(-160, 155), far = scale * random.power_of_ten(-30, 0);
    for (Vector3d& corner : c.triangle) corner *= scale;
    c.query *= far;
    return c;
  });
  check_many(12, 4000, [](Random& random) {
    Configuration c = generic(random);
    const double scale = random.power_of_ten(-160, 100);
    for (Vector3d& corner : c.triangle) corner *= scale;
    c.query *= scale * random.power_of_ten(0, 55);
    return c;
  });
}

TEST(PointTriangleBounds, ContainTheDistanceAtLargeOffsets) {
  check_many(13, 6000, [](Random& random) {
    Configuration c = generic(random);
    const Vector3d offset = random.power_of_ten(6, 12) * Vector3d(random.sign(), random.sign(), random.uniform(-1, 1));
    for (Vector3d& corner : c.triangle) corner += offset;
    c.query += offset;
    return c;
  });
}

TEST(PointTriangleBounds, ContainTheDistanceNextToTheSubnormals) {
  check_many(14, 2000, [](Random& random) {
    Configuration c = generic(random);
    const double scale = random.power_of_ten(-322, -300);
    for (Vector3d& corner : c.triangle) corner *= scale;
    c.query *= scale;
    return c;
  });
}

TEST(PointTriangleBounds, AreExactlyZeroOnCorners) {
  Random random(15);
  for (int i = 0; i < 1000; ++i) {
    const Configuration c = generic(random);
    const Bvh bvh(reference::single_triangle(c.triangle[0], c.triangle[1], c.triangle[2]), {1});
    for (const Vector3d& corner : c.triangle) EXPECT_EQ(closest_point(bvh, corner).distance.lower, 0);
  }
}

TEST(ClosestPoint, FindsTheNearestOfManyTriangles) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    const TriangleMesh mesh = reference::random_soup(seed, 60, seed % 2 == 0 ? 0.05 : 0.5);
    const Bvh bvh(mesh);
    Random random(seed + 100);
    for (int i = 0; i < 40; ++i) {
      const Vector3d query = 2 * random.in_cube();
      const ClosestPoint answer = closest_point(bvh, query);
      const ExactLength exact = reference::exact_distance(query, mesh);
      EXPECT_GE(exact.compare(answer.distance.lower), 0);
      EXPECT_LE(exact.compare(answer.distance.upper), 0);
      EXPECT_LE(answer.distance.upper - answer.distance.lower, 4e-12);
      ASSERT_LT(answer.point.triangle, mesh.triangles.size());
      const ExactLength off =
          reference::exact_distance(answer.point.position, reference::corners(mesh, answer.point.triangle));
      EXPECT_LE(off.compare(1e-14), 0) << "the closest point is not on the triangle that it names";
      EXPECT_NEAR((answer.point.position - query).norm(), exact.approximate(), 1e-13);
    }
  }
}

TEST(ClosestPoint, RefusesQueriesThatAreNotFinite) {
  const Bvh bvh(reference::cube(1));
  EXPECT_THROW((void)closest_point(bvh, Vector3d(0, std::nan(""), 0)), InvalidInput);
  EXPECT_THROW((void)closest_point(bvh, Vector3d(0, 0, std::numeric_limits<double>::infinity())), InvalidInput);
  EXPECT_THROW((void)closest_point(bvh, Vector3d(4 * largest_coordinate, 0, 0)), InvalidInput);
}

}  // namespace
}  // namespace meshbound
