// SPDX-License-Identifier: MIT
// Pieces of one plane are measured as one polygon, which has the corners that their union has.
#include "penetration/face_borders.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numeric>
#include <span>
#include <vector>

#include "penetration/flush.h"
#include "penetration/triangulate.h"
#include "penetration/volumes.h"
#include "reference/small_meshes.h"
#include "solids.h"

namespace meshbound {
namespace face_borders_test {

using namespace reference;
using namespace solids;

const TriangleMesh unit = box({0, 0, 0}, {1, 1, 1});
/// Eight by eight squares on each side.
const TriangleMesh fine = subdivided(subdivided(subdivided(unit)));

/// Two boxes with a corner of each in the other, along whose curve a thousand pairs of triangles cross.
TEST(IntersectionVolumes, AreNotFoundOnceTheTokenSaysStop) {
  const TriangleMesh finer = subdivided(subdivided(fine));
  const ClosedModel a(finer), b(moved(finer, {0.3, 0.2, 0.1}));
  const Eigen::Isometry3d identity = Eigen::Isometry3d::Identity();
  const std::atomic<bool> told = true;
  PlacedPair pair;
  CrossingCurves curves;
  Pieces pieces;
  const auto place = [&] { pair.place(a.data(), identity, b.data(), identity); };
  const auto stop = [&] { pair.stop_by({.cancel = &told}); };
  const auto find_volumes = [&] { (void)VolumeFinder().find(pair, curves, pieces, VolumeFinder::Cut::Faces); };
  place();
  curves.find(pair, 0x1p-46);
  stop();
  EXPECT_THROW(pieces.find(pair, curves), Stopped);
  place();
  pieces.find(pair, curves);
  stop();
  EXPECT_THROW(find_volumes(), Stopped);
  place();
  EXPECT_NO_THROW(find_volumes()) << "after a search that ended early";
}

/// Two solids stand on one plane, with a square of two triangles of each in common there. Around it are pairs that
/// share an edge or a corner only. A told token shows that these are not cut: the steps to its next look are not
/// reached.
TEST(FlushFaces, AreCutOnlyWhereTrianglesHaveAreaInCommon) {
  TriangleMesh taller = moved(fine, {0.875, 0.875, 0});
  for (Eigen::Vector3d& p : taller.vertices) p.z() *= 2;
  const ClosedModel a(fine), b(taller);
  const Eigen::Isometry3d identity = Eigen::Isometry3d::Identity();
  PlacedPair pair;
  CrossingCurves curves;
  Pieces pieces;
  pair.place(a.data(), identity, b.data(), identity);
  curves.find(pair, 0x1p-46);
  pieces.find(pair, curves);
  EXPECT_GE(curves.flush_pairs.size(), 20U);
  const std::atomic<bool> told = true;
  pair.stop_by({.cancel = &told});
  EXPECT_NO_THROW(EXPECT_EQ(find_flush_faces(pair, curves, pieces).size(), 2U));
}

/// A prism of many sides.
TriangleMesh drum(std::uint32_t corners) {
  TriangleMesh mesh;
  for (const double z : {0.0, 1.0})
    for (std::uint32_t i = 0; i < corners; ++i) {
      const double angle = 2 * std::acos(-1.0) * i / corners;
      mesh.vertices.emplace_back(std::cos(angle), std::sin(angle), z);
    }
  const auto upper = [corners](std::uint32_t i) { return i + corners; };
  for (std::uint32_t i = 2; i < corners; ++i) mesh.triangles.push_back({0, i, i - 1});
  for (std::uint32_t i = 2; i < corners; ++i) mesh.triangles.push_back({upper(0), upper(i - 1), upper(i)});
  for (std::uint32_t i = 0; i < corners; ++i) {
    const std::uint32_t next = i + 1 < corners ? i + 1 : 0;
    mesh.triangles.push_back({i, next, upper(next)});
    mesh.triangles.push_back({i, upper(next), upper(i)});
  }
  return mesh;
}

TEST(Triangulate, EndsWithinAPolygonOnceTheTokenSaysStop) {
  constexpr std::uint32_t count = 400;
  const ClosedModel model(drum(count));
  const Eigen::Isometry3d identity = Eigen::Isometry3d::Identity();
  PlacedPair pair;
  pair.place(model.data(), identity, model.data(), identity);
  const CrossingCurves none;
  const std::vector<Vec3>& at = model.data().positions;
  const auto is_below = [&](std::uint32_t v) { return at[v].z == 0; };
  std::uint32_t lower = 0;  // a triangle of the lower cap, whose corners the numbers of the model do not follow
  while (!std::all_of(model.data().triangles[lower].begin(), model.data().triangles[lower].end(), is_below)) ++lower;
  const PiecePlane cap(pair, none, 0, lower);
  std::vector<PieceCorner> corners;
  for (std::uint32_t v = 0; v < at.size(); ++v)
    if (is_below(v)) corners.push_back({PieceCorner::Kind::Vertex, v});
  const auto angle = [&](const PieceCorner& corner) { return std::atan2(at[corner.index].y, at[corner.index].x); };
  std::sort(corners.begin(), corners.end(), [&](auto& p, auto& q) { return angle(p) > angle(q); });
  const std::span<const PieceCorner> border(corners);
  std::vector<CornerTriple> triangles;
  EXPECT_EQ(triangulate(cap, {&border, 1}, triangles), 0);
  EXPECT_EQ(triangles.size(), count - 2);
  const std::atomic<bool> told = true;
  pair.stop_by({.cancel = &told});
  EXPECT_THROW((void)triangulate(cap, {&border, 1}, triangles), Stopped);
}

/// What two models have in common, cut both ways.
struct Cuts {
  PlacedPair pair;
  CrossingCurves curves;
  std::vector<IntersectionVolume> of_faces, of_pieces;

  Cuts(const TriangleMesh& a, const TriangleMesh& b) : model_a(a), model_b(b) {
    const Eigen::Isometry3d identity = Eigen::Isometry3d::Identity();
    pair.place(model_a.data(), identity, model_b.data(), identity);
    curves.find(pair, 0x1p-46);
    Pieces pieces;
    pieces.find(pair, curves);
    of_faces = VolumeFinder().find(pair, curves, pieces, VolumeFinder::Cut::Faces);
    of_pieces = VolumeFinder().find(pair, curves, pieces, VolumeFinder::Cut::Pieces);
  }

  [[nodiscard]] std::vector<double> areas(std::uint32_t side, const Patch& patch) {
    std::vector<double> all;
    for (const PatchTriangle& t : patch.triangles) {
      const auto at = [&](std::size_t k) { return position_of(pair, curves, side, t.corners[k]); };
      all.push_back(length(cross(at(1) - at(0), at(2) - at(0))) / 2 * std::ldexp(1.0, 2 * pair.exponent()));
    }
    return all;
  }
  [[nodiscard]] double area(std::uint32_t side, const Patch& patch) {
    const std::vector<double> all = areas(side, patch);
    return std::accumulate(all.begin(), all.end(), 0.0);
  }

 private:
  ClosedModel model_a, model_b;
};

/// The part of A has so many triangles and this area, and lies on as many triangles of A as its pieces do.
void expect_part_of_a(Cuts& cuts, std::size_t triangles, double area) {
  ASSERT_EQ(cuts.of_faces.size(), 1U);
  ASSERT_EQ(cuts.of_pieces.size(), 1U);
  const Patch &faces = cuts.of_faces[0].patches[0], &pieces = cuts.of_pieces[0].patches[0];
  EXPECT_EQ(faces.triangles.size(), triangles);
  EXPECT_NEAR(cuts.area(0, faces), area, 1e-12);
  EXPECT_NEAR(cuts.area(0, pieces), area, 1e-12);
  EXPECT_LT(faces.displacement, 1e-12);
  EXPECT_EQ(faces.faces, pieces.faces);
}

TEST(FaceBorders, ACornerOfThreeFaces) {
  Cuts cuts(fine, box({0.3, 0.45, 0.6}, {2, 2, 2}));
  expect_part_of_a(cuts, 6, 0.7 * 0.55 + 0.7 * 0.4 + 0.55 * 0.4);
}

TEST(FaceBorders, ALoopWithinAFace) {
  Cuts cuts(fine, box({0.3, 0.4, 0.5}, {0.8, 0.7, 2}));
  expect_part_of_a(cuts, 2, 0.5 * 0.3);
}

TEST(FaceBorders, AFaceWithAHole) {
  // The column is a hole of B, so that A without the column is common: a face with a hole is cut into 8 triangles.
  Cuts cuts(fine, both(box({-1, -1, -1}, {2, 2, 2}), reversed(box({0.3, 0.4, 0.5}, {0.8, 0.7, 1.5}))));
  expect_part_of_a(cuts, 10 + 8, 6 - 0.5 * 0.3);
}

TEST(FaceBorders, AFaceWithSeveralHoles) {
  TriangleMesh b = box({-1, -1, -1}, {2, 2, 2});
  for (const double x : {0.1, 0.4, 0.7}) b = both(b, reversed(box({x, x, 0.5}, {x + 0.2, 0.95, 1.5})));
  Cuts cuts(fine, b);
  expect_part_of_a(cuts, 10 + 20, 6 - 0.2 * (0.85 + 0.55 + 0.25));
}

/// A column over a triangle of the face z = 1.
TriangleMesh column(const std::array<Eigen::Vector2d, 3>& section) {
  TriangleMesh mesh;
  for (const double z : {0.5, 2.0})
    for (const Eigen::Vector2d& corner : section) mesh.vertices.emplace_back(corner.x(), corner.y(), z);
  mesh.triangles = {{0, 2, 1}, {3, 4, 5}, {0, 1, 3}, {1, 4, 3}, {1, 2, 4}, {2, 5, 4}, {2, 0, 5}, {0, 3, 5}};
  return mesh;
}

TEST(FaceBorders, ATriangleThatIsOnlyTouchedDoesNotCount) {
  // The section lies along the diagonal of A's face, where the perturbation gives either side a piece without area.
  for (const auto& section : {std::array<Eigen::Vector2d, 3>{{{0.25, 0.25}, {0.75, 0.25}, {0.75, 0.75}}},
                              std::array<Eigen::Vector2d, 3>{{{0.25, 0.25}, {0.75, 0.75}, {0.25, 0.75}}}}) {
    Cuts cuts(unit, column(section));
    expect_part_of_a(cuts, 1, 0.125);
    EXPECT_EQ(cuts.of_faces[0].patches[0].faces, 1U);
  }
}

TEST(FaceBorders, ATouchAddsNoTrianglesWithoutArea) {
  // The keel of B dips into the face z = 1 of A and then runs along it.
  TriangleMesh keel;
  keel.vertices = {{0.2, 0.5, 0.5}, {0.5, 0.5, 1}, {0.9, 0.5, 1}, {0.2, 0.4, 2},
                   {0.9, 0.4, 2},   {0.9, 0.6, 2}, {0.2, 0.6, 2}};
  keel.triangles = {{3, 4, 5}, {3, 5, 6}, {4, 2, 5}, {3, 6, 0}, {3, 0, 1},
                    {3, 1, 2}, {3, 2, 4}, {6, 1, 0}, {6, 2, 1}, {6, 5, 2}};
  for (const bool is_a : {true, false}) {
    Cuts cuts(is_a ? keel : unit, is_a ? unit : keel);
    for (const auto* volumes : {&cuts.of_faces, &cuts.of_pieces}) {
      ASSERT_EQ(volumes->size(), 1U);
      for (std::uint32_t side = 0; side < 2; ++side)
        for (const double area : cuts.areas(side, (*volumes)[0].patches[side])) EXPECT_GT(area, 1e-9);
    }
  }
}

TEST(FaceBorders, AModelInside) {
  Cuts cuts(fine, box({-1, -1, -1}, {2, 2, 2}));
  expect_part_of_a(cuts, 12, 6);
}

TEST(FaceBorders, AFaceThatTouchesItself) {
  // Two pits in the top have a corner in common.
  TriangleMesh plate;
  plate.vertices = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {0, 0, 2}, {4, 0, 2},   {4, 4, 2},  {0, 4, 2},
                    {2, 2, 2}, {1, 1, 2}, {1, 3, 2}, {3, 1, 2}, {3, 3, 2}, {1.5, 2, 1}, {2.5, 2, 1}};
  plate.triangles = {{0, 2, 1},   {0, 3, 2},  {0, 1, 5},   {0, 5, 4},    {1, 2, 6},  {1, 6, 5},  {2, 3, 7},
                     {2, 7, 6},   {3, 0, 4},  {3, 4, 7},   {4, 5, 9},    {5, 11, 9}, {9, 11, 8}, {5, 6, 12},
                     {5, 12, 11}, {6, 7, 10}, {6, 10, 12}, {12, 10, 8},  {7, 4, 9},  {7, 9, 10}, {8, 10, 13},
                     {10, 9, 13}, {9, 8, 13}, {8, 11, 14}, {11, 12, 14}, {12, 8, 14}};
  Cuts cuts(plate, box({-1, -1, -1}, {5, 5, 5}));
  // The top has four corners and a hole of six; each pit has three sides.
  ASSERT_EQ(cuts.of_faces.size(), 1U);
  EXPECT_EQ(cuts.of_faces[0].patches[0].triangles.size(), 10U + 10U + 6U);
  EXPECT_NEAR(cuts.area(0, cuts.of_faces[0].patches[0]), cuts.area(0, cuts.of_pieces[0].patches[0]), 1e-12);
  EXPECT_LT(cuts.of_faces[0].patches[0].displacement, 1e-12);
}

TEST(FaceBorders, TheDeepestPointLiesOnItsTriangle) {
  const TriangleMesh other = mapped(fine, motion({0.6, 0.3, 0.4}, 0.7, {1, 2, 3}));
  const PenetrationDepth depth = penetration_depth(fine, other);
  ASSERT_EQ(depth.volumes.size(), 1U);
  const auto distance = [](const TriangleMesh& mesh, const SurfacePoint& point) {
    const Triangle& t = mesh.triangles[point.triangle];
    TriangleMesh one;
    for (const std::uint32_t v : t) one.vertices.push_back(mesh.vertices[v]);
    one.triangles = {{0, 1, 2}};
    return closest_point(Bvh(one), point.position).distance.upper;
  };
  EXPECT_LT(distance(fine, depth.volumes[0].on_a), 1e-12);
  EXPECT_LT(distance(other, depth.volumes[0].on_b), 1e-12);
}

}  // namespace face_borders_test
}  // namespace meshbound
