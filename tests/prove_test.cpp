// SPDX-License-Identifier: MIT
// The proof of a mesh from nothing: it proves what holds, never what does not, names what is at fault, and is the same
// for any number of threads. Then proofs of single changes, and covers of single triangles.
#include "simplify/prove.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "datasets/analytic_meshes.h"
#include "decimation_states.h"
#include "geometry/boxes.h"
#include "meshbound/distance.h"
#include "numeric/numbers_below.h"
#include "reference/small_meshes.h"
#include "simplify/change_prover.h"
#include "simplify/cover/forward_cover.h"
#include "simplify/mesh/indexed_manifold.h"
#include "simplify/propose.h"
#include "simplify/repair.h"

namespace meshbound {
namespace prove_test {

using Eigen::Vector3d;

std::vector<Vec3> positions_of(const TriangleMesh& mesh) {
  std::vector<Vec3> positions;
  for (const Vector3d& p : mesh.vertices) positions.push_back({p.x(), p.y(), p.z()});
  return positions;
}

/// A decimation state whose mesh shares no vertex or triangle with its original, so that all of it is unproven.
struct Approximation {
  Approximation(const TriangleMesh& original, const TriangleMesh& mesh, double tolerance,
                const std::vector<double>& limits = {})
      : soup(original),
        vertices(positions_of(original)),
        tree(original),
        state(original_of_decimation(vertices, soup.triangles, tree), indexed_manifold(mesh),
              std::vector<std::uint32_t>(mesh.vertices.size(), 0),
              std::vector<std::uint32_t>(mesh.triangles.size(), 0)) {
    if (!limits.empty()) {
      std::vector<Eigen::AlignedBox3d> boxes(original.triangles.size());
      for (std::size_t t = 0; t < boxes.size(); ++t)
        for (const std::uint32_t v : original.triangles[t]) boxes[t].extend(original.vertices[v]);
      state.local.emplace(std::move(boxes), limits);
    }
    state.starts_as_original = false;
    state.grow_tolerance(tolerance);
    state.set_samples(tolerance);
    for (std::uint32_t v = 0; v < state.mesh.vertex_count(); ++v) state.last_changes.set(v, 1);
  }
  Approximation(const Approximation&) = delete;
  Approximation& operator=(const Approximation&) = delete;

  /// Leaves only the originals to be proven.
  void take_faces_as_near() {
    state.last_changes.clear();
    state.cover = CoverAssignment(state.triangles.size());
  }

  TriangleMesh soup;
  std::vector<Vec3> vertices;
  Bvh tree;
  DecimationState state;
};

Unproven prove(const TriangleMesh& original, const TriangleMesh& mesh, double tolerance,
               const std::vector<double>& limits = {}, int threads = 1) {
  Approximation it(original, mesh, tolerance, limits);
  ProofWorkers workers(it.state, threads);
  Proof proof(it.state, workers);
  proof.run({});
  Unproven unproven = proof.unproven();
  if (unproven.faces.empty()) return unproven;
  it.take_faces_as_near();
  Proof of_originals(it.state, workers);
  of_originals.run({});
  unproven.originals = of_originals.unproven().originals;
  return unproven;
}

struct Pair {
  const char* name;
  TriangleMesh original, mesh;
};

std::vector<Pair> pairs() {
  return {{"sphere", datasets::icosphere(1, 5), datasets::icosphere(1, 3)},
          {"torus", datasets::torus(1, 0.3, 120, 48), datasets::torus(1, 0.3, 50, 20)},
          {"other way round", datasets::torus(1, 0.3, 50, 20), datasets::torus(1, 0.3, 70, 30)},
          {"tilted sphere", datasets::icosphere(1, 4), datasets::uv_sphere(1, 20, 40)},
          {"open", datasets::terrain(1, 32, 5), datasets::terrain(1, 16, 5)}};
}

TEST(Proof, ProvesWhatHoldsWithALittleRoom) {
  for (const Pair& pair : pairs()) {
    SCOPED_TRACE(pair.name);
    const double distance = hausdorff_distance(Bvh(pair.original), Bvh(pair.mesh)).bounds.upper;
    const Unproven unproven = prove(pair.original, pair.mesh, 1.1 * distance);
    EXPECT_EQ(unproven.originals, std::vector<std::uint32_t>());
    EXPECT_EQ(unproven.faces, std::vector<std::uint32_t>());
  }
}

TEST(Proof, NeverProvesWhatDoesNotHold) {
  for (const Pair& pair : pairs()) {
    SCOPED_TRACE(pair.name);
    const double distance = hausdorff_distance(Bvh(pair.original), Bvh(pair.mesh)).bounds.lower;
    EXPECT_FALSE(prove(pair.original, pair.mesh, 0.999 * distance).empty());
  }
}

TEST(Proof, IsTheSameForAnyNumberOfThreads) {
  for (const Pair& pair : pairs()) {
    const double distance = hausdorff_distance(Bvh(pair.original), Bvh(pair.mesh)).bounds.upper;
    const Unproven one = prove(pair.original, pair.mesh, 0.6 * distance);
    const Unproven three = prove(pair.original, pair.mesh, 0.6 * distance, {}, 3);
    EXPECT_FALSE(one.empty());
    EXPECT_EQ(one.originals, three.originals);
    EXPECT_EQ(one.faces, three.faces);
  }
}

TEST(Proof, NamesTheFacesOfAVertexThatWasMovedOut) {
  TriangleMesh moved = datasets::icosphere(1, 3);
  const std::uint32_t vertex = moved.triangles[100][1];
  moved.vertices[vertex] *= 1.05;
  std::vector<std::uint32_t> around;
  for (std::uint32_t t = 0; t < moved.triangles.size(); ++t)
    if (std::count(moved.triangles[t].begin(), moved.triangles[t].end(), vertex) > 0) around.push_back(t);
  EXPECT_EQ(prove(datasets::icosphere(1, 4), moved, 0.02).faces, around);
}

TEST(Proof, NamesAnOriginalTriangleWithNothingNear) {
  const TriangleMesh original = reference::unit_square(8);
  TriangleMesh with_hole = original;
  with_hole.triangles.erase(with_hole.triangles.begin() + 50);
  const Unproven unproven = prove(original, with_hole, 0.01);
  EXPECT_EQ(unproven.originals, std::vector<std::uint32_t>{50});
  EXPECT_EQ(unproven.faces, std::vector<std::uint32_t>());
}

TEST(Proof, AsksForOriginalsOnceNoFaceIsTooFar) {
  TriangleMesh moved = datasets::icosphere(1, 3);
  moved.vertices[50] *= 1.05;
  Approximation it(datasets::icosphere(1, 4), moved, 0.02);
  ProofWorkers workers(it.state, 1);
  Proof proof(it.state, workers);
  proof.run({});
  EXPECT_FALSE(proof.unproven().faces.empty());
  EXPECT_EQ(proof.originals_tested, 0U);
  EXPECT_EQ(proof.faces_tested, moved.triangles.size());
  const std::vector<std::uint32_t> faces = proof.unproven().faces;
  it.state.mesh.move(50, (1 / 1.05) * it.state.mesh.position(50));
  proof.reopen(faces);
  proof.run({});
  EXPECT_TRUE(proof.unproven().empty());
  EXPECT_EQ(proof.originals_tested, it.state.triangles.size());
  EXPECT_EQ(proof.faces_tested, moved.triangles.size() + faces.size());
}

/// A vertex at the border moves inwards, in the plane: the faces around it are near, but leave a part uncovered.
TEST(Proof, CoversAgainWhatAChangedFaceHadCovered) {
  const TriangleMesh square = reference::unit_square(8);
  Approximation it(square, square, 0.01);
  ProofWorkers workers(it.state, 1);
  Proof proof(it.state, workers);
  proof.run({});
  ASSERT_TRUE(proof.unproven().empty());
  const std::uint64_t covered = proof.originals_tested;
  ArrayMesh& mesh = it.state.mesh;
  std::uint32_t at_border = 0;
  while (mesh.position(at_border).x != 0 || mesh.position(at_border).y != 0.5) ++at_border;
  std::vector<std::uint32_t> around;
  mesh.for_each_corner(at_border, [&](Corner c) { return around.push_back(c / 3), true; });
  mesh.move(at_border, {0.06, 0.5, 0});
  proof.reopen(around);
  proof.run({});
  EXPECT_TRUE(proof.unproven().faces.empty());
  EXPECT_FALSE(proof.unproven().originals.empty());
  EXPECT_LT(proof.originals_tested, covered + covered / 4);  // the others stay covered
  mesh.move(at_border, {0, 0.5, 0});
  proof.reopen(around);
  proof.run({});
  EXPECT_TRUE(proof.unproven().empty());
  const std::uint64_t before = proof.originals_tested;
  proof.reopen({0});
  proof.run({});
  EXPECT_LE(proof.originals_tested, before + 2);  // what was reopened before is covered
}

/// Such coordinates would have larger rounding errors than the proof allows for.
TEST(Proof, RefusesFacesFarAwayAndCoordinatesThatAreNoNumbers) {
  const TriangleMesh original = reference::unit_square(4);
  for (const double x : {1e300, std::nan(""), -HUGE_VAL}) {
    TriangleMesh with_another = original;
    const auto first = static_cast<std::uint32_t>(original.vertices.size());
    for (const Vector3d& p : {Vector3d(x, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 1, 0)})
      with_another.vertices.push_back(p);
    with_another.triangles.push_back({first, first + 1, first + 2});
    const Unproven unproven = prove(original, with_another, 0.01);
    EXPECT_EQ(unproven.originals, std::vector<std::uint32_t>());
    EXPECT_EQ(unproven.faces, std::vector<std::uint32_t>{32});
  }
}

/// Far more faces than a cover has candidates or cuts for.
TEST(Proof, CoversLargeTrianglesByManySmallFaces) {
  const TriangleMesh original = datasets::cube(1, 1), fine = datasets::cube(1, 24);
  EXPECT_TRUE(prove(original, fine, 1e-3).empty());
  TriangleMesh with_hole = fine;
  with_hole.triangles.erase(with_hole.triangles.begin() + 1000);
  EXPECT_EQ(prove(original, with_hole, 1e-3).originals.size(), 1u);
}

/// Each triangle has a hundred candidate faces, of which the proof looks at 64 at most.
TEST(Proof, FindsTheFaceOfATriangleAmongManyThatCrossIt) {
  TriangleMesh fan;
  for (std::uint32_t k = 0; k < 100; ++k) {
    const double angle = 0.01 * k * std::numbers::pi, c = std::cos(angle), s = std::sin(angle);
    for (const Vector3d& p : {Vector3d(-c, -s, -1), Vector3d(c, s, -1), Vector3d(0, 0, 2)}) fan.vertices.push_back(p);
    fan.triangles.push_back({3 * k, 3 * k + 1, 3 * k + 2});
  }
  EXPECT_TRUE(prove(fan, fan, 1e-3).empty());
}

/// A strip of width 1 folded to and fro, so that all of its `folds` lie within a hundredth of each other.
TriangleMesh folded(std::uint32_t folds, std::uint32_t rows) {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i <= folds; ++i)
    for (std::uint32_t j = 0; j <= rows; ++j)
      mesh.vertices.push_back({1.0 * (i % 2), 1.0 * j / rows, 0.01 * i / folds});
  for (std::uint32_t i = 0; i < folds; ++i) {
    for (std::uint32_t j = 0; j < rows; ++j) {
      const std::uint32_t at = i * (rows + 1) + j, beside = at + rows + 1;
      mesh.triangles.insert(mesh.triangles.end(), {{at, beside, beside + 1}, {at, beside + 1, at + 1}});
    }
  }
  return mesh;
}

/// Each original lies within tolerance of thousands of faces, of which those nearest to its parts cover it.
TEST(Proof, ProvesOneOfThousandsOfFolds) { EXPECT_TRUE(prove(folded(1, 5), folded(1001, 4), 0.02).empty()); }

TEST(Proof, KeepsTheTolerancesOfTriangles) {
  const TriangleMesh original = datasets::icosphere(1, 4), mesh = datasets::icosphere(1, 3);
  std::vector<double> limits(original.triangles.size(), HUGE_VAL);
  EXPECT_TRUE(prove(original, mesh, 0.02, limits).empty());
  for (const double limit : {1e-5, 0.0}) {
    limits[7] = limit;
    const Unproven unproven = prove(original, mesh, 0.02, limits);
    EXPECT_TRUE(std::binary_search(unproven.originals.begin(), unproven.originals.end(), 7u));
    EXPECT_LT(unproven.originals.size(), 100u);
    EXPECT_FALSE(unproven.faces.empty());
  }
}

/// A tile has triangles of its neighbours with no originals of theirs: no change alters these, so their old proof
/// holds.
TEST(Proof, AsksNothingOfFacesWhoseVerticesAreAllLocked) {
  const TriangleMesh original{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  TriangleMesh mesh = original;
  mesh.vertices.insert(mesh.vertices.end(), {{2, 0, 5}, {3, 0, 5}, {2, 1, 5}});
  mesh.triangles.push_back({3, 4, 5});
  ASSERT_EQ(prove(original, mesh, 0.1).faces, std::vector<std::uint32_t>{1});
  Approximation it(original, mesh, 0.1);
  it.state.lock({1, 0, 1, 1, 1, 1});
  ProofWorkers workers(it.state, 1);
  Proof proof(it.state, workers);
  proof.run({});
  EXPECT_TRUE(proof.unproven().empty());
  EXPECT_EQ(proof.faces_tested, 1U);
}

/// Workers keep what they have prepared of faces: not beyond the place where these were.
TEST(ProofWorkers, ForgetFacesThatHaveMoved) {
  Approximation it(reference::unit_square(3), reference::unit_square(1), 0.04);
  ProofWorkers workers(it.state, 1);
  const FaceBoxes boxes(it.state.mesh);
  const std::vector<std::uint32_t> originals = numbers_below(it.state.triangles.size());
  const auto move_by = [&](double height) {
    for (std::uint32_t v = 0; v < it.state.mesh.vertex_count(); ++v)
      it.state.mesh.move(v, it.state.mesh.position(v) + Vec3{0, 0, height});
  };
  Proof near(it.state, workers);
  near.run({});
  EXPECT_TRUE(near.unproven().empty());
  std::vector<IdList> covers;
  move_by(0.05);
  EXPECT_FALSE(workers.cover_anywhere(originals, boxes, covers));
  move_by(-0.05);
  EXPECT_TRUE(workers.cover_anywhere(originals, boxes, covers));
  move_by(0.05);
  it.take_faces_as_near();
  Proof far(it.state, workers);
  far.run({});
  EXPECT_EQ(far.unproven().originals, originals);
}

/// Faces that a collapse does not touch, and that are not beside it, still cover the rest of a large original.
TEST(ChangeProver, ProvesACollapseBelowAnOriginalThatReachesFarBeyond) {
  Approximation it(reference::unit_square(1), reference::unit_square(5), 0.04);
  ProofWorkers workers(it.state, 1);
  Proof proof(it.state, workers);
  proof.run({});
  ASSERT_TRUE(proof.unproven().empty());
  proof.commit();
  Split split = whole(it.state);
  Region& region = split.regions.front();
  Proposer proposer(it.state);
  ChangeProver prover(it.state, workers, 0);
  proposer.enter(split, region);
  int made = 0;
  const ArrayMesh& mesh = it.state.mesh;
  for (Corner c = 0; c < 3 * mesh.face_count(); ++c) {
    if (mesh.edge(c) != c || mesh.is_border(mesh.start(c)) || mesh.is_border(mesh.end(c))) continue;
    const std::optional<Vec3> point = proposer.placement(c, 1, std::nullopt);
    if (!point) continue;  // a corner of the original is the sample of a face that is not near it
    proposer.collapse(region, *point);
    ASSERT_TRUE(prover.prove(split, region, proposer.changed_faces())) << "edge " << c;
    undo_last(it.state, region);
    ++made;
  }
  EXPECT_GT(made, 20);
}

/// A sheet of 50 faces whose vertices lie up to 0.65 tolerances above and below a triangle that is 40 tolerances long.
TEST(ForwardCover, FindsCoversThatNeedManyCuts) {
  constexpr double tolerance = 1.0 / 40;
  const std::vector<Vec3> corners = {{0.03, 0.02, 0}, {0.98, 0.04, 0}, {0.05, 0.95, 0}};
  const std::vector<std::array<std::uint32_t, 3>> triangles = {{0, 1, 2}};
  std::mt19937 random(7);
  std::uniform_real_distribution<double> height(-0.65 * tolerance, 0.65 * tolerance);
  for (int round = 0; round < 100; ++round) {
    TriangleMesh sheet = reference::unit_square(5);
    for (Vector3d& p : sheet.vertices) p.z() = height(random);
    std::vector<std::array<Vec3, 3>> faces;
    ForwardCover cover(corners, triangles);
    cover.begin(tolerance);
    for (std::uint32_t f = 0; f < sheet.triangles.size(); ++f) {
      const auto at = [&](std::size_t k) {
        const Vector3d& p = sheet.vertices[sheet.triangles[f][k]];
        return Vec3{p.x(), p.y(), p.z()};
      };
      faces.push_back({at(0), at(1), at(2)});
      cover.add(faces.back(), f);
    }
    const FaceMask used = cover.cover(0, ForwardCover::first(cover.size()));
    ASSERT_NE(used, 0U) << "round " << round;
    for (int i = 0; i <= 40; ++i)
      for (int j = 0; i + j <= 40; ++j) {
        const Vec3 p = (i / 40.0) * corners[0] + (j / 40.0) * corners[1] + ((40 - i - j) / 40.0) * corners[2];
        double min_squared = HUGE_VAL;
        for (std::size_t f = 0; f < faces.size(); ++f)
          if ((used >> f & 1) != 0) min_squared = std::min(min_squared, squared_distance(faces[f], p));
        ASSERT_LE(std::sqrt(min_squared), tolerance * (1 + 2 * CandidateFaces::plane_slack));
      }
  }
}

/// Two faces with a gap between them that is wider than twice the tolerance.
TEST(ForwardCover, NamesThePointThatNoFaceHolds) {
  constexpr double tolerance = 0.1;
  const std::vector<Vec3> corners = {{0, 0.1, 0}, {3, 0.1, 0}, {0.2, 0.6, 0}};
  const std::vector<std::array<std::uint32_t, 3>> triangles = {{0, 1, 2}};
  const std::vector<std::array<Vec3, 3>> faces = {{Vec3{-1, -1, 0}, {1.2, -1, 0}, {1.2, 2, 0}},
                                                  {Vec3{-1, -1, 0}, {1.2, 2, 0}, {-1, 2, 0}},
                                                  {Vec3{1.6, -1, 0}, {4, -1, 0}, {1.6, 4, 0}}};
  ForwardCover cover(corners, triangles);
  cover.begin(tolerance);
  for (std::uint32_t f = 0; f < faces.size(); ++f) cover.add(faces[f], f);
  ASSERT_TRUE(cover.are_corners_near(0, ForwardCover::first(3)));
  ASSERT_EQ(cover.cover(0, ForwardCover::first(3)), 0U);
  ASSERT_TRUE(cover.lost_point());
  const Vec3 lost = *cover.lost_point();
  EXPECT_GT(lost.x, 1.2 + tolerance);
  EXPECT_LT(lost.x, 1.6 - tolerance);
  EXPECT_LT(std::sqrt(squared_distance({corners[0], corners[1], corners[2]}, lost)), 1e-12);
  ASSERT_FALSE(cover.are_corners_near(0, FaceMask{3}));
  EXPECT_EQ(cover.lost_point()->x, 3);
}

}  // namespace prove_test
}  // namespace meshbound
