// SPDX-License-Identifier: MIT
// closest_point() against exact integer arithmetic: its bounds contain the distance, always, and are tight.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <limits>
#include <mutex>
#include <sstream>
#include <thread>

#include "meshbound/bvh.h"
#include "meshbound/error.h"
#include "reference/exact_distance.h"
#include "reference/point_triangle_cases.h"
#include "reference/small_meshes.h"

namespace meshbound {
namespace point_triangle_test {

using Eigen::Vector3d;
using reference::CaseFamily;
using reference::Corners;
using reference::ExactLength;
using reference::PointTriangleCase;
using reference::Random;

constexpr double epsilon = std::numeric_limits<double>::epsilon();

double size_of(const Corners& t) {
  double size = 0;
  for (const Vector3d& corner : t) size = std::max(size, (corner - t[0]).cwiseAbs().maxCoeff());
  return size;
}

/// One unit in the last place of the largest coordinate.
double ulp_of(const PointTriangleCase& c) {
  double largest = c.query.cwiseAbs().maxCoeff();
  for (const Vector3d& corner : c.triangle) largest = std::max(largest, corner.cwiseAbs().maxCoeff());
  return std::nextafter(largest, std::numeric_limits<double>::infinity()) - largest;
}

std::string describe(const PointTriangleCase& c) {
  std::ostringstream text;
  text << std::hexfloat;
  for (const Vector3d& v : c.triangle) text << '(' << v.x() << ' ' << v.y() << ' ' << v.z() << ") ";
  text << "query (" << c.query.x() << ' ' << c.query.y() << ' ' << c.query.z() << ')';
  return text.str();
}

/// How far the bounds of a case lie from the distance, in ulp of its largest coordinate.
struct Slack {
  double above = 0;  ///< upper - exact
  double below = 0;  ///< exact - lower
};

/// The claim itself.
Slack check(const PointTriangleCase& c, double allowed_width) {
  const auto& [p, q, r] = c.triangle;
  const Bvh bvh(reference::single_triangle(p, q, r), {1});
  const Bounds bounds = closest_point(bvh, c.query).distance;
  const ExactLength exact = reference::exact_distance(c.query, c.triangle);
  const double distance = exact.approximate();
  EXPECT_GE(exact.compare(bounds.lower), 0) << describe(c) << " lower " << bounds.lower << " > " << distance;
  EXPECT_LE(exact.compare(bounds.upper), 0) << describe(c) << " upper " << bounds.upper << " < " << distance;
  const double unit = epsilon * (size_of(c.triangle) + distance) + 4 * std::numeric_limits<double>::denorm_min();
  EXPECT_LE((bounds.upper - bounds.lower) / unit, allowed_width) << describe(c) << " distance " << distance;
  const double ulp = ulp_of(c);
  return {(bounds.upper - distance) / ulp, (distance - bounds.lower) / ulp};
}

/// Median, 99% and largest of a set of slacks, as text.
std::string quantiles(std::vector<float>& slacks) {
  std::sort(slacks.begin(), slacks.end());
  const auto at = [&](double share) {
    return static_cast<double>(slacks[static_cast<std::size_t>(share * static_cast<double>(slacks.size() - 1))]);
  };
  char text[64];
  std::snprintf(text, sizeof text, "%8.1f %8.1f %8.1f", at(0.5), at(0.99), at(1));
  return text;
}

/// Collects the slacks of one family; prints a line of the table.
struct SlackSample {
  std::vector<float> above, below;

  void add(const Slack& slack) {
    above.push_back(static_cast<float>(slack.above));
    below.push_back(static_cast<float>(slack.below));
  }
  void add(const SlackSample& other) {
    above.insert(above.end(), other.above.begin(), other.above.end());
    below.insert(below.end(), other.below.begin(), other.below.end());
  }
  void print(const char* name) {
    const std::string upper = quantiles(above), lower = quantiles(below);
    std::printf("slack: %-28s %9zu | %s | %s\n", name, above.size(), upper.c_str(), lower.c_str());
  }
};

void print_head() {
  std::printf("slack: in ulp of the largest coordinate       |    upper - exact: median, 99%%, max | exact - lower\n");
}

SlackSample check_many(const CaseFamily& family, std::uint32_t seed, int count, double tail = 1) {
  Random random(seed);
  SlackSample sample;
  for (int i = 0; i < count && !testing::Test::HasFailure(); ++i)
    sample.add(check(family.make(random), tail * family.allowed_width));
  return sample;
}

class PointTriangleBounds : public testing::TestWithParam<CaseFamily> {};

TEST_P(PointTriangleBounds, ContainTheDistanceAndAreTight) {
  SlackSample sample = check_many(GetParam(), 1, GetParam().count);
  print_head();
  sample.print(GetParam().name);
}

INSTANTIATE_TEST_SUITE_P(Of, PointTriangleBounds, testing::ValuesIn(reference::case_families()),
                         [](const auto& family) { return family.param.name; });

TEST(SlowPointTriangleBounds, ContainTheDistanceInTenMillionCases) {
  constexpr int times_default = 100;
  constexpr double tail = 8;  // a hundred times as many cases come closer to a size and distance of 0
  const auto& families = reference::case_families();
  std::vector<SlackSample> samples(families.size());
  std::atomic<std::size_t> next = 0;
  std::mutex merging;
  const auto work = [&] {
    for (std::size_t job = next++; job < families.size() * times_default; job = next++) {
      const std::size_t family = job / times_default;
      const auto seed = static_cast<std::uint32_t>(1000 + job % times_default);
      const SlackSample sample = check_many(families[family], seed, families[family].count, tail);
      const std::lock_guard lock(merging);
      samples[family].add(sample);
    }
  };
  std::vector<std::thread> threads;
  for (unsigned i = 0; i < std::max(1U, std::thread::hardware_concurrency()); ++i) threads.emplace_back(work);
  for (std::thread& thread : threads) thread.join();
  ASSERT_FALSE(HasFailure());
  SlackSample all;
  print_head();
  for (std::size_t i = 0; i < families.size(); ++i) {
    samples[i].print(families[i].name);
    all.add(samples[i]);
  }
  EXPECT_GE(all.above.size(), 10'000'000u);
  all.print("all");
}

TEST(ClosestPoint, OfACornerIsExactlyZeroAway) {
  Random random(15);
  for (int i = 0; i < 1000; ++i) {
    const PointTriangleCase c = reference::case_families()[0].make(random);
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

}  // namespace point_triangle_test
}  // namespace meshbound
