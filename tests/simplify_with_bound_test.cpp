// SPDX-License-Identifier: GPL-3.0-or-later
// simplify_with_bound as a library, with every driver that there is: what it returns holds, measured afresh, over
// closed, open, thin, flat and broken meshes, and it ends where it is told to.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>

#include "drivers.h"
#include "meshbound/error.h"
#include "meshbound/mesh_summary.h"
#include "meshbound/simplify.h"
#include "shapes.h"
#include "simplify_options.h"

namespace meshbound {
namespace simplify_with_bound_test {

using test::manifold_shapes;
using test::Shape;

class Driven : public testing::TestWithParam<test::NamedDriver> {
 protected:
  static SimplifyOptions within(double tolerance) { return test::within(tolerance, GetParam().driver); }
};
class SimplifyWithBound : public Driven {};
class Pruning : public Driven {};

/// Measured afresh, not taken from the result.
void expect_within(const TriangleMesh& original, const SimplifiedLevel& level) {
  EXPECT_EQ(check_tolerance(Bvh(original), Bvh(level.mesh), level.tolerance).verdict, Verdict::Within);
  EXPECT_EQ(level.verdict, Verdict::Within);
}

TEST_P(SimplifyWithBound, HoldsItsTolerance) {
  for (const Shape& shape : manifold_shapes()) {
    SCOPED_TRACE(shape.name);
    const SimplifyResult result = simplify_with_bound(shape.mesh, within(shape.tolerance));
    expect_within(shape.mesh, result.last());
    EXPECT_LE(static_cast<double>(result.last().mesh.triangles.size()),
              shape.max_left * static_cast<double>(shape.mesh.triangles.size()));
  }
}

TEST_P(SimplifyWithBound, HoldsForSoupsThatAreNotManifold) {
  TriangleMesh duplicated = datasets::icosphere(1, 3);
  for (std::size_t t = 0; t < 200; ++t) duplicated.triangles.push_back(duplicated.triangles[3 * t]);
  TriangleMesh turned = datasets::icosphere(1, 3);
  for (std::size_t t = 0; t < turned.triangles.size(); t += 3)
    std::swap(turned.triangles[t][0], turned.triangles[t][1]);
  TriangleMesh unwelded = datasets::icosphere(1, 3);
  std::vector<std::array<Eigen::Vector3d, 3>> corners;
  for (const Triangle& t : unwelded.triangles)
    corners.push_back({unwelded.vertices[t[0]], unwelded.vertices[t[1]], unwelded.vertices[t[2]]});
  // A second square stands on the edge x = 0 of a first, and a third hangs below: three faces at an edge.
  TriangleMesh fins = reference::both(reference::unit_square(16), reference::unit_square(16));
  fins = reference::both(fins, reference::unit_square(16));
  for (std::size_t v = 289; v < 578; ++v) fins.vertices[v] = {0, fins.vertices[v].y(), fins.vertices[v].x()};
  for (std::size_t v = 578; v < 867; ++v) fins.vertices[v] = {0, fins.vertices[v].y(), -fins.vertices[v].x()};
  const std::vector<Shape> shapes = {{"duplicated faces", duplicated, 0.02, 0.2},
                                     {"a third of the faces turned over", turned, 0.02, 0.2},
                                     {"every triangle with vertices of its own", reference::soup(corners), 0.02, 0.2},
                                     {"three squares at one edge", fins, 0.02, 0.2},
                                     {"separate triangles", reference::random_soup(1, 200, 0.3), 0.02, 1}};
  for (const Shape& shape : shapes) {
    SCOPED_TRACE(shape.name);
    const SimplifyResult result = simplify_with_bound(shape.mesh, within(shape.tolerance));
    expect_within(shape.mesh, result.last());
    EXPECT_LE(static_cast<double>(result.last().mesh.triangles.size()),
              shape.max_left * static_cast<double>(shape.mesh.triangles.size()));
  }
}

TEST_P(SimplifyWithBound, HoldsAndSavesFacesWithHighEffort) {
  SimplifyOptions options = within(0.01);
  for (const Shape& shape : manifold_shapes()) {
    if (shape.mesh.triangles.size() > 3000) continue;  // for the time it takes
    SCOPED_TRACE(shape.name);
    options.effort = Effort::Normal;
    const std::size_t normal = simplify_with_bound(shape.mesh, options).last().mesh.triangles.size();
    options.effort = Effort::High;
    const SimplifyResult result = simplify_with_bound(shape.mesh, options);
    expect_within(shape.mesh, result.last());
    EXPECT_LE(result.last().mesh.triangles.size(), normal);
  }
}

TEST_P(SimplifyWithBound, KeepsDegenerateTrianglesThatLieOnNoOther) {
  TriangleMesh mesh = datasets::icosphere(1, 3);
  mesh.vertices.emplace_back(3, 0, 0);
  const auto tip = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  mesh.triangles.push_back({0, tip, tip});  // an antenna
  mesh.triangles.push_back({0, 0, 0});      // a point of the sphere
  const SimplifyResult result = simplify_with_bound(mesh, within(0.02));
  EXPECT_EQ(result.kept_triangles, 1u);
  EXPECT_EQ(result.dropped_triangles, 1u);
  expect_within(mesh, result.last());
}

TEST_P(SimplifyWithBound, SkipLeavesFewerFacesThanStop) {
  const TriangleMesh terrain = datasets::terrain(1, 40, 3);
  SimplifyOptions options = within(0.01);
  const SimplifyResult skip = simplify_with_bound(terrain, options);
  options.on_exceed = OnExceed::Stop;
  const SimplifyResult stop = simplify_with_bound(terrain, options);
  EXPECT_EQ(skip.last().ended_by, EndedBy::NothingFits);
  EXPECT_EQ(stop.last().ended_by, EndedBy::Tolerance);
  EXPECT_LT(skip.last().mesh.triangles.size(), stop.last().mesh.triangles.size());
  EXPECT_LT(stop.last().mesh.triangles.size(), terrain.triangles.size());
  expect_within(terrain, stop.last());
}

TEST_P(SimplifyWithBound, LevelsGrowCoarserAndEachHoldsAgainstTheOriginal) {
  const TriangleMesh torus = datasets::torus(1, 0.3, 60, 24);
  SimplifyOptions options = within(0.04);
  options.levels = {0.01, 0.0025};
  const SimplifyResult result = simplify_with_bound(torus, options);
  ASSERT_EQ(result.levels.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    expect_within(torus, result.levels[i]);
    if (i == 0) continue;
    EXPECT_LT(result.levels[i - 1].tolerance, result.levels[i].tolerance);
    EXPECT_GT(result.levels[i - 1].mesh.triangles.size(), result.levels[i].mesh.triangles.size());
  }
}

TEST_P(SimplifyWithBound, EndsAtTheTargetOrTheToleranceWhicheverComesFirst) {
  const TriangleMesh sphere = datasets::icosphere(1, 4);
  SimplifyOptions options = within(0.01);
  options.target_faces = 2000;
  const SimplifyResult target = simplify_with_bound(sphere, options);
  EXPECT_EQ(target.last().ended_by, EndedBy::Target);
  EXPECT_LE(target.last().mesh.triangles.size(), 2000u);
  EXPECT_GE(target.last().mesh.triangles.size(), 1998u);
  options.target_faces = 10;
  const SimplifyResult tolerance = simplify_with_bound(sphere, options);
  EXPECT_EQ(tolerance.last().ended_by, EndedBy::NothingFits);
  EXPECT_GT(tolerance.last().mesh.triangles.size(), 10u);
  expect_within(sphere, tolerance.last());
  options.target_faces.reset();
  options.target_ratio = 0.5;
  EXPECT_NEAR(static_cast<double>(simplify_with_bound(sphere, options).last().mesh.triangles.size()), 2560, 2);
}

/// Ends of edges of one face.
std::set<std::array<double, 3>> border_points(const TriangleMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> faces_at;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) ++faces_at[std::minmax({t[k], t[(k + 1) % 3]})];
  std::set<std::array<double, 3>> points;
  for (const auto& [edge, faces] : faces_at) {
    if (faces > 1) continue;
    for (const std::uint32_t v : {edge.first, edge.second})
      points.insert({mesh.vertices[v].x(), mesh.vertices[v].y(), mesh.vertices[v].z()});
  }
  return points;
}

TEST_P(SimplifyWithBound, LeavesTheBoundaryAsItIsWhenAsked) {
  const TriangleMesh terrain = datasets::terrain(1, 24, 3);
  SimplifyOptions options = within(0.02);
  EXPECT_NE(border_points(simplify_with_bound(terrain, options).last().mesh), border_points(terrain));
  options.preserve_boundary = true;
  const SimplifyResult result = simplify_with_bound(terrain, options);
  EXPECT_EQ(border_points(result.last().mesh), border_points(terrain));
  EXPECT_LT(result.last().mesh.triangles.size(), terrain.triangles.size());
  expect_within(terrain, result.last());
}

TEST_P(SimplifyWithBound, LeavesTheBoundaryAsItIsWithHighEffort) {
  SimplifyOptions options = within(0.02);
  options.preserve_boundary = true;
  options.effort = Effort::High;
  const TriangleMesh terrain = datasets::terrain(1, 30, 3);
  const SimplifyResult result = simplify_with_bound(terrain, options);
  expect_within(terrain, result.last());
  EXPECT_EQ(border_points(result.last().mesh), border_points(terrain));
}

TEST_P(SimplifyWithBound, GivesTheSameMeshEveryTime) {
  const TriangleMesh terrain = datasets::terrain(1, 40, 3);
  SimplifyOptions options = within(0.01);
  const SimplifyResult one = simplify_with_bound(terrain, options);
  options.threads = 2;
  const SimplifyResult two = simplify_with_bound(terrain, options);
  EXPECT_EQ(one.last().mesh.triangles, two.last().mesh.triangles);
  EXPECT_EQ(one.last().mesh.vertices, two.last().mesh.vertices);
  EXPECT_EQ(one.last().distance->bounds.upper, two.last().distance->bounds.upper);
}

TEST_P(SimplifyWithBound, GivesTheSameMeshEveryTimeWithHighEffort) {
  const TriangleMesh torus = datasets::torus(1, 0.3, 60, 24);
  SimplifyOptions options = within(0.02);
  options.effort = Effort::High;
  const SimplifyResult one = simplify_with_bound(torus, options);
  options.threads = 2;
  const SimplifyResult two = simplify_with_bound(torus, options);
  EXPECT_EQ(one.last().mesh.triangles, two.last().mesh.triangles);
  EXPECT_EQ(one.last().mesh.vertices, two.last().mesh.vertices);
}

/// Fewer faces than normal effort can reach, yet not fewer than asked for.
TEST_P(SimplifyWithBound, EndsAtTheTargetWithHighEffort) {
  const TriangleMesh torus = datasets::torus(1, 0.3, 60, 24);
  SimplifyOptions options = within(0.01);
  options.target_faces = simplify_with_bound(torus, options).last().faces() - 10;
  options.effort = Effort::High;
  const SimplifyResult result = simplify_with_bound(torus, options);
  EXPECT_EQ(result.last().ended_by, EndedBy::Target);
  EXPECT_LE(result.last().faces(), *options.target_faces);
  EXPECT_GE(result.last().faces(), *options.target_faces - 2);
  expect_within(torus, result.last());
}

/// A speck on the surface, one beside it, a square that reaches out of it, and a shell.
TEST_P(Pruning, DropsComponentsThatTheRestStandsForAndNoOthers) {
  const TriangleMesh sphere = datasets::icosphere(1, 3);
  const TriangleMesh speck = datasets::icosphere(0.004, 1);
  struct Case {
    const char* name;
    TriangleMesh part;
    std::size_t dropped;
  };
  const std::vector<Case> cases = {{"on the surface", reference::moved(speck, {0, 0, 1}), 1},
                                   {"beside it", reference::moved(speck, {0, 0, 1.03}), 0},
                                   {"reaches out", reference::moved(reference::unit_square(4), {0, 0, 0.995}), 0},
                                   {"a shell", datasets::icosphere(1.008, 3), 1},
                                   {"a shell too far", datasets::icosphere(1.05, 3), 0}};
  for (const Case& one : cases) {
    SCOPED_TRACE(one.name);
    for (const Effort effort : {Effort::Normal, Effort::High}) {
      const TriangleMesh both = reference::both(sphere, one.part);
      SimplifyOptions options = within(0.02);
      options.levels = {0.015};
      options.effort = effort;
      const SimplifyResult kept = simplify_with_bound(both, options);
      EXPECT_EQ(kept.pruned_components, 0u);
      options.prune = true;
      const SimplifyResult result = simplify_with_bound(both, options);
      EXPECT_EQ(result.pruned_components, one.dropped);
      EXPECT_EQ(result.pruned_faces > 0, one.dropped > 0);
      expect_within(both, result.levels.front());
      expect_within(both, result.last());
      EXPECT_EQ(summarise(result.last().mesh).components, 2 - one.dropped);
      EXPECT_LT(static_cast<double>(result.last().faces()), 1.1 * static_cast<double>(kept.last().faces()));
    }
  }
}

/// All specks lie within the tolerance of another, and no order may drop the last of a chain.
TEST_P(Pruning, NeverDropsAllThatStandForOneAnother) {
  TriangleMesh chain = datasets::icosphere(0.01, 1);
  for (int i = 1; i < 12; ++i)
    chain = reference::both(chain, reference::moved(datasets::icosphere(0.01, 1), {0.015 * i, 0, 0}));
  SimplifyOptions options = within(0.02);
  options.prune = true;
  const SimplifyResult result = simplify_with_bound(chain, options);
  EXPECT_GT(result.pruned_components, 0u);
  EXPECT_LT(result.pruned_components, 11u);
  expect_within(chain, result.last());
}

/// Many components go one after another, and each is as large a part of the mesh as those before.
TEST_P(Pruning, LeavesOneOfManyShells) {
  TriangleMesh shells = datasets::icosphere(1, 2);
  for (int i = 1; i < 40; ++i) shells = reference::both(shells, datasets::icosphere(1 + 1e-5 * i, 2));
  SimplifyOptions options = within(0.02);
  options.prune = true;
  const SimplifyResult result = simplify_with_bound(shells, options);
  EXPECT_EQ(result.pruned_components, 39u);
  EXPECT_EQ(result.pruned_faces, 39u * 320);
  expect_within(shells, result.last());
}

TEST_P(Pruning, LeavesWhatIsToStay) {
  const TriangleMesh sphere = datasets::icosphere(1, 3);
  const TriangleMesh shells = reference::both(sphere, datasets::icosphere(1.005, 2));
  SimplifyOptions options = within(0.05);
  options.prune = true;
  EXPECT_EQ(simplify_with_bound(shells, options).pruned_components, 1u);
  options.locked_vertices.assign(shells.vertices.size(), false);
  options.locked_vertices.front() = options.locked_vertices.back() = true;
  EXPECT_EQ(simplify_with_bound(shells, options).pruned_components, 0u);
  options.locked_vertices.clear();
  options.target_faces = shells.triangles.size() - 100;
  EXPECT_GE(simplify_with_bound(shells, options).last().faces(), *options.target_faces - 2);
  options.target_faces.reset();
  options.face_tolerances.assign(shells.triangles.size(), 1e-3);
  EXPECT_EQ(simplify_with_bound(shells, options).pruned_components, 0u);
  options.face_tolerances.clear();
  const TriangleMesh sheets =
      reference::both(reference::unit_square(8), reference::moved(reference::unit_square(4), {0, 0, 0.01}));
  EXPECT_EQ(simplify_with_bound(sheets, options).pruned_components, 1u);
  options.preserve_boundary = true;
  EXPECT_EQ(simplify_with_bound(sheets, options).pruned_components, 0u);
}

TEST_P(SimplifyWithBound, ChangesNothingAtToleranceZero) {
  const TriangleMesh sphere = datasets::icosphere(1, 3);
  const SimplifyResult result = simplify_with_bound(sphere, within(0));
  EXPECT_TRUE(result.tolerance_below_rounding);
  EXPECT_EQ(result.last().mesh.triangles.size(), sphere.triangles.size());
  EXPECT_EQ(result.last().verdict, Verdict::Within);
  EXPECT_EQ(result.last().distance->bounds.upper, 0);
}

/// Inside, meshes are sorted along a curve.
TEST_P(SimplifyWithBound, KeepsTheOrderOfTheInput) {
  TriangleMesh shuffled = datasets::icosphere(1, 3);
  std::mt19937 random(7);
  std::shuffle(shuffled.triangles.begin(), shuffled.triangles.end(), random);
  const TriangleMesh same = simplify_with_bound(shuffled, within(0)).last().mesh;
  EXPECT_EQ(same.vertices, shuffled.vertices);
  ASSERT_EQ(same.triangles.size(), shuffled.triangles.size());
  for (std::size_t t = 0; t < same.triangles.size(); ++t)
    EXPECT_TRUE(std::is_permutation(same.triangles[t].begin(), same.triangles[t].end(), shuffled.triangles[t].begin()));
}

/// A shape and the same one tiny, huge, or far away for its size, are simplified alike.
TEST_P(SimplifyWithBound, HoldsAtExtremeScalesAndFarFromTheOrigin) {
  const TriangleMesh torus = datasets::torus(1, 0.3, 40, 16);
  for (const double scale : {1e-160, 1e-30, 1e30, 1e155}) {
    SCOPED_TRACE(scale);
    const TriangleMesh mesh = reference::scaled(torus, scale);
    const SimplifyResult result = simplify_with_bound(mesh, within(0.02 * scale));
    expect_within(mesh, result.last());
    EXPECT_LT(result.last().mesh.triangles.size(), torus.triangles.size() / 2);
  }
  const TriangleMesh far = reference::moved(torus, {1e6, -1e6, 1e6});
  const SimplifyResult result = simplify_with_bound(far, within(0.02));
  expect_within(far, result.last());
  EXPECT_LT(result.last().mesh.triangles.size(), torus.triangles.size() / 2);
}

/// Beside coordinates of 10,000 a float moves a vertex by a tenth of the tolerance.
TEST_P(SimplifyWithBound, RoundsToSinglePrecisionWithinTheTolerance) {
  const TriangleMesh sphere = reference::moved(datasets::icosphere(1, 4), {10000, -10000, 10000});
  SimplifyOptions options = within(0.006);
  options.precision = Precision::Single;
  const SimplifyResult result = simplify_with_bound(sphere, options);
  expect_within(sphere, result.last());
  EXPECT_LT(result.last().faces(), sphere.triangles.size() / 4);
  for (const Eigen::Vector3d& p : result.last().mesh.vertices) EXPECT_EQ(p, p.cast<float>().cast<double>());
}

/// Terrain in UTM coordinates: floats there are half a metre apart in y, a thirty-second in x, far less in z. A vertex
/// is moved by 0.251 at most, so that a tolerance of 0.3 is enough.
TEST_P(SimplifyWithBound, LeavesRoomForFloatsByTheirStepsOnEachAxis) {
  TriangleMesh terrain = datasets::terrain(100, 40, 5);
  for (Eigen::Vector3d& p : terrain.vertices)
    p = Eigen::Vector3d(p.x() + 500000.1, p.y() + 5400000.3, 0.1 * p.z() + 459.9);
  for (const double tolerance : {0.3, 0.6, 1.2, 3.0}) {
    SCOPED_TRACE(tolerance);
    SimplifyOptions options = within(tolerance);
    options.precision = Precision::Single;
    options.line_tolerance = 0.8 * tolerance + 0.06;
    const SimplifyResult result = simplify_with_bound(terrain, options);
    expect_within(terrain, result.last());
    EXPECT_LT(result.last().faces(), terrain.triangles.size());
    EXPECT_LT(result.last().lines.size(), result.lines.size());
    for (const Eigen::Vector3d& p : result.last().mesh.vertices) EXPECT_EQ(p, p.cast<float>().cast<double>());
    options.precision = Precision::Double;
    options.tolerance = tolerance - 0.26;
    options.line_tolerance = *options.line_tolerance - 0.26;
    const std::size_t with_doubles = simplify_with_bound(terrain, options).last().faces();
    EXPECT_LE(static_cast<double>(result.last().faces()), 1.1 * static_cast<double>(with_doubles) + 10);
  }
}

/// Vertices that are floats already leave the whole tolerance where the result has no others.
TEST_P(SimplifyWithBound, NeedsNoRoomForFloatsThatItStartsFrom) {
  const TriangleMesh square = reference::scaled(reference::unit_square(8), 64);
  SimplifyOptions options = within(1e-3);
  options.precision = Precision::Single;
  options.placements = CollapsePlacements::Subset;
  const TriangleMesh floats = reference::moved(square, {500000, 5400000, 460});
  const SimplifyResult result = simplify_with_bound(floats, options);
  expect_within(floats, result.last());
  EXPECT_EQ(result.last().faces(), 2u);
  const TriangleMesh doubles = reference::moved(square, {500000, 5400000.1, 460});  // a float is 0.1 away
  EXPECT_EQ(simplify_with_bound(doubles, options).last().ended_by, EndedBy::Rounding);
  options.tolerance = 0.101;
  const SimplifyResult rounded = simplify_with_bound(doubles, options);
  expect_within(doubles, rounded.last());
  EXPECT_EQ(rounded.last().faces(), 2u);
}

TEST_P(SimplifyWithBound, EndsWhenItIsToldTo) {
  const TriangleMesh sphere = datasets::icosphere(1, 4);
  SimplifyOptions options = within(0.01);
  options.time_limit = 0;
  EXPECT_EQ(simplify_with_bound(sphere, options).last().ended_by, EndedBy::TimeLimit);
  const std::atomic<bool> cancel = true;
  options.cancel = &cancel;
  EXPECT_EQ(simplify_with_bound(sphere, options).last().ended_by, EndedBy::Cancelled);
}

TEST_P(SimplifyWithBound, RefusesOptionsAndInputThatMakeNoSense) {
  const TriangleMesh sphere = datasets::icosphere(1, 1);
  EXPECT_THROW((void)simplify_with_bound(sphere, SimplifyOptions()), InvalidInput);
  EXPECT_THROW((void)simplify_with_bound(sphere, within(-1)), InvalidInput);
  SimplifyOptions options = within(0.1);
  options.levels = {0.2};
  EXPECT_THROW((void)simplify_with_bound(sphere, options), InvalidInput);
  options.levels.clear();
  options.precision = Precision::Single;
  EXPECT_THROW((void)simplify_with_bound(reference::scaled(sphere, 1e100), options), InvalidInput);
  options.target_ratio = 1.5;
  EXPECT_THROW((void)simplify_with_bound(sphere, options), InvalidInput);
  EXPECT_THROW((void)simplify_with_bound(TriangleMesh(), within(0.1)), InvalidInput);
  options = within(0.1);
  options.texture_tolerance = 1;
  EXPECT_THROW((void)simplify_with_bound(sphere, options), InvalidInput) << "without texture coordinates";
}

/// Below the rounding of coordinates nothing can be proven, not even that a face covers a triangle that was dropped.
TEST_P(SimplifyWithBound, KeepsTheOriginalWhereTheToleranceIsBelowTheRounding) {
  TriangleMesh original = reference::both(reference::unit_square(4), reference::unit_square(1));
  original.vertices.emplace_back(0.5, 0.5, 1);
  original.triangles.push_back({0, 0, static_cast<std::uint32_t>(original.vertices.size() - 1)});
  for (const Precision precision : {Precision::Double, Precision::Single}) {
    for (const double tolerance : {0.0, 1e-17}) {
      SimplifyOptions options = within(tolerance);
      options.precision = precision;
      const SimplifyResult result = simplify_with_bound(original, options);
      expect_within(original, result.last());
      EXPECT_EQ(result.last().ended_by, EndedBy::Rounding);
      EXPECT_EQ(result.last().mesh.triangles, original.triangles);
      EXPECT_EQ(result.dropped_triangles + result.kept_triangles, 0u);
    }
  }
}

/// A triangle with two equal corners is a segment or a point: a part of the original like any other.
TEST_P(SimplifyWithBound, KeepsTheOriginalWhereNoTriangleHasThreeCorners) {
  const TriangleMesh point = {{Eigen::Vector3d::Ones()}, {{0, 0, 0}}};
  const TriangleMesh equal_vertices = {std::vector<Eigen::Vector3d>(3, Eigen::Vector3d::Ones()), {{0, 1, 2}}};
  const TriangleMesh segments = {{{0, 0, 0}, {1, 0, 0}, {1, 2, 0}, {9, 9, 9}}, {{0, 1, 1}, {2, 1, 2}, {0, 0, 1}}};
  for (const TriangleMesh& original : {point, equal_vertices, segments}) {
    for (const double tolerance : {0.0, 0.1, 100.0}) {
      for (const Effort effort : {Effort::Normal, Effort::High}) {
        SimplifyOptions options = within(tolerance);
        options.effort = effort;
        options.prune = options.preserve_boundary = effort == Effort::High;
        options.levels = {0.5 * tolerance};
        options.certificate = true;
        const SimplifyResult result = simplify_with_bound(original, options);
        expect_within(original, result.last());
        EXPECT_EQ(result.last().faces(), original.triangles.size());
        EXPECT_TRUE(result.last().certificate);
      }
    }
  }
}

const auto name_of_driver = [](const auto& driver) { return driver.param.name; };
INSTANTIATE_TEST_SUITE_P(With, SimplifyWithBound, testing::ValuesIn(test::drivers()), name_of_driver);
INSTANTIATE_TEST_SUITE_P(With, Pruning, testing::ValuesIn(test::drivers()), name_of_driver);

}  // namespace simplify_with_bound_test
}  // namespace meshbound
