// SPDX-License-Identifier: MIT
// A tracker that starts from a mesh which is an approximation already proves what holds, refuses what does not, and
// goes on from there as any other.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "datasets/analytic_meshes.h"
#include "meshbound/deviation_tracker.h"
#include "meshbound/distance.h"
#include "meshbound/error.h"
#include "reference/small_meshes.h"

namespace meshbound {
namespace {

using Eigen::Vector3d;

std::vector<TrackedFace> faces_of(const TriangleMesh& mesh) {
  std::vector<TrackedFace> faces;
  for (const Triangle& t : mesh.triangles)
    faces.push_back(
        {static_cast<std::uint32_t>(faces.size()), {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]}});
  return faces;
}

struct Pair {
  const char* name;
  TriangleMesh original, approximation;
};

std::vector<Pair> pairs() {
  return {{"sphere", datasets::icosphere(1, 5), datasets::icosphere(1, 3)},
          {"torus", datasets::torus(1, 0.3, 120, 48), datasets::torus(1, 0.3, 50, 20)},
          {"other way round", datasets::torus(1, 0.3, 50, 20), datasets::torus(1, 0.3, 70, 30)},
          {"tilted sphere", datasets::icosphere(1, 4), datasets::uv_sphere(1, 20, 40)},
          {"open", datasets::terrain(1, 32, 5), datasets::terrain(1, 16, 5)}};
}

TEST(StartFrom, ProvesWhatHoldsWithALittleRoom) {
  for (const Pair& pair : pairs()) {
    SCOPED_TRACE(pair.name);
    const Bvh bvh(pair.original);
    const double distance = symmetric_distance(bvh, Bvh(pair.approximation)).bounds.upper;
    DeviationTracker tracker(pair.original, bvh, 1.1 * distance);
    const Unproven unproven = tracker.start_from(faces_of(pair.approximation), 1);
    EXPECT_EQ(unproven.originals, std::vector<std::uint32_t>());
    EXPECT_EQ(unproven.faces, std::vector<std::uint32_t>());
  }
}

TEST(StartFrom, NeverProvesWhatDoesNotHold) {
  for (const Pair& pair : pairs()) {
    SCOPED_TRACE(pair.name);
    const Bvh bvh(pair.original);
    const SymmetricDistance distance = symmetric_distance(bvh, Bvh(pair.approximation));
    DeviationTracker tracker(pair.original, bvh, 0.999 * distance.bounds.lower);
    EXPECT_FALSE(tracker.start_from(faces_of(pair.approximation), 1).empty());
  }
}

TEST(StartFrom, NamesTheFacesOfAVertexThatWasMovedOut) {
  const TriangleMesh original = datasets::icosphere(1, 4);
  TriangleMesh moved = datasets::icosphere(1, 3);
  const std::uint32_t vertex = moved.triangles[100][1];
  moved.vertices[vertex] *= 1.05;
  const Bvh bvh(original);
  DeviationTracker tracker(original, bvh, 0.02);
  std::vector<std::uint32_t> around;
  for (std::uint32_t t = 0; t < moved.triangles.size(); ++t)
    if (std::count(moved.triangles[t].begin(), moved.triangles[t].end(), vertex) > 0) around.push_back(t);
  EXPECT_EQ(tracker.start_from(faces_of(moved), 1).faces, around);
}

TEST(StartFrom, NamesAnOriginalTriangleWithNothingNear) {
  const TriangleMesh original = reference::unit_square(8);
  std::vector<TrackedFace> faces = faces_of(original);
  const Bvh bvh(original);
  DeviationTracker tracker(original, bvh, 0.01);
  faces.erase(faces.begin() + 50);
  const Unproven unproven = tracker.start_from(faces, 1);
  EXPECT_EQ(unproven.originals, std::vector<std::uint32_t>{50});
  EXPECT_EQ(unproven.faces, std::vector<std::uint32_t>());
}

/// Larger coordinates would have larger rounding errors than the tracker leaves room for.
TEST(StartFrom, RefusesFacesFarAwayAndCoordinatesThatAreNoNumbers) {
  const TriangleMesh original = reference::unit_square(4);
  const Bvh bvh(original);
  DeviationTracker tracker(original, bvh, 0.01);
  std::vector<TrackedFace> faces = faces_of(original);
  for (const double x : {1e300, std::nan(""), -HUGE_VAL}) {
    std::vector<TrackedFace> with_another = faces;
    with_another.push_back({77, {Vector3d(x, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 1, 0)}});
    const Unproven unproven = tracker.start_from(with_another, 1);
    EXPECT_EQ(unproven.originals, std::vector<std::uint32_t>());
    EXPECT_EQ(unproven.faces, std::vector<std::uint32_t>{77});
  }
}

TEST(StartFrom, RefusesTwoFacesOfOneId) {
  const TriangleMesh original = reference::unit_square(2);
  const Bvh bvh(original);
  DeviationTracker tracker(original, bvh, 0.01);
  std::vector<TrackedFace> faces = faces_of(original);
  faces[1].id = 3;
  EXPECT_THROW((void)tracker.start_from(faces), InvalidInput);
}

/// Far more faces than a cover has candidates or cuts for.
TEST(StartFrom, CoversLargeTrianglesByManySmallFaces) {
  const TriangleMesh original = datasets::cube(1, 1), fine = datasets::cube(1, 24);
  const Bvh bvh(original);
  DeviationTracker tracker(original, bvh, 1e-3);
  EXPECT_TRUE(tracker.start_from(faces_of(fine), 1).empty());
  std::vector<TrackedFace> with_hole = faces_of(fine);
  with_hole.erase(with_hole.begin() + 1000);
  EXPECT_EQ(tracker.start_from(with_hole, 1).originals.size(), 1u);
}

/// Each of them has a hundred candidates, of which it may look at 64.
TEST(StartFrom, FindsTheFaceOfATriangleAmongManyThatCrossIt) {
  TriangleMesh fan;
  for (std::uint32_t k = 0; k < 100; ++k) {
    const double angle = 0.01 * k * std::numbers::pi, c = std::cos(angle), s = std::sin(angle);
    for (const Vector3d& p : {Vector3d(-c, -s, -1), Vector3d(c, s, -1), Vector3d(0, 0, 2)}) fan.vertices.push_back(p);
    fan.triangles.push_back({3 * k, 3 * k + 1, 3 * k + 2});
  }
  const Bvh bvh(fan);
  DeviationTracker tracker(fan, bvh, 1e-3);
  EXPECT_TRUE(tracker.start_from(faces_of(fan), 1).empty());
}

TEST(StartFrom, KeepsTheTolerancesOfTriangles) {
  const TriangleMesh original = datasets::icosphere(1, 4), approximation = datasets::icosphere(1, 3);
  const Bvh bvh(original);
  std::vector<double> tolerances(original.triangles.size(), HUGE_VAL);
  DeviationTracker tracker(original, bvh, 0.02);
  tracker.limit_triangles(tolerances);
  EXPECT_TRUE(tracker.start_from(faces_of(approximation), 1).empty());
  tolerances[7] = 1e-5;
  tracker.limit_triangles(tolerances);
  const Unproven unproven = tracker.start_from(faces_of(approximation), 1);
  EXPECT_TRUE(std::binary_search(unproven.originals.begin(), unproven.originals.end(), 7u));
  EXPECT_LT(unproven.originals.size(), 100u);
  EXPECT_FALSE(unproven.faces.empty());
}

/// Collapses of a grid that stands for a finer one, into corners, in a fixed order.
struct GridRun {
  std::vector<bool> admitted;
  TriangleMesh left;
};

GridRun collapse_all(DeviationTracker& tracker, TriangleMesh mesh) {
  GridRun run;
  std::vector<bool> alive(mesh.triangles.size(), true);
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    const std::uint32_t u = mesh.triangles[t][0], v = mesh.triangles[t][1];
    if (!alive[t] || u == v) continue;
    std::vector<std::uint32_t> removed;
    std::vector<TrackedFace> added;
    for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
      const Triangle& c = mesh.triangles[f];
      if (!alive[f] || std::count(c.begin(), c.end(), v) == 0) continue;
      removed.push_back(f);
      if (std::count(c.begin(), c.end(), u) > 0) continue;
      TrackedFace& face = added.emplace_back();
      face.id = f;
      for (std::size_t i = 0; i < 3; ++i) face.corners[i] = mesh.vertices[c[i] == v ? u : c[i]];
    }
    SurfaceChange change;
    change.removed = removed;
    change.added = added;
    run.admitted.push_back(tracker.admits(change));
    if (!run.admitted.back()) continue;
    tracker.commit();
    for (const std::uint32_t f : removed) {
      alive[f] = std::count(mesh.triangles[f].begin(), mesh.triangles[f].end(), u) == 0;
      std::replace(mesh.triangles[f].begin(), mesh.triangles[f].end(), v, u);
    }
  }
  run.left.vertices = mesh.vertices;
  for (std::size_t f = 0; f < alive.size(); ++f)
    if (alive[f]) run.left.triangles.push_back(mesh.triangles[f]);
  return run;
}

TEST(StartFrom, GoesOnWithinTheToleranceAndTheSameForAnyNumberOfThreads) {
  const TriangleMesh original = datasets::torus(1, 0.3, 120, 48), approximation = datasets::torus(1, 0.3, 50, 20);
  const Bvh bvh(original);
  DeviationTracker one(original, bvh, 0.03), two(original, bvh, 0.03);
  ASSERT_TRUE(one.start_from(faces_of(approximation), 1).empty());
  ASSERT_TRUE(two.start_from(faces_of(approximation), 2).empty());
  const GridRun first = collapse_all(one, approximation), second = collapse_all(two, approximation);
  EXPECT_EQ(first.admitted, second.admitted);
  EXPECT_EQ(one.stats().originals_tested, two.stats().originals_tested);
  EXPECT_EQ(one.stats().cuts, two.stats().cuts);
  EXPECT_GT(one.stats().admitted, 50u);
  EXPECT_GT(first.admitted.size(), one.stats().admitted);
  EXPECT_LE(symmetric_distance(bvh, Bvh(first.left)).bounds.upper, 0.03);
}

TEST(StartFrom, StaysAsItWasWhereAMeshCouldNotBeProven) {
  const TriangleMesh original = datasets::torus(1, 0.3, 120, 48), approximation = datasets::torus(1, 0.3, 50, 20);
  const Bvh bvh(original);
  DeviationTracker plain(original, bvh, 0.03), disturbed(original, bvh, 0.03);
  ASSERT_TRUE(plain.start_from(faces_of(approximation), 1).empty());
  ASSERT_TRUE(disturbed.start_from(faces_of(approximation), 1).empty());
  ASSERT_FALSE(disturbed.start_from(faces_of(datasets::torus(1, 0.3, 20, 8)), 2).empty());
  EXPECT_EQ(collapse_all(plain, approximation).admitted, collapse_all(disturbed, approximation).admitted);
}

}  // namespace
}  // namespace meshbound
