// SPDX-License-Identifier: MIT
// The tracker admits only what keeps the bound, refuses for the right reason, and forgets what it refused. Every mesh
// that comes out of random admitted edits is measured by the distance engine.
#include "meshbound/deviation_tracker.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <set>

#include "datasets/analytic_meshes.h"
#include "meshbound/distance.h"
#include "meshbound/error.h"
#include "meshbound/proximity.h"
#include "reference/small_meshes.h"
#include "simplify/candidate_faces.h"
#include "simplify/cover_assignment.h"
#include "simplify/degree_cover.h"
#include "simplify/sampled_slope.h"
#include "simplify/unchanged_faces.h"

namespace meshbound {
namespace {

using Eigen::Vector3d;

/// A mesh under edits beside its tracker: the simplest simplifier that can drive one. Topology is not looked after, so
/// it makes soups that a half-edge structure never would.
class TrackedSoup {
 public:
  TrackedSoup(const TriangleMesh& original, double tolerance)
      : original_(original), bvh_(original), tracker(original, bvh_, tolerance), mesh_(original) {
    for (std::uint32_t t = 0; t < original.triangles.size(); ++t) tracker.start(t, t);
    alive_.assign(original.triangles.size(), true);
  }

  [[nodiscard]] std::vector<std::uint32_t> faces_around(std::uint32_t u, std::uint32_t v) const {
    std::vector<std::uint32_t> around;
    for (std::uint32_t f = 0; f < mesh_.triangles.size(); ++f)
      if (alive_[f] && (has(f, u) || has(f, v))) around.push_back(f);
    return around;
  }

  /// Collapses v into u at `to`, if the tracker admits it.
  bool collapse(std::uint32_t u, std::uint32_t v, const Vector3d& to) {
    const std::vector<std::uint32_t> removed = faces_around(u, v);
    std::vector<TrackedFace> added;
    for (const std::uint32_t f : removed) {
      if (has(f, u) && has(f, v)) continue;
      TrackedFace face{f, {}};
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t c = mesh_.triangles[f][i];
        face.corners[i] = c == u || c == v ? to : mesh_.vertices[c];
      }
      added.push_back(face);
    }
    SurfaceChange change;
    change.removed = removed;
    change.added = added;
    change.moved_vertex = to;
    change.ring = [&](std::vector<std::uint32_t>& ring) {
      for (const std::uint32_t f : removed)
        for (const std::uint32_t c : mesh_.triangles[f])
          for (const std::uint32_t g : faces_around(c, c))
            if (std::find(removed.begin(), removed.end(), g) == removed.end()) ring.push_back(g);
    };
    if (!tracker.admits(change)) return false;
    tracker.commit();
    for (const std::uint32_t f : removed) {
      if (has(f, u) && has(f, v)) alive_[f] = false;
      for (std::uint32_t& c : mesh_.triangles[f]) c = c == v ? u : c;
    }
    mesh_.vertices[u] = to;
    return true;
  }

  [[nodiscard]] TriangleMesh current() const {
    TriangleMesh result{mesh_.vertices, {}};
    for (std::size_t f = 0; f < alive_.size(); ++f)
      if (alive_[f]) result.triangles.push_back(mesh_.triangles[f]);
    return result;
  }
  [[nodiscard]] Bounds distance() const { return symmetric_distance(bvh_, Bvh(current())).bounds; }
  [[nodiscard]] const TriangleMesh& mesh() const { return mesh_; }
  [[nodiscard]] bool alive(std::uint32_t f) const { return alive_[f]; }

 private:
  [[nodiscard]] bool has(std::uint32_t f, std::uint32_t v) const {
    const Triangle& t = mesh_.triangles[f];
    return t[0] == v || t[1] == v || t[2] == v;
  }
  TriangleMesh original_;
  Bvh bvh_;

 public:
  DeviationTracker tracker;

 private:
  TriangleMesh mesh_;
  std::vector<bool> alive_;
};

/// Tries `count` collapses of random edges into random points near them; returns how many were admitted.
int random_collapses(TrackedSoup& soup, std::uint32_t seed, int count, double jitter) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  int admitted = 0;
  for (int i = 0; i < count; ++i) {
    const auto f = static_cast<std::uint32_t>(random() % soup.mesh().triangles.size());
    const auto k = random() % 3;
    if (!soup.alive(f)) continue;
    const std::uint32_t u = soup.mesh().triangles[f][k], v = soup.mesh().triangles[f][(k + 1) % 3];
    if (u == v) continue;
    const double s = unit(random) < 0.5 ? 0.0 : unit(random);
    const Vector3d noise = jitter * Vector3d(unit(random) - 0.5, unit(random) - 0.5, unit(random) - 0.5);
    const Vector3d to = (1 - s) * soup.mesh().vertices[u] + s * soup.mesh().vertices[v] + (s == 0 ? 0.0 : 1.0) * noise;
    admitted += soup.collapse(u, v, to) ? 1 : 0;
  }
  return admitted;
}

struct Shape {
  const char* name;
  TriangleMesh mesh;
  double tolerance;
};

std::vector<Shape> shapes() {
  return {{"sphere", datasets::icosphere(1, 3), 0.05},
          {"open plane with spikes", datasets::spiked_plane(1, 0.2, 16, 4), 0.03},
          {"thin sheet, tolerance above its thickness", datasets::thin_sheet(1, 0.01, 12), 0.02},
          {"open terrain", datasets::terrain(1, 16, 7), 0.02},
          {"two spheres through each other",
           reference::both(datasets::icosphere(1, 2), reference::moved(datasets::icosphere(1, 2), {0.5, 0, 0})), 0.1}};
}

TEST(DeviationTracker, KeepsRandomCollapsesWithinTheToleranceBothWays) {
  for (const Shape& shape : shapes()) {
    SCOPED_TRACE(shape.name);
    TrackedSoup soup(shape.mesh, shape.tolerance);
    EXPECT_GT(random_collapses(soup, 1, 3000, shape.tolerance), 100);
    EXPECT_LE(soup.distance().upper, shape.tolerance);
  }
}

TEST(DeviationTracker, UsesMostOfTheTolerance) {
  TrackedSoup soup(datasets::icosphere(1, 3), 0.05);
  random_collapses(soup, 2, 6000, 0.05);
  EXPECT_GT(soup.distance().lower, 0.7 * 0.05);
}

TEST(DeviationTracker, RefusesAVertexTooFarFromTheOriginal) {
  TrackedSoup soup(reference::unit_square(4), 0.01);
  EXPECT_FALSE(soup.collapse(6, 7, {0.4, 0.3, 0.011}));
  EXPECT_EQ(soup.tracker.last_refusal(), Refusal::MovedVertexTooFar);
}

/// Flat but for one spike: its removal leaves only faces that lie on the original, and the tip without any near it.
TEST(DeviationTracker, RefusesToForgetASpikeAndNamesATriangleOfIt) {
  TriangleMesh spike = reference::unit_square(4);
  const std::uint32_t tip = 12;
  spike.vertices[tip].z() = 0.5;
  TrackedSoup soup(spike, 0.01);
  const std::uint32_t neighbour = 11;
  EXPECT_FALSE(soup.collapse(neighbour, tip, spike.vertices[neighbour]));
  ASSERT_EQ(soup.tracker.last_refusal(), Refusal::OriginalUncovered);
  const Triangle t = spike.triangles.at(soup.tracker.last_uncovered());
  EXPECT_NE(std::find(t.begin(), t.end(), tip), t.end());
}

/// Two plates side by side with a gap: a face across it is near everything that was removed, but far from the original
/// in its middle.
TEST(DeviationTracker, RefusesAFaceAcrossAGap) {
  const TriangleMesh plates =
      reference::both(reference::unit_square(1), reference::moved(reference::unit_square(1), {2, 0, 0}));
  const Bvh bvh(plates);
  DeviationTracker tracker(plates, bvh, 0.1);
  for (std::uint32_t t = 0; t < plates.triangles.size(); ++t) tracker.start(t, t);
  const std::vector<TrackedFace> bridge = {{7, {Vector3d(1, 0, 0), Vector3d(2, 0, 0), Vector3d(2, 1, 0)}}};
  SurfaceChange change;
  change.added = bridge;
  EXPECT_FALSE(tracker.admits(change));
  EXPECT_EQ(tracker.last_refusal(), Refusal::NewFaceTooFar);
}

TEST(DeviationTracker, IsTheSameAfterARefusalAsBefore) {
  const TriangleMesh sphere = datasets::icosphere(1, 2);
  TrackedSoup plain(sphere, 0.05), disturbed(sphere, 0.05);
  std::mt19937 random(5);
  for (int i = 0; i < 600; ++i) {
    const Triangle t = plain.mesh().triangles[random() % plain.mesh().triangles.size()];
    if (t[0] == t[1]) continue;
    const Vector3d to = 0.5 * (plain.mesh().vertices[t[0]] + plain.mesh().vertices[t[1]]);
    EXPECT_FALSE(disturbed.collapse(t[0], t[1], 3 * to));
    EXPECT_EQ(plain.collapse(t[0], t[1], to), disturbed.collapse(t[0], t[1], to));
  }
  EXPECT_EQ(plain.current().triangles, disturbed.current().triangles);
}

/// What placements of one edge share is kept between them; a tolerance that grows by nothing makes a tracker forget.
TEST(DeviationTracker, AnswersForEachPlacementOfAnEdgeAsIfItWereTheFirst) {
  for (const Shape& shape : shapes()) {
    TrackedSoup soup(shape.mesh, shape.tolerance), forgetful(shape.mesh, shape.tolerance);
    std::mt19937 random(11);
    std::uniform_real_distribution<double> unit(-1, 1);
    int admitted = 0, refused = 0, admitted_after_refusal = 0;
    for (int round = 0; round < 150; ++round) {
      const auto f = static_cast<std::uint32_t>(random() % soup.mesh().triangles.size());
      const auto k = random() % 3;
      if (!soup.alive(f)) continue;
      const std::uint32_t u = soup.mesh().triangles[f][k], v = soup.mesh().triangles[f][(k + 1) % 3];
      if (u == v) continue;
      const Vector3d p = soup.mesh().vertices[u], q = soup.mesh().vertices[v];
      for (int placement = 0; placement < 8; ++placement) {
        const double reach = placement % 2 == 0 ? 4 * shape.tolerance : 0.3 * shape.tolerance;
        Vector3d to = 0.5 * (p + q) + reach * Vector3d(unit(random), unit(random), unit(random));
        if (placement == 4) to = p;
        forgetful.tracker.grow_tolerance(shape.tolerance);
        const bool answer = forgetful.collapse(u, v, to);
        ASSERT_EQ(soup.collapse(u, v, to), answer) << shape.name << ", round " << round << ", placement " << placement;
        ++(answer ? admitted : refused);
        if (answer && placement > 0) ++admitted_after_refusal;
        if (answer) break;
      }
    }
    EXPECT_GT(admitted, 5) << shape.name;
    EXPECT_GT(refused, 50) << shape.name;
    EXPECT_GT(admitted_after_refusal, 3) << shape.name;
  }
}

TEST(DeviationTracker, CommitsOnlyWhatItAdmitted) {
  TrackedSoup soup(reference::unit_square(4), 0.01);
  EXPECT_THROW(soup.tracker.commit(), Error);
  ASSERT_FALSE(soup.collapse(6, 7, {0, 0, 9}));
  EXPECT_THROW(soup.tracker.commit(), Error);
}

TEST(DeviationTracker, CoversDuplicatesAndDegenerateTrianglesByTheirNeighbours) {
  TriangleMesh mesh = reference::unit_square(1);
  const Triangle first = mesh.triangles[0];
  mesh.triangles.push_back(first);
  mesh.triangles.push_back({first[0], first[1], first[1]});
  mesh.vertices.emplace_back(5, 5, 5);
  mesh.triangles.push_back({first[0], first[0], 4});  // a segment that leads away from the square
  const Bvh bvh(mesh);
  DeviationTracker tracker(mesh, bvh, 0.01);
  tracker.start(0, 0);
  tracker.start(1, 1);
  EXPECT_EQ(tracker.cover_the_rest(), std::vector<std::uint32_t>{4});
}

TEST(DeviationTracker, GrowsItsToleranceButNeverShrinksIt) {
  TrackedSoup soup(reference::unit_square(4), 0.01);
  const Vector3d above(0.4, 0.3, 0.05);
  EXPECT_FALSE(soup.collapse(6, 7, above));
  EXPECT_THROW(soup.tracker.grow_tolerance(0.005), InvalidInput);
  soup.tracker.grow_tolerance(0.06);
  EXPECT_TRUE(soup.collapse(6, 7, above));
  EXPECT_LE(soup.distance().upper, 0.06);
}

TEST(DeviationTracker, AdmitsNoChangeAtToleranceZero) {
  TrackedSoup soup(datasets::icosphere(1, 2), 0);
  EXPECT_FALSE(soup.collapse(0, soup.mesh().triangles[0][0] == 0 ? soup.mesh().triangles[0][1] : 1, {1, 0, 0}));
  EXPECT_EQ(soup.tracker.last_refusal(), Refusal::ToleranceBelowRounding);
}

TEST(DeviationTracker, RefusesTolerancesThatAreNoLengths) {
  const TriangleMesh square = reference::unit_square(1);
  const Bvh bvh(square);
  EXPECT_THROW(DeviationTracker(square, bvh, -1), InvalidInput);
  EXPECT_THROW(DeviationTracker(square, bvh, std::numeric_limits<double>::quiet_NaN()), InvalidInput);
  EXPECT_THROW(DeviationTracker(reference::cube(1), bvh, 1), InvalidInput);
}

/// The guide of searches: its slope is the change of its sum when the vertex goes a little, and the two kinds of inner
/// loop agree to the bit.
TEST(LocalDeviation, KnowsItsSlopeOnEveryProcessor) {
  const TriangleMesh sphere = datasets::icosphere(1, 3);
  const Bvh bvh(sphere);
  DeviationTracker tracker(sphere, bvh, 0.1);
  for (std::uint32_t t = 0; t < sphere.triangles.size(); ++t) tracker.start(t, t);
  std::vector<std::uint32_t> star;
  std::vector<TrackedFace> faces;
  std::vector<std::size_t> moved_corner;
  for (std::uint32_t t = 0; t < sphere.triangles.size(); ++t) {
    const Triangle& corners = sphere.triangles[t];
    const auto found = std::find(corners.begin(), corners.end(), 200u);
    if (found == corners.end()) continue;
    star.push_back(t);
    moved_corner.push_back(static_cast<std::size_t>(found - corners.begin()));
    faces.push_back({t, {sphere.vertices[corners[0]], sphere.vertices[corners[1]], sphere.vertices[corners[2]]}});
  }
  tracker.sample(star);
  const auto at = [&](const Eigen::Vector3d& p) {
    for (std::size_t i = 0; i < faces.size(); ++i) faces[i].corners[moved_corner[i]] = p;
    return tracker.sampled_deviation(faces, moved_corner);
  };
  EXPECT_LT(at(sphere.vertices[200]).sum, 1e-3);
  const Eigen::Vector3d away = sphere.vertices[200] * 1.15 + Eigen::Vector3d(0.01, 0.02, -0.01);
  const SampledDeviation there = at(away);
  EXPECT_GT(there.worst, 0.5);
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d step = 1e-3 * Eigen::Vector3d::Unit(k);
    EXPECT_NEAR((at(away + step).sum - at(away - step).sum) / 2e-3, there.gradient[k], 0.02 * there.gradient.norm());
  }
  EXPECT_GT(there.curvature.trace(), 0);

  SamplePoints points;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int i = 0; i < 40; ++i) points.add({unit(random), unit(random), unit(random)});
  const std::vector<SampleFace> triangles = {SampleFace({0, 0, 0}, {1, 0, 0}, {0, 1, 0}),
                                             SampleFace({0, 0, 0}, {0, 1, 0}, {-1, -1, 0.2}),
                                             SampleFace({0, 0, 0}, {1, 1, 1}, {1, 1, 1})};
  std::vector<SampleOffsets> portable, fastest;
  portable_slope_kernel().offsets(points, triangles, portable);
  fastest_slope_kernel().offsets(points, triangles, fastest);
  EXPECT_EQ(portable.size(), 5U);
  EXPECT_TRUE(portable == fastest);
  SlopeSums one, two;
  SamplePoints near = points, nearby = points;
  portable_slope_kernel().drop_far(near, triangles, 0.5F);
  fastest_slope_kernel().drop_far(nearby, triangles, 0.5F);
  EXPECT_TRUE(near.blocks == nearby.blocks);
  std::ptrdiff_t far = 0;
  for (const SamplePoints::Block& block : near.blocks) far += std::ranges::count(block.weight, 0.0F);
  EXPECT_GT(far, 0);
  EXPECT_LT(far, 40);
  portable_slope_kernel().add_slope(near, triangles, 2, one);
  fastest_slope_kernel().add_slope(near, triangles, 2, two);
  EXPECT_EQ(one.sum, two.sum);
  EXPECT_EQ(one.worst_squared, two.worst_squared);
  EXPECT_LE(one.worst_squared, 1);
  for (int k = 0; k < 3; ++k) EXPECT_EQ(one.gradient[k], two.gradient[k]);
  for (int k = 0; k < 6; ++k) EXPECT_EQ(one.curvature[k], two.curvature[k]);
}

/// Random triangles near rough surfaces: the proof by degree may fail where the bound holds, never the other way.
TEST(CoverAssignment, KeepsBothSidesOfTheRelationThroughCoversOfAnySize) {
  constexpr std::uint32_t originals = 20, faces = 12;
  CoverAssignment cover(originals);
  std::vector<std::set<std::uint32_t>> expected(originals);
  std::mt19937 random(3);
  for (int step = 0; step < 2000; ++step) {
    const auto t = static_cast<std::uint32_t>(random() % originals);
    expected[t].clear();
    for (auto k = random() % 7; k > 0; --k) expected[t].insert(static_cast<std::uint32_t>(random() % faces));
    cover.assign(t, std::vector<std::uint32_t>(expected[t].begin(), expected[t].end()));
  }
  for (std::uint32_t t = 0; t < originals; ++t) {
    const auto ids = cover.faces_of(t);
    EXPECT_EQ(std::set<std::uint32_t>(ids.begin(), ids.end()), expected[t]);
    for (std::uint32_t f = 0; f < faces; ++f) {
      const auto of_face = cover.originals_of(f);
      EXPECT_EQ(std::count(of_face.begin(), of_face.end(), t), static_cast<std::ptrdiff_t>(expected[t].count(f)));
    }
  }
}

/// The slab test must not depend on the machine: the chosen one against plain arithmetic.
TEST(CandidateFaces, HoldExactlyThoseThatAreNear) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  const auto point = [&] { return Vec3{coordinate(random), coordinate(random), coordinate(random)}; };
  constexpr double tolerance = 0.3;
  for (int round = 0; round < 200; ++round) {
    CandidateFaces candidates;
    candidates.clear(tolerance);
    std::vector<std::array<Vec3, 3>> faces;
    for (int k = 0; k < CandidateFaces::capacity; ++k) {
      const Vec3 a = point(), b = point();
      faces.push_back({a, b, k % 9 == 0 ? b : point()});  // some without area
      candidates.add(faces.back());
    }
    for (int i = 0; i < 20; ++i) {
      const Vec3 p = point();
      const FaceMask among = (FaceMask{random()} << 32) | random();
      const FaceMask mask = candidates.holding(p, among);
      EXPECT_EQ(mask & ~among, 0u);
      for (int k = 0; k < CandidateFaces::capacity; ++k) {
        const auto& f = faces[static_cast<std::size_t>(k)];
        const double squared =
            closest_on_triangle(CornerTriangle<double>{f[0], f[1] - f[0], f[2] - f[0]}, p).squared_distance;
        if (std::abs(std::sqrt(squared) - tolerance) < 1e-6 || ((among >> k) & 1) == 0) continue;
        EXPECT_EQ((mask >> k) & 1, squared < tolerance * tolerance ? 1u : 0u);
      }
    }
  }
}

TEST(PlaneKernel, IsTheSameOnEveryProcessor) {
  const PlaneKernel portable = portable_plane_kernel(), fastest = fastest_plane_kernel();
  if (portable.test == fastest.test) GTEST_SKIP() << "this processor has no AVX2";
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto point = [&] { return Vec3{unit(random), unit(random), unit(random)}; };
  unsigned accurate = 0, held = 0;
  for (int round = 0; round < 1000; ++round) {
    std::array<PlaneKernel::Corners, 4> faces;
    for (auto& corners : faces) {
      corners = {point(), point(), point()};
      if (random() % 4 == 0) corners[2] = 0.5 * (corners[0] + corners[1]);
    }
    PlaneBlock ours, theirs;
    const unsigned flat = portable.set(ours, faces.data(), 0.3, 3e-7);
    ASSERT_EQ(fastest.set(theirs, faces.data(), 0.3, 3e-7), flat);
    ASSERT_EQ(std::memcmp(&ours, &theirs, sizeof(PlaneBlock)), 0);
    const Vec3 p = point(), q = point();
    const SlabBits here = portable.test(ours, p, 0.3, 0.09), there = fastest.test(theirs, p, 0.3, 0.09);
    ASSERT_EQ(here.inside, there.inside);
    ASSERT_EQ(here.outside, there.outside);
    const unsigned forth = static_cast<unsigned>(random()) & flat, back = flat & ~forth;
    const Reach one = portable.reach(ours, forth, back, p, q, 0.3, 0.09);
    const Reach other = fastest.reach(theirs, forth, back, p, q, 0.3, 0.09);
    ASSERT_EQ(one.forth, other.forth);
    ASSERT_EQ(one.back, other.back);
    EXPECT_EQ(one.back, portable.reach(ours, back, forth, q, p, 0.3, 0.09).forth) << "the way back is the way from q";
    accurate |= flat;
    held |= here.inside;
  }
  EXPECT_EQ(accurate, 15u);
  EXPECT_EQ(held, 15u);
}

TEST(DegreeCover, NeverCoversAFaceThatTheEngineFindsTooFar) {
  for (const Shape& shape : shapes()) {
    SCOPED_TRACE(shape.name);
    std::vector<Vec3> vertices;
    for (const Vector3d& p : shape.mesh.vertices) vertices.push_back({p.x(), p.y(), p.z()});
    DegreeCover degree(vertices, shape.mesh.triangles);
    const Bvh original(shape.mesh);
    std::mt19937 random(11);
    std::normal_distribution<double> noise(0, 0.5 * shape.tolerance);
    int covered = 0;
    for (int i = 0; i < 4000; ++i) {
      const auto t = static_cast<std::uint32_t>(random() % shape.mesh.triangles.size());
      const Triangle& near = shape.mesh.triangles[t];
      TriangleMesh face{{}, {{0, 1, 2}}};
      const double size = 0.2 + 0.001 * static_cast<double>(i % 2000);
      const Vector3d first = shape.mesh.vertices[near[0]];
      for (const std::uint32_t v : near)
        face.vertices.push_back(first + size * (shape.mesh.vertices[v] - first) +
                                Vector3d(noise(random), noise(random), noise(random)));
      std::array<Vec3, 3> corners;
      for (std::size_t k = 0; k < 3; ++k)
        corners[k] = {face.vertices[k].x(), face.vertices[k].y(), face.vertices[k].z()};
      if (!degree.covers(corners, shape.tolerance, 2, t)) continue;
      ++covered;
      EXPECT_NE(check_one_sided(Bvh(face), original, shape.tolerance).verdict, Verdict::Exceeds);
    }
    EXPECT_GT(covered, 100);
  }
}

TEST(UnchangedFaces, AreThoseWithTheCornersOfAnOriginalInAnyOrder) {
  const std::vector<Vec3> vertices{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0.5}};
  const std::vector<Triangle> triangles{{0, 1, 2}, {1, 3, 2}, {1, 3, 2}, {0, 1, 3}};
  using Corners = std::array<Eigen::Vector3d, 3>;
  const std::vector<TrackedFace> faces{{7, Corners{{{1, 1, 0.5}, {1, 0, 0}, {0, 1, 0}}}},
                                       {3, Corners{{{0, 1, 0}, {-0.0, 0, -0.0}, {1, 0, 0}}}},
                                       {5, Corners{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0.5000000000000001}}}}};
  const UnchangedFaces unchanged(vertices, triangles, faces);
  EXPECT_EQ(unchanged.face_of(0), 1u);
  EXPECT_EQ(unchanged.face_of(1), 0u);
  EXPECT_EQ(unchanged.face_of(2), 0u) << "a duplicate triangle has the same face";
  EXPECT_EQ(unchanged.face_of(3), UnchangedFaces::none);
  EXPECT_EQ(unchanged.triangle_of(0), 1u);
  EXPECT_EQ(unchanged.triangle_of(1), 0u);
  EXPECT_EQ(unchanged.triangle_of(2), UnchangedFaces::none);
}

/// Ten thousand triangles around one point: the boxes of all faces meet, and yet nothing needs a search.
TEST(UnchangedFaces, SpareAProofOfWhatIsTheOriginalStill) {
  TriangleMesh star;
  star.vertices.emplace_back(0, 0, 0);
  std::vector<TrackedFace> faces;
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const double a = 0.7 * i, z = std::cos(0.37 * i);
    star.vertices.emplace_back(std::cos(a), std::sin(a), z);
    star.vertices.emplace_back(std::cos(a + 0.1), std::sin(a + 0.1), z);
    star.triangles.push_back({0, 2 * i + 1, 2 * i + 2});
    faces.push_back({i, {star.vertices[0], star.vertices[2 * i + 2], star.vertices[2 * i + 1]}});
  }
  const Bvh tree(star);
  DeviationTracker tracker(star, tree, 1e-3);
  const Unproven unproven = tracker.start_from(faces);
  EXPECT_TRUE(unproven.originals.empty());
  EXPECT_TRUE(unproven.faces.empty());
  EXPECT_EQ(tracker.stats().cuts, 0u);
  EXPECT_EQ(tracker.stats().originals_split, 0u);
  EXPECT_EQ(tracker.stats().faces_by_degree, 0u);
}

}  // namespace
}  // namespace meshbound
