// SPDX-License-Identifier: MIT
// Penetration depths with known answers.
#include "meshbound/penetration_depth.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "meshbound/error.h"
#include "reference/claims.h"
#include "reference/small_meshes.h"
#include "solids.h"

namespace meshbound {
namespace penetration_depth_test {

using namespace reference;
using namespace solids;

const TriangleMesh unit = box({0, 0, 0}, {1, 1, 1});

void expect_holds(const Bounds& bounds, double value, double width) {
  EXPECT_LE(bounds.lower, value * (1 + 1e-15));
  EXPECT_GE(bounds.upper, value * (1 - 1e-15));
  EXPECT_LE(bounds.upper - bounds.lower, width);
}

/// One volume of this depth and content.
void expect_volume(const PenetrationDepth& result, double depth, double content, double size = 1) {
  ASSERT_EQ(result.volumes.size(), 1U);
  const PenetrationVolume& volume = result.volumes[0];
  expect_holds(volume.depth, depth, 4e-6 * size);
  expect_holds(volume.volume, content, 1e-10 * size * size * size);
  EXPECT_EQ(volume.outcome, Outcome::Converged);
  EXPECT_EQ(result.depth.lower, volume.depth.lower);
  EXPECT_EQ(result.depth.upper, volume.depth.upper);
  EXPECT_NEAR((volume.on_a.position - volume.on_b.position).norm(), volume.depth.lower, 1e-10 * size);
}

TEST(PenetrationDepth, CornerInCorner) {
  const PenetrationDepth result = penetration_depth(unit, box({0.75, 0.5, 0.25}, {2, 2, 2}));
  // The faces x = 1 and x = 0.75, y = 1 and y = 0.5, z = 1 and z = 0.25 face each other; the corner (1 1 1) is 0.25
  // from the nearest.
  expect_volume(result, 0.25, 0.25 * 0.5 * 0.75);
  EXPECT_EQ(result.volumes[0].faces_on_a, 6U);
  EXPECT_EQ(result.volumes[0].faces_on_b, 6U);
  EXPECT_EQ(result.volumes[0].overlap, Overlap::Crossing);
}

TEST(PenetrationDepth, OfTheSmallestSolids) {
  for (const double size : {0x1p-1000, 0x1p-1026, 0x1p-1050}) {
    const TriangleMesh a = scaled(box({0, 0, 0}, {2, 2, 2}), size), b = scaled(box({1, 1, 1}, {3, 3, 3}), size);
    const PenetrationDepth result = penetration_depth(a, b);
    ASSERT_EQ(result.volumes.size(), 1U) << size;
    EXPECT_LE(result.depth.lower, size);
    EXPECT_GE(result.depth.upper, size);
    EXPECT_LE(result.depth.upper, (size < 0x1p-1030 ? 10 : 1.01) * size);
    Eigen::Isometry3d turned(Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized()));
    turned.translation() = size * Eigen::Vector3d(0.125, 0.25, 0.5);
    const ClosedModel model_a(a), model_b(b);
    EXPECT_EQ(penetration_depth({model_a, turned}, {model_b, turned}).volumes.size(), 1U) << size;
  }
}

TEST(PenetrationDepth, PegInAHoleOfItsOwn) {
  // On A a square of the face z = 1, on B the peg below it. Its bottom is 0.5 below.
  const PenetrationDepth result = penetration_depth(unit, box({0.4, 0.4, 0.5}, {0.6, 0.6, 2}));
  expect_volume(result, 0.5, 0.2 * 0.2 * 0.5);
  EXPECT_EQ(result.volumes[0].faces_on_a, 2U);
  EXPECT_EQ(result.volumes[0].faces_on_b, 10U);
}

TEST(PenetrationDepth, SpikeThroughTheMiddleOfATriangle) {
  // Crosses no edge of A: a single loop within one of its triangles.
  TriangleMesh spike;
  spike.vertices = {{0.75, 0.25, 0.5}, {0.7, 0.2, 2}, {0.8, 0.2, 2}, {0.75, 0.3, 2}};
  spike.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 3}, {1, 2, 3}};
  const PenetrationDepth result = penetration_depth(unit, spike);
  // A third of its height is inside; the tip is 0.5 from the section, and nothing else is further.
  expect_volume(result, 0.5, 0.005 * 1.5 / 3 / 27);
  EXPECT_EQ(result.volumes[0].faces_on_a, 1U);
  EXPECT_EQ(result.volumes[0].faces_on_b, 3U);
}

double area(const TriangleMesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles)
    sum += (mesh.vertices[t[1]] - mesh.vertices[t[0]]).cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]).norm() / 2;
  return sum;
}

/// A lies in B but for a hole that a cavity of B makes in the middle of one of A's triangles.
TEST(PenetrationDepth, ACavityThroughTheMiddleOfATriangle) {
  TriangleMesh cavity;
  cavity.vertices = {{0.7, 0.2, 0.875}, {0.8, 0.2, 0.875}, {0.75, 0.3, 0.875}, {0.75, 0.25, 1.125}};
  cavity.triangles = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
  PenetrationOptions options;
  options.keep_parts = true;
  const PenetrationDepth result = penetration_depth(unit, both(box({-1, -1, -1}, {2, 2, 2}), cavity), options);
  ASSERT_EQ(result.volumes.size(), 1U);
  // The section is half as wide as the base, whose area is 0.005.
  const double base = 0.005, section = base / 4;
  expect_holds(result.volumes[0].volume, 1 - (base * 0.25 - section * 0.125) / 3, 1e-10);
  EXPECT_NEAR(area(result.volumes[0].parts->on_a), 6 - section, 1e-12);
  EXPECT_EQ(result.volumes[0].faces_on_a, 12U);
  EXPECT_EQ(result.volumes[0].faces_on_b, 4U);
}

struct PlateWithHoles {
  double side;
  std::vector<std::array<Eigen::Vector2d, 3>> holes;
};

/// The top of A, two triangles, without the sections of cavities of B that go through it.
void expect_part_without_holes(const PlateWithHoles& plate) {
  const double n = plate.side;
  TriangleMesh a = box({0, 0, -4}, {n, n, 0}), b = box({-2, -2, -8}, {n + 2, n + 2, 8});
  a.triangles[2] = {4, 5, 6}, a.triangles[3] = {5, 7, 6};
  double expected = area(a);
  for (const auto& [p, q, r] : plate.holes) {
    TriangleMesh cavity;
    for (const double z : {-1.0, 1.0})
      for (const Eigen::Vector2d& corner : {p, q, r}) cavity.vertices.emplace_back(corner.x(), corner.y(), z);
    cavity.triangles = {{0, 1, 2}, {3, 5, 4}, {0, 3, 1}, {1, 3, 4}, {1, 4, 2}, {2, 4, 5}, {2, 5, 0}, {0, 5, 3}};
    b = both(b, cavity);
    expected -= std::fabs((q - p).x() * (r - p).y() - (q - p).y() * (r - p).x()) / 2;
  }
  PenetrationOptions options;
  options.keep_parts = true;
  options.error_bound = 1e-3;
  const PenetrationDepth result = penetration_depth(a, b, options);
  ASSERT_EQ(result.volumes.size(), 1U);
  EXPECT_NEAR(area(result.volumes[0].parts->on_a), expected, 1e-9);
  EXPECT_LE(result.depth.upper - result.depth.lower, options.error_bound);
}

/// Corners on lattice points: the way from a hole to what is around it passes through other corners, or other holes.
TEST(PenetrationDepth, HolesWithCornersInLine) {
  const std::vector<PlateWithHoles> plates{
      {7, {{{{1, 2}, {1, 1}, {2, 3}}}}},                                 // through a corner
      {6, {{{{1, 4}, {3, 2}, {3, 3}}}}},                                 // a corner on the diagonal of the plate
      {13, {{{{7, 6}, {5, 3}, {6, 4}}}, {{{6, 5}, {6, 6}, {4, 4}}}}},    // through the other hole
      {9, {{{{1, 5}, {5, 4}, {1, 6}}}, {{{6, 3}, {2, 3}, {3, 1}}}}},     // two ways to one corner
      {13, {{{{8, 8}, {6, 4}, {12, 9}}}, {{{5, 2}, {6, 3}, {1, 12}}}}},  // an edge through an ear, no corner in it
  };
  for (std::size_t i = 0; i < plates.size(); ++i) {
    SCOPED_TRACE(i);
    expect_part_without_holes(plates[i]);
  }
}

TEST(PenetrationDepth, IsSymmetricInTheTwoModels) {
  const TriangleMesh b = mapped(unit, motion({0.3, 0.4, 0.6}, 0.7, {1, 2, 3}));
  const PenetrationDepth one = penetration_depth(unit, b), other = penetration_depth(b, unit);
  ASSERT_EQ(one.volumes.size(), 1U);
  ASSERT_EQ(other.volumes.size(), 1U);
  expect_meets(one.depth, other.depth);
  expect_meets(one.volumes[0].volume, other.volumes[0].volume);
  EXPECT_EQ(one.volumes[0].faces_on_a, other.volumes[0].faces_on_b);
}

TEST(PenetrationDepth, SeveralVolumes) {
  // A fork of two prongs, one deeper than the other, made of one body.
  TriangleMesh fork = both(box({0.1, 0.1, 0.75}, {0.2, 0.9, 3}), box({0.7, 0.1, 0.5}, {0.9, 0.9, 3}));
  const PenetrationDepth result = penetration_depth(unit, fork);
  ASSERT_EQ(result.volumes.size(), 2U);
  expect_holds(result.volumes[0].depth, 0.5, 4e-6);
  expect_holds(result.volumes[1].depth, 0.25, 4e-6);
  expect_holds(result.volumes[0].volume, 0.2 * 0.8 * 0.5, 1e-10);
  expect_holds(result.volumes[1].volume, 0.1 * 0.8 * 0.25, 1e-10);
  EXPECT_EQ(result.depth.lower, result.volumes[0].depth.lower);
}

TEST(PenetrationDepth, OneInsideTheOther) {
  const TriangleMesh small = box({0.4, 0.4, 0.4}, {0.6, 0.6, 0.6});
  // The corners of the two boxes are 0.4 sqrt(3) apart.
  const PenetrationDepth b_inside = penetration_depth(unit, small);
  expect_volume(b_inside, 0.4 * std::sqrt(3.0), 0.008);
  EXPECT_EQ(b_inside.volumes[0].overlap, Overlap::BInsideA);
  EXPECT_EQ(b_inside.volumes[0].faces_on_a, 12U);
  const PenetrationDepth a_inside = penetration_depth(small, unit);
  expect_volume(a_inside, 0.4 * std::sqrt(3.0), 0.008);
  EXPECT_EQ(a_inside.volumes[0].overlap, Overlap::AInsideB);
}

TEST(PenetrationDepth, InsideACavityIsOutside) {
  const TriangleMesh hollow = both(unit, reversed(box({0.2, 0.2, 0.2}, {0.8, 0.8, 0.8})));
  EXPECT_TRUE(penetration_depth(hollow, box({0.4, 0.4, 0.4}, {0.6, 0.6, 0.6})).volumes.empty());
  EXPECT_FALSE(in_contact(ClosedModel(hollow), ClosedModel(box({0.4, 0.4, 0.4}, {0.6, 0.6, 0.6}))));
  // Within the wall, whose inner surface does not surround it.
  const PenetrationDepth in_wall = penetration_depth(hollow, box({0.05, 0.4, 0.4}, {0.15, 0.6, 0.6}));
  ASSERT_EQ(in_wall.volumes.size(), 1U);
  EXPECT_EQ(in_wall.volumes[0].faces_on_a, 12U);
  EXPECT_EQ(in_wall.volumes[0].overlap, Overlap::BInsideA);
}

TEST(PenetrationDepth, TheNextComponentAroundAVolumeStandsForAMissingPart) {
  // A solid within the cavity of another one, both of A; B lies in the inner one, 0.125 from its sides.
  const TriangleMesh nested = both(both(box({-3, -3, -3}, {4, 4, 4}), reversed(box({-2, -2, -2}, {3, 3, 3}))), unit);
  const PenetrationDepth result = penetration_depth(nested, box({0.125, 0.125, 0.125}, {0.875, 0.875, 0.875}));
  expect_volume(result, 0.125 * std::sqrt(3.0), 0.421875, 12);
  EXPECT_EQ(result.volumes[0].faces_on_a, 12U);
  EXPECT_EQ(result.volumes[0].overlap, Overlap::BInsideA);
}

TEST(PenetrationDepth, ACavityOfTheVolumeBelongsToIt) {
  // A hollow cube within a block: the cavity of A is a cavity of the volume, whose outer shell is all of A.
  const TriangleMesh hollow = both(unit, reversed(box({0.25, 0.25, 0.25}, {0.75, 0.75, 0.75})));
  const PenetrationDepth around = penetration_depth(hollow, box({-1, -1, -1}, {2, 2, 2}));
  ASSERT_EQ(around.volumes.size(), 1U);
  expect_holds(around.volumes[0].volume, 1 - 0.125, 1e-9);
  EXPECT_EQ(around.volumes[0].faces_on_a, 24U);
  EXPECT_EQ(around.volumes[0].overlap, Overlap::AInsideB);
  // A cavity of each: they overlap, so that the cavity of the volume has parts of both.
  const TriangleMesh other = both(box({-1, -1, -1}, {2, 2, 2}), reversed(box({0.5, 0.5, 0.5}, {0.9, 0.9, 0.9})));
  const PenetrationDepth crossing = penetration_depth(hollow, other);
  ASSERT_EQ(crossing.volumes.size(), 1U);
  expect_holds(crossing.volumes[0].volume, 1 - 0.125 - 0.4 * 0.4 * 0.4 + 0.25 * 0.25 * 0.25, 1e-9);
  EXPECT_EQ(crossing.volumes[0].overlap, Overlap::Crossing);
}

TEST(PenetrationDepth, ThroughAndThrough) {
  // A bar through a plate: on A two squares, on B the bar between them; the middle of the bar is furthest from both.
  const PenetrationDepth result = penetration_depth(box({-2, -2, 0}, {2, 2, 1}), box({-0.5, -0.5, -3}, {0.5, 0.5, 3}));
  expect_volume(result, 0.5, 1, 4);
}

TEST(PenetrationDepth, FacesOfManyTrianglesNeedNoIntegers) {
  // A curve that crosses triangles of one plane has many corners in one line, which doubles cannot tell from a turn.
  const TriangleMesh fine = subdivided(subdivided(subdivided(unit)));
  const ClosedModel coarse_model(unit), fine_model(fine);
  const Eigen::Isometry3d pose = motion({0.6, 0.3, 0.4}, 0.7, {1, 2, 3});
  const PenetrationDepth coarse = penetration_depth({coarse_model}, {coarse_model, pose}),
                         result = penetration_depth({fine_model}, {fine_model, pose});
  EXPECT_GT(result.stats.crossings, 5 * coarse.stats.crossings);
  EXPECT_EQ(result.stats.exact_decisions, 0U);
  ASSERT_EQ(result.volumes.size(), 1U);
  EXPECT_LE(result.depth.lower, coarse.depth.upper);
  EXPECT_GE(result.depth.upper, coarse.depth.lower);
}

TEST(PenetrationDepth, SpheresApproachTheLensBetweenThem) {
  // Two unit spheres at distance 1.5: the caps are 0.25 high and face each other; the poles are 0.5 apart. Volume of
  // the lens: pi (4 + d)(2 - d)^2 / 12 with d = 1.5.
  double last_error = 1;
  for (int level = 2; level <= 4; ++level) {
    const TriangleMesh sphere = icosphere(level);
    const PenetrationDepth result = penetration_depth(sphere, mapped(sphere, motion({1.5, 0, 0}, 0.3, {1, 1, 0})));
    ASSERT_EQ(result.volumes.size(), 1U);
    const double sunk = 1 - inscribed_radius(sphere);
    EXPECT_LE(result.depth.lower, 0.5 + 4 * sunk);
    EXPECT_GE(result.depth.upper, 0.5 - 4 * sunk);
    const double lens = std::numbers::pi * 5.5 * 0.25 / 12;
    const double error = std::abs(result.volumes[0].volume.upper - lens) / lens;
    EXPECT_LT(error, 0.4 * last_error);
    last_error = error;
  }
}

TEST(PenetrationDepth, PosesGiveWhatMovedVerticesGive) {
  const TriangleMesh sphere = icosphere(2);
  const Eigen::Isometry3d pose_a = motion({3, -2, 1}, 1.1, {1, 0, 2}),
                          pose_b = motion({3.4, -1.6, 1.3}, 0.4, {0, 1, 1});
  const ClosedModel model_a(sphere), model_b(unit);
  const PenetrationDepth posed = penetration_depth({model_a, pose_a}, {model_b, pose_b});
  const PenetrationDepth moved = penetration_depth(mapped(sphere, pose_a), mapped(unit, pose_b));
  ASSERT_EQ(posed.volumes.size(), 1U);
  ASSERT_EQ(moved.volumes.size(), 1U);
  EXPECT_NEAR(posed.depth.upper, moved.depth.upper, 1e-5);
  EXPECT_NEAR(posed.volumes[0].volume.upper, moved.volumes[0].volume.upper, 1e-9);
  EXPECT_LT((posed.volumes[0].on_a.position - moved.volumes[0].on_a.position).norm(), 1e-3);
}

TEST(PenetrationDepth, TouchingSharesNoContent) {
  for (const Vector3d& shift : {Vector3d(1, 0, 0), Vector3d(-1, 0, 0), Vector3d(1, 0.5, 0.25), Vector3d(1, 1, 0),
                                Vector3d(1, -1, 0), Vector3d(1, 1, 1), Vector3d(-1, -1, -1), Vector3d(0, 0, -1)}) {
    const TriangleMesh other = moved(unit, shift);
    EXPECT_TRUE(penetration_depth(unit, other).volumes.empty()) << shift.transpose();
    EXPECT_TRUE(penetration_depth(other, unit).volumes.empty()) << shift.transpose();
    EXPECT_TRUE(in_contact(ClosedModel(unit), ClosedModel(other)));
    const Vector3d further = shift * (1 + 1e-15);
    EXPECT_FALSE(in_contact(ClosedModel(unit), ClosedModel(moved(unit, further)))) << shift.transpose();
  }
}

/// Sides that lie in one plane bound the volume on both models: neither has to reach across to the far end of it.
TEST(PenetrationDepth, FlushFacesCountToBothModels) {
  for (const double sign : {1.0, -1.0}) {
    for (const double shift : {0.125, 0.5, 0.75}) {
      const TriangleMesh other = moved(unit, {sign * shift, 0, 0});
      // On A the face that B covers: its middle is half from the sides, or 1 - shift from the face of B.
      const double depth = std::min(0.5, 1 - shift);
      expect_volume(penetration_depth(unit, other), depth, 1 - shift);
      expect_volume(penetration_depth(other, unit), depth, 1 - shift);
    }
  }
}

TEST(PenetrationDepth, OfAModelAndItself) {
  const PenetrationDepth equal = penetration_depth(unit, subdivided(unit));
  expect_volume(equal, 0, 1);
  EXPECT_EQ(equal.volumes[0].faces_on_a, 12U);
  EXPECT_EQ(equal.volumes[0].faces_on_b, 48U);
}

/// A box that stands on the inside of a face: A's part is where it stands, whichever face that is.
TEST(PenetrationDepth, ABoxOnTheInsideOfAFace) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool top : {false, true}) {
      Vector3d low(0.375, 0.375, 0.375), high(0.625, 0.625, 0.625);
      (top ? high : low)[axis] = top ? 1 : 0;
      const TriangleMesh inner = box(low, high);
      for (const bool is_swapped : {false, true}) {
        const PenetrationDepth result = is_swapped ? penetration_depth(inner, unit) : penetration_depth(unit, inner);
        expect_volume(result, 0.625, 0.25 * 0.25 * 0.625);
        EXPECT_EQ(result.volumes[0].overlap, Overlap::Crossing);
        EXPECT_EQ(is_swapped ? result.volumes[0].faces_on_a : result.volumes[0].faces_on_b, 12U);
        EXPECT_LE(is_swapped ? result.volumes[0].faces_on_b : result.volumes[0].faces_on_a, 2U);
      }
    }
  }
}

/// A flush face within a triangle that has several pieces inside: only the piece around it gets it.
TEST(PenetrationDepth, AFlushFaceAmongSeveralPieces) {
  // Two pegs end in the face z = 1 of A, from below and from above, and a third goes through it.
  const TriangleMesh pegs =
      both(both(box({0.125, 0.25, 0.5}, {0.25, 0.375, 1}), box({0.375, 0.5, 0.5}, {0.5, 0.625, 2})),
           box({0.125, 0.5, 0.75}, {0.25, 0.875, 2}));
  const TriangleMesh plate = box({0, 0, -2}, {1, 1, 1});
  for (const PenetrationDepth& result :
       {penetration_depth(unit, pegs), penetration_depth(pegs, unit), penetration_depth(plate, pegs)}) {
    ASSERT_EQ(result.volumes.size(), 3U);
    expect_holds(result.volumes[0].depth, 0.5, 4e-6);
    expect_holds(result.volumes[1].depth, 0.5, 4e-6);
    expect_holds(result.volumes[2].depth, 0.25, 4e-6);
  }
}

TEST(PenetrationDepth, ATouchOfOneRoundingIsMeasured) {
  // The smallest overlap that doubles can express beside 1.
  const double thin = 0x1p-53;
  const PenetrationDepth result = penetration_depth(unit, box({1 - thin, 0.25, 0.25}, {2, 0.75, 0.75}));
  ASSERT_EQ(result.volumes.size(), 1U);
  EXPECT_LE(result.depth.lower, thin);
  EXPECT_GE(result.depth.upper, thin);
  EXPECT_LE(result.volumes[0].volume.lower, thin / 4);
  EXPECT_GE(result.volumes[0].volume.upper, thin / 4);
}

/// The edges of a bar go through both sides of a plate that is as thin as doubles allow: in which order is not to be
/// seen in doubles.
TEST(PenetrationDepth, APlateOfOneRounding) {
  const double thin = 0x1p-53;
  const TriangleMesh plate = box({-1, -1, 0.5}, {2, 2, 0.5 + thin}), bar = box({0.25, 0.25, -3}, {0.75, 0.5, 3});
  for (const PenetrationDepth& result : {penetration_depth(plate, bar), penetration_depth(bar, plate)}) {
    ASSERT_EQ(result.volumes.size(), 1U);
    EXPECT_EQ(result.volumes[0].faces_on_a + result.volumes[0].faces_on_b, 12U)
        << "four sides of the bar, two of the plate";
    EXPECT_LE(result.volumes[0].volume.lower, 0.125 * thin);
    EXPECT_GE(result.volumes[0].volume.upper, 0.125 * thin);
  }
}

TEST(PenetrationDepth, ScalesAndOffsets) {
  const TriangleMesh b = box({0.75, 0.5, 0.25}, {2, 2, 2});
  for (const double scale : {1e-100, 1e-9, 1e9, 1e90})
    expect_volume(penetration_depth(scaled(unit, scale), scaled(b, scale)), 0.25 * scale,
                  0.25 * 0.5 * 0.75 * scale * scale * scale, scale);
  // Offsets that leave all coordinates exact.
  for (const double offset : {0x1p20, 0x1p40}) {
    const Vector3d far(offset, -offset, 2 * offset);
    expect_volume(penetration_depth(moved(unit, far), moved(b, far)), 0.25, 0.25 * 0.5 * 0.75);
    const Eigen::Isometry3d pose = motion(far);
    const ClosedModel model_a(unit), model_b(b);
    expect_volume(penetration_depth({model_a, pose}, {model_b, pose}), 0.25, 0.25 * 0.5 * 0.75);
  }
}

TEST(PenetrationDepth, FarPairsCostNothing) {
  const ClosedModel sphere(icosphere(4));
  const PenetrationDepth far = penetration_depth(sphere, {sphere, motion({5, 0, 0})});
  EXPECT_TRUE(far.volumes.empty());
  EXPECT_LE(far.stats.node_pairs, 8U);
  const PenetrationDepth shallow = penetration_depth(sphere, {sphere, motion({1.99, 0, 0})});
  EXPECT_EQ(shallow.volumes.size(), 1U);
  EXPECT_LE(shallow.stats.triangle_pairs, 4000U) << "of 26 million";
}

TEST(PenetrationDepth, DecidesADepth) {
  const TriangleMesh fork = both(box({0.1, 0.1, 0.75}, {0.2, 0.9, 3}), box({0.7, 0.1, 0.5}, {0.9, 0.9, 3}));
  PenetrationOptions options;
  options.decide = 0.3;
  const PenetrationDepth both_volumes = penetration_depth(unit, fork, options);
  ASSERT_EQ(both_volumes.volumes.size(), 2U);
  EXPECT_EQ(both_volumes.volumes[0].verdict, Verdict::Exceeds);
  EXPECT_EQ(both_volumes.volumes[1].verdict, Verdict::Within);
  EXPECT_LE(both_volumes.volumes[1].depth.upper, 0.3);
  options.decide = 0.2;
  options.stop_when_deeper = true;
  const PenetrationDepth first = penetration_depth(unit, fork, options);
  ASSERT_EQ(first.volumes.size(), 1U);
  EXPECT_EQ(first.volumes[0].verdict, Verdict::Exceeds);
  EXPECT_EQ(first.depth.upper, std::numeric_limits<double>::infinity());
}

TEST(PenetrationDepth, TheSameForAnyNumberOfThreads) {
  const ClosedModel a(icosphere(5)), b(subdivided(subdivided(unit)));
  const Eigen::Isometry3d pose = motion({0.5, 0.25, 0.125}, 0.8, {3, 1, 2});
  PenetrationOptions options;
  const PenetrationDepth one = penetration_depth(a, {b, pose}, options);
  for (const int threads : {2, 3}) {
    options.threads = threads;
    const PenetrationDepth many = penetration_depth(a, {b, pose}, options);
    ASSERT_EQ(many.volumes.size(), one.volumes.size());
    EXPECT_EQ(many.depth.lower, one.depth.lower);
    EXPECT_EQ(many.depth.upper, one.depth.upper);
    EXPECT_EQ(many.volumes[0].volume.lower, one.volumes[0].volume.lower);
    EXPECT_EQ(many.volumes[0].on_a.position, one.volumes[0].on_a.position);
  }
}

/// Four pegs in a bar, each deeper than the one before. The other pair is a corner in a corner.
TEST(PenetrationDepth, AnswersWhatProgressAsksOfOtherPairs) {
  const TriangleMesh bar = box({0, 0, 0}, {10, 1, 1});
  TriangleMesh pegs;
  for (const double depth : {0.1, 0.2, 0.3, 0.4})
    pegs = both(pegs, box({20 * depth, 0.25, 1 - depth}, {20 * depth + 1, 0.75, 3}));
  const ClosedModel a(bar), b(pegs), other(box({-1, -1, -1}, {0.25, 0.25, 0.25}));
  PenetrationOptions options;
  options.keep_parts = true;
  const PenetrationDepth alone = penetration_depth(a, b, options);
  const PenetrationDepth of_others = penetration_depth(a, other);
  ASSERT_EQ(alone.volumes.size(), 4U);
  for (const bool only_contact : {true, false}) {
    int calls = 0;
    options.progress = [&](double) {
      ++calls;
      EXPECT_TRUE(in_contact(a, other));
      if (only_contact) return;
      EXPECT_EQ(penetration_depth(a, other).depth.lower, of_others.depth.lower);
      EXPECT_EQ(penetration_depth(a, b).depth.lower, alone.depth.lower);
    };
    const PenetrationDepth asked = penetration_depth(a, b, options);
    EXPECT_EQ(calls, 4);
    EXPECT_EQ(asked.depth.lower, alone.depth.lower);
    EXPECT_EQ(asked.depth.upper, alone.depth.upper);
    ASSERT_EQ(asked.volumes.size(), 4U);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(asked.volumes[i].volume.lower, alone.volumes[i].volume.lower);
      EXPECT_EQ(asked.volumes[i].on_a.position, alone.volumes[i].on_a.position);
      EXPECT_EQ(asked.volumes[i].parts->on_a.vertices, alone.volumes[i].parts->on_a.vertices);
    }
    EXPECT_EQ(asked.stats.crossings, alone.stats.crossings);
  }
}

TEST(PenetrationDepth, KeepsTheParts) {
  PenetrationOptions options;
  options.keep_parts = true;
  const PenetrationDepth result = penetration_depth(unit, box({0.4, 0.4, 0.5}, {0.6, 0.6, 2}), options);
  ASSERT_TRUE(result.volumes.at(0).parts);
  const PenetrationParts& parts = *result.volumes[0].parts;
  EXPECT_NEAR(area(parts.on_a), 0.04, 1e-12);
  for (const Vector3d& p : parts.on_b.vertices) EXPECT_LE(p.z(), 1);
  ASSERT_EQ(parts.triangle_of_a.size(), parts.on_a.triangles.size());
  ASSERT_EQ(parts.triangle_of_b.size(), parts.on_b.triangles.size());
  for (const std::uint32_t t : parts.triangle_of_a) EXPECT_TRUE(t == 2 || t == 3) << "the face z = 1";
}

TEST(PenetrationDepth, RefusesWhatIsNoLengthOrMotion) {
  const ClosedModel model(unit);
  PenetrationOptions options;
  options.error_bound = -1;
  EXPECT_THROW((void)penetration_depth(model, model, options), InvalidInput);
  options = {};
  options.decide = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)penetration_depth(model, model, options), InvalidInput);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() *= 2;
  EXPECT_THROW((void)penetration_depth(model, {model, pose}), InvalidInput);
  pose.linear() = -Eigen::Matrix3d::Identity();
  EXPECT_THROW((void)penetration_depth({model, pose}, model), InvalidInput);
  pose = motion({std::numeric_limits<double>::infinity(), 0, 0});
  EXPECT_THROW((void)in_contact(model, {model, pose}), InvalidInput);
}

TEST(PenetrationDepth, SaysWhenTheTimeEndsBeforeTheVolumesAreKnown) {
  const ClosedModel model(unit);
  PenetrationOptions options;
  options.budget.seconds = 0;
  const PenetrationDepth open = penetration_depth(model, {model, motion({0.5, 0.4, 0.3})}, options);
  EXPECT_FALSE(open.volumes_known);
  EXPECT_TRUE(open.volumes.empty());
  EXPECT_EQ(open.depth.lower, 0);
  EXPECT_EQ(open.depth.upper, std::numeric_limits<double>::infinity());
  EXPECT_TRUE(penetration_depth(model, {model, motion({0.5, 0.4, 0.3})}).volumes_known) << "its memory is clean";
}

TEST(PenetrationDepth, EndsWhenCancelled) {
  const ClosedModel model(unit);
  const std::atomic<bool> cancel = true;
  PenetrationOptions options;
  options.cancel = &cancel;
  EXPECT_THROW((void)penetration_depth(model, {model, motion({0.5, 0.4, 0.3})}, options), Interrupted);
}

}  // namespace penetration_depth_test
}  // namespace meshbound
