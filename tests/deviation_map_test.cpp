// SPDX-License-Identifier: MIT
// The deviation of vertices and faces against oracles that share no code with the engine, and statistics of surfaces
// whose distance is known everywhere.
#include "meshbound/deviation_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "meshbound/error.h"
#include "reference/brute_force.h"
#include "reference/claims.h"
#include "reference/exact_distance.h"
#include "reference/small_meshes.h"

namespace meshbound {
namespace deviation_map_test {

using namespace reference;
using Eigen::Vector3d;

struct Pair {
  const char* name;
  TriangleMesh mesh, other;
};

TriangleMesh jittered(TriangleMesh mesh, double size) {
  std::mt19937 random(7);
  const auto uniform = [&] { return size * (static_cast<double>(random()) / 2147483648.0 - 1); };
  for (Vector3d& p : mesh.vertices) p += Vector3d(uniform(), uniform(), uniform());
  return mesh;
}

/// Zero-area triangles, a duplicate and a vertex that no triangle uses.
TriangleMesh degenerate() {
  TriangleMesh mesh = unit_square(2);
  mesh.triangles.push_back(mesh.triangles.front());
  mesh.triangles.push_back({0, 0, 1});
  mesh.triangles.push_back({3, 3, 3});
  mesh.vertices.emplace_back(0.5, 0.5, 4);
  return mesh;
}

std::vector<Pair> pairs() {
  return {{"ball and coarser ball", icosphere(2), icosphere(1)},
          {"coarser ball and ball", icosphere(1), icosphere(2)},
          {"square and a bent one", unit_square(1), jittered(unit_square(6), 0.1)},
          {"two soups", random_soup(1, 40, 0.4), random_soup(2, 40, 0.4)},
          {"degenerate triangles", degenerate(), jittered(unit_square(3), 0.2)},
          {"against degenerate triangles", jittered(unit_square(3), 0.2), degenerate()},
          {"far from the origin", moved(icosphere(1), {1e6, -1e6, 1e6}), moved(icosphere(2), {1e6, -1e6, 1e6})}};
}

TEST(VertexDeviations, HoldTheExactDistance) {
  for (const Pair& pair : pairs()) {
    SCOPED_TRACE(pair.name);
    const std::vector<Bounds> found = vertex_deviations(pair.mesh, Bvh(pair.other));
    ASSERT_EQ(found.size(), pair.mesh.vertices.size());
    for (std::size_t v = 0; v < found.size(); ++v) {
      const ExactLength exact = exact_distance(pair.mesh.vertices[v], pair.other);
      EXPECT_GE(exact.compare(found[v].lower), 0) << v;
      EXPECT_LE(exact.compare(found[v].upper), 0) << v;
      EXPECT_LE(found[v].upper - found[v].lower, bound_slack(pair.mesh, pair.other)) << v;
    }
  }
}

TEST(VertexDeviations, SayNothingOfAVertexThatIsNoPoint) {
  TriangleMesh mesh = unit_square(1);
  mesh.vertices.emplace_back(0, std::numeric_limits<double>::quiet_NaN(), 0);
  mesh.vertices.emplace_back(0, 0, 3);
  const std::vector<Bounds> found = vertex_deviations(mesh, Bvh(unit_square(1)));
  EXPECT_EQ(found[4].lower, 0);
  EXPECT_EQ(found[4].upper, std::numeric_limits<double>::infinity());
  EXPECT_NEAR(found[5].upper, 3, 1e-9);
}

TEST(FaceDeviations, MeetTheBruteForceOfEachTriangle) {
  constexpr double error_bound = 0.05;
  for (const Pair& pair : pairs()) {
    SCOPED_TRACE(pair.name);
    const Bvh other(pair.other);
    const std::vector<Bounds> vertices = vertex_deviations(pair.mesh, other);
    const std::vector<Bounds> faces = face_deviations(pair.mesh, other, vertices, error_bound);
    ASSERT_EQ(faces.size(), pair.mesh.triangles.size());
    for (std::size_t f = 0; f < faces.size(); ++f) {
      SCOPED_TRACE(f);
      const Corners p = corners(pair.mesh, f);
      const double rounding = brute_force_allowance * largest_magnitude(pair.mesh);
      Bounds truth = brute_force_one_sided(single_triangle(p[0], p[1], p[2]), pair.other, error_bound / 2);
      truth.lower -= rounding;
      truth.upper += rounding;
      expect_meets(faces[f], truth);
      EXPECT_LE(faces[f].upper - faces[f].lower, error_bound + bound_slack(pair.mesh, pair.other));
    }
  }
}

/// The deviation is 0 at all three corners and largest in between, where no vertex shows it.
TEST(FaceDeviations, SeeWhatStandsBetweenTheVertices) {
  TriangleMesh tent = unit_square(2);
  for (Vector3d& p : tent.vertices)
    if (p.x() == 0.5 && p.y() == 0.5) p.z() = 0.3;
  const TriangleMesh square = unit_square(1);
  const Bvh other(tent);
  const std::vector<Bounds> vertices = vertex_deviations(square, other);
  for (const Bounds& vertex : vertices) EXPECT_LT(vertex.upper, 1e-12);
  for (const Bounds& face : face_deviations(square, other, vertices, 1e-3)) EXPECT_GT(face.lower, 0.1);
}

TEST(FaceDeviations, LargestOneIsTheOneSidedDistance) {
  const TriangleMesh mesh = icosphere(2), other_mesh = jittered(icosphere(3), 0.05);
  const Bvh other(other_mesh);
  const std::vector<Bounds> faces = face_deviations(mesh, other, vertex_deviations(mesh, other), 1e-4);
  Bounds largest{0, 0};
  for (const Bounds& face : faces) {
    largest.lower = std::max(largest.lower, face.lower);
    largest.upper = std::max(largest.upper, face.upper);
  }
  expect_meets(largest, one_sided_hausdorff_distance(Bvh(mesh), other).bounds);
  EXPECT_LE(largest.upper - largest.lower, 1.01e-4);
}

/// A square over one that rises from 0 to `height` along x: the distance grows in proportion to x, from 0 to `far`.
struct Slope {
  double height = 0.2;
  TriangleMesh flat = unit_square(3);
  TriangleMesh rising = scaled(unit_square(1), 4);
  double far = 0;

  Slope() {
    for (Vector3d& p : rising.vertices) {
      p -= Vector3d(2, 2, 0);
      p.z() = height * p.x();
    }
    far = height / std::sqrt(1 + height * height);
  }
};

TEST(DeviationStatistics, AreThoseOfAPlaneThatRises) {
  const Slope slope;
  DeviationSampling sampling;
  sampling.scale = slope.far;
  sampling.bins = 10;
  const DeviationStatistics found = deviation_statistics(slope.flat, Bvh(slope.rising), sampling);
  EXPECT_EQ(found.samples, sampling.samples);
  EXPECT_NEAR(found.mean, slope.far / 2, 1e-3 * slope.far);
  EXPECT_NEAR(found.root_mean_square, slope.far / std::sqrt(3), 1e-3 * slope.far);
  EXPECT_NEAR(found.percentile_95, 0.95 * slope.far, 1e-3 * slope.far);
  EXPECT_LE(found.largest_sample, slope.far);
  EXPECT_GT(found.largest_sample, 0.99 * slope.far);
  for (const std::size_t bin : found.histogram)
    EXPECT_NEAR(static_cast<double>(bin), 0.1 * static_cast<double>(found.samples),
                2e-3 * static_cast<double>(found.samples));
  EXPECT_EQ(found.beyond_scale, 0u);
  sampling.scale = slope.far / 2;
  const DeviationStatistics half = deviation_statistics(slope.flat, Bvh(slope.rising), sampling);
  EXPECT_NEAR(static_cast<double>(half.beyond_scale), 0.5 * static_cast<double>(half.samples),
              2e-3 * static_cast<double>(half.samples));
  EXPECT_EQ(std::accumulate(half.histogram.begin(), half.histogram.end(), half.beyond_scale), half.samples);
}

/// Each point stands for the same area, however the triangles cut it up.
TEST(DeviationStatistics, WeighAreaNotTriangles) {
  TriangleMesh mesh = unit_square(1);  // at distance 0
  const TriangleMesh fine = moved(unit_square(20), {5, 0, 1});
  mesh = both(mesh, fine);  // as large, in 400 times the triangles, at distance 1
  DeviationSampling sampling;
  sampling.samples = 1000;
  sampling.scale = 2;
  const DeviationStatistics found = deviation_statistics(mesh, Bvh(scaled(unit_square(1), 10)), sampling);
  EXPECT_NEAR(found.mean, 0.5, 2e-3);
}

TEST(DeviationStatistics, OfAMeshWithoutAreaAreNoNumbers) {
  const TriangleMesh needle{{{0, 0, 0}, {1, 0, 0}}, {{0, 1, 1}}};
  const DeviationStatistics found = deviation_statistics(needle, Bvh(unit_square(1)), {});
  EXPECT_EQ(found.samples, 0u);
  EXPECT_TRUE(std::isnan(found.mean) && std::isnan(found.root_mean_square) && std::isnan(found.percentile_95));
}

/// Coordinates are multiples of 0.125 there, so most points inside of triangles are rounded to places beside the
/// surface, by more than the scale.
TEST(DeviationStatistics, TakeNoRoundingOfTheirPointsForDeviations) {
  const TriangleMesh mesh = moved(icosphere(2), {1e15, 1e15, 1e15});
  const Bvh same(mesh);
  DeviationSampling sampling;
  sampling.samples = 2000;
  sampling.scale = 0.01;
  const DeviationStatistics found = deviation_statistics(mesh, same, sampling);
  EXPECT_EQ(found.beyond_scale, 0u);
  EXPECT_LE(found.largest_sample, sampling.scale);
  sampling.scale = 100;
  EXPECT_GT(deviation_statistics(mesh, same, sampling).largest_sample, 0.05) << "the rounding is part of what is known";
  sampling.max_distance = 0;
  const DeviationStatistics known = deviation_statistics(mesh, same, sampling);
  EXPECT_EQ(known.mean, 0);
  EXPECT_EQ(known.largest_sample, 0);
  EXPECT_EQ(known.histogram[0], sampling.samples);
}

/// Squares of such lengths are beyond the range of doubles.
TEST(DeviationStatistics, HoldAtTheEndsOfTheRange) {
  for (const double size : {1e-160, 1e155}) {
    const TriangleMesh mesh = scaled(unit_square(1), size), other = scaled(moved(unit_square(1), {0, 0, 1}), size);
    DeviationSampling sampling;
    sampling.samples = 100;
    sampling.scale = size;
    const DeviationStatistics found = deviation_statistics(mesh, Bvh(other), sampling);
    for (const double value : {found.mean, found.root_mean_square, found.percentile_95})
      EXPECT_NEAR(value / size, 1, 1e-9);
  }
}

TEST(Deviations, AreTheSameForAnyNumberOfThreads) {
  const TriangleMesh mesh = jittered(icosphere(4), 0.02);
  const Bvh other(icosphere(3));
  const auto bits = [](const std::vector<Bounds>& bounds) {
    std::vector<double> values;
    for (const Bounds& b : bounds) values.insert(values.end(), {b.lower, b.upper});
    return values;
  };
  DeviationOptions one, four;
  one.threads = 1;
  four.threads = 4;
  const std::vector<Bounds> vertices = vertex_deviations(mesh, other, one);
  EXPECT_EQ(bits(vertices), bits(vertex_deviations(mesh, other, four)));
  EXPECT_EQ(bits(face_deviations(mesh, other, vertices, 1e-3, one)),
            bits(face_deviations(mesh, other, vertices, 1e-3, four)));
  const DeviationStatistics first = deviation_statistics(mesh, other, {}, one);
  const DeviationStatistics second = deviation_statistics(mesh, other, {}, four);
  EXPECT_EQ(first.mean, second.mean);
  EXPECT_EQ(first.root_mean_square, second.root_mean_square);
  EXPECT_EQ(first.percentile_95, second.percentile_95);
  EXPECT_EQ(first.histogram, second.histogram);
}

TEST(Deviations, RefuseWhatHasNoMeaning) {
  const TriangleMesh mesh = unit_square(1);
  const Bvh other(mesh);
  const std::vector<Bounds> vertices = vertex_deviations(mesh, other);
  for (const double wrong : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW((void)face_deviations(mesh, other, vertices, wrong), InvalidInput);
    EXPECT_THROW((void)deviation_statistics(mesh, other, {.scale = wrong}), InvalidInput);
  }
  EXPECT_THROW((void)face_deviations(mesh, other, {}, 0.1), InvalidInput);
  EXPECT_THROW((void)deviation_statistics(mesh, other, {.samples = 0}), InvalidInput);
  EXPECT_THROW((void)deviation_statistics(mesh, other, {.max_distance = -1}), InvalidInput);
  EXPECT_THROW((void)deviation_statistics(mesh, other, {.max_distance = std::nan("")}), InvalidInput);
  EXPECT_THROW((void)deviation_statistics(mesh, other, {.bins = 0}), InvalidInput);
  EXPECT_THROW((void)vertex_deviations(TriangleMesh{{}, {{0, 1, 2}}}, other), InvalidInput);
}

TEST(Deviations, EndWhenTheyAreTold) {
  const TriangleMesh mesh = icosphere(3);
  const Bvh other(icosphere(2));
  const std::vector<Bounds> vertices = vertex_deviations(mesh, other);
  const std::atomic<bool> told = true;
  const DeviationOptions options{.stop = {.cancel = &told}};
  EXPECT_THROW((void)vertex_deviations(mesh, other, options), Stopped);
  EXPECT_THROW((void)face_deviations(mesh, other, vertices, 0.01, options), Stopped);
  EXPECT_THROW((void)deviation_statistics(mesh, other, {}, options), Stopped);
}

/// Each point of the axis of a tube is equally far from all of its needles, so a query looks at thousands of them: the
/// queries of this mesh take a second, and the deadline passes among the first ones.
TEST(Deviations, EndAmongQueriesThatTakeLong) {
  const TriangleMesh tube = needles(8000);
  const Vector3d end = (tube.vertices[0] + tube.vertices[8000]) / 2, along = tube.vertices[1] - tube.vertices[0];
  TriangleMesh axis{{}, {{0, 1, 2}}};
  constexpr int count = 1000;
  for (int i = 0; i < count; ++i) axis.vertices.emplace_back(end + i * (along / count));
  const Bvh tree(tube);
  (void)closest_point(tree, end);  // makes what the first query of a tree needs
  DeviationOptions options{.threads = 1};
  options.stop.deadline = StopToken::Clock::now() + std::chrono::milliseconds(5);
  EXPECT_THROW((void)vertex_deviations(axis, tree, options), Stopped);
}

}  // namespace deviation_map_test
}  // namespace meshbound
