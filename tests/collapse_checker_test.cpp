// SPDX-License-Identifier: MIT
// The checker admits only what keeps the bound, and is after a refusal what it was before. Every mesh that comes out of
// random admitted collapses is measured by the distance engine.
#include "meshbound/collapse_checker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "datasets/analytic_meshes.h"
#include "meshbound/distance.h"
#include "meshbound/error.h"
#include "meshbound/face_tolerances.h"
#include "reference/small_meshes.h"

namespace meshbound {
namespace collapse_checker_test {

using Eigen::Vector3d;

/// A mesh under collapses beside its checker: the simplest simplifier that can use one.
class CheckedMesh {
 public:
  CheckedMesh(const TriangleMesh& original, double tolerance)
      : checker(original, tolerance), original_(original), mesh_(original), alive_(original.triangles.size(), true) {}

  bool collapse(std::uint32_t u, std::uint32_t v, const Vector3d& to) {
    if (!checker.admits(u, v, to)) return false;
    make(u, v, to);
    return true;
  }
  bool collapse_somewhere(std::uint32_t u, std::uint32_t v, const Vector3d& wanted) {
    const auto to = checker.admitted_placement(u, v, wanted);
    if (to) make(u, v, *to);
    return to.has_value();
  }
  [[nodiscard]] TriangleMesh current() const {
    TriangleMesh result{mesh_.vertices, {}};
    for (std::size_t f = 0; f < alive_.size(); ++f)
      if (alive_[f]) result.triangles.push_back(mesh_.triangles[f]);
    return result;
  }
  [[nodiscard]] Bounds distance() const { return hausdorff_distance(Bvh(original_), Bvh(current())).bounds; }
  [[nodiscard]] const TriangleMesh& mesh() const { return mesh_; }
  [[nodiscard]] bool alive(std::size_t f) const { return alive_[f]; }

  CollapseChecker checker;

 private:
  void make(std::uint32_t u, std::uint32_t v, const Vector3d& to) {
    const std::uint32_t kept = checker.commit();
    ASSERT_TRUE(kept == u || kept == v);
    const std::uint32_t gone = kept == u ? v : u;
    for (std::size_t f = 0; f < alive_.size(); ++f) {
      Triangle& t = mesh_.triangles[f];
      std::replace(t.begin(), t.end(), gone, kept);
      alive_[f] = alive_[f] && std::count(t.begin(), t.end(), kept) < 2;
    }
    mesh_.vertices[kept] = to;
  }

  TriangleMesh original_, mesh_;
  std::vector<bool> alive_;
};

/// Tries `count` collapses of random edges into random points near them; returns how many were admitted.
int random_collapses(CheckedMesh& mesh, std::uint32_t seed, int count, double jitter) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  int admitted = 0;
  for (int i = 0; i < count; ++i) {
    const std::size_t f = random() % mesh.mesh().triangles.size(), k = random() % 3;
    if (!mesh.alive(f)) continue;
    const std::uint32_t u = mesh.mesh().triangles[f][k], v = mesh.mesh().triangles[f][(k + 1) % 3];
    const double s = unit(random) < 0.5 ? 0.0 : unit(random);
    const Vector3d noise = jitter * Vector3d(unit(random) - 0.5, unit(random) - 0.5, unit(random) - 0.5);
    const Vector3d to = (1 - s) * mesh.mesh().vertices[u] + s * mesh.mesh().vertices[v] + (s == 0 ? 0.0 : 1.0) * noise;
    admitted += (i % 3 == 0 ? mesh.collapse_somewhere(u, v, to) : mesh.collapse(u, v, to)) ? 1 : 0;
  }
  return admitted;
}

struct Shape {
  const char* name;
  TriangleMesh mesh;
  double tolerance;
};

std::vector<Shape> shapes() {
  const TriangleMesh sphere = datasets::icosphere(1, 2);
  return {{"sphere", datasets::icosphere(1, 3), 0.05},
          {"open plane with spikes", datasets::spiked_plane(1, 0.2, 16, 4), 0.03},
          {"thin sheet, tolerance above its thickness", datasets::thin_sheet(1, 0.01, 12), 0.02},
          {"open terrain", datasets::terrain(1, 16, 7), 0.02},
          {"two spheres through each other", reference::both(sphere, reference::moved(sphere, {0.5, 0, 0})), 0.1},
          {"a tiny torus far away", reference::moved(datasets::torus(1e-3, 3e-4, 30, 12), {100, -50, 3}), 3e-5},
          {"a huge torus", datasets::torus(1e100, 3e99, 30, 12), 3e98}};
}

TEST(CollapseChecker, KeepsRandomCollapsesWithinTheToleranceBothWays) {
  for (const Shape& shape : shapes()) {
    SCOPED_TRACE(shape.name);
    CheckedMesh mesh(shape.mesh, shape.tolerance);
    const int admitted = random_collapses(mesh, 1, 3000, shape.tolerance);
    EXPECT_GT(admitted, 50);
    EXPECT_LE(mesh.distance().upper, shape.tolerance);
    EXPECT_EQ(mesh.checker.faces(), mesh.current().triangles.size());
    EXPECT_EQ(mesh.checker.counts().performed, static_cast<std::uint64_t>(admitted));
    EXPECT_GT(mesh.checker.counts().refused, 0u);
  }
}

TEST(CollapseChecker, UsesMostOfTheTolerance) {
  CheckedMesh mesh(datasets::icosphere(1, 3), 0.05);
  random_collapses(mesh, 2, 6000, 0.05);
  EXPECT_GT(mesh.distance().lower, 0.7 * 0.05);
}

TEST(CollapseChecker, RefusesAVertexTooFarFromTheOriginal) {
  CheckedMesh mesh(reference::unit_square(4), 0.01);
  for (const Vector3d& far : {Vector3d(0.4, 0.3, 0.011), Vector3d(1e300, 0, 0), Vector3d(std::nan(""), 0, 0)})
    EXPECT_FALSE(mesh.collapse(6, 7, far));
  EXPECT_TRUE(mesh.collapse(6, 7, {0.4, 0.3, 0.009}));
}

/// Flat but for one spike: its removal leaves only faces that lie on the original, and the tip without any near it.
TEST(CollapseChecker, RefusesToForgetASpike) {
  TriangleMesh spike = reference::unit_square(4);
  spike.vertices[12].z() = 0.5;
  CheckedMesh mesh(spike, 0.01);
  EXPECT_FALSE(mesh.collapse(11, 12, spike.vertices[11]));
  EXPECT_TRUE(mesh.collapse(6, 5, spike.vertices[5]) || mesh.collapse(8, 9, spike.vertices[9]));
}

/// Questions without a commit, refused and admitted, leave nothing behind.
TEST(CollapseChecker, IsTheSameAfterAQuestionAsBefore) {
  const TriangleMesh sphere = datasets::icosphere(1, 2);
  CheckedMesh plain(sphere, 0.05), disturbed(sphere, 0.05);
  std::mt19937 random(5);
  int asked = 0;
  for (int i = 0; i < 600; ++i) {
    const std::size_t f = random() % sphere.triangles.size(), g = random() % sphere.triangles.size();
    if (!plain.alive(f) || !plain.alive(g)) continue;
    const Triangle t = plain.mesh().triangles[f], other = plain.mesh().triangles[g];
    const auto middle = [&](const Triangle& c) {
      return Vector3d(0.5 * (plain.mesh().vertices[c[0]] + plain.mesh().vertices[c[1]]));
    };
    EXPECT_FALSE(disturbed.checker.admits(t[0], t[1], 3 * middle(t)));
    asked += disturbed.checker.admits(other[0], other[1], middle(other)) ? 1 : 0;
    EXPECT_EQ(disturbed.checker.faces(), plain.checker.faces());
    ASSERT_EQ(plain.collapse(t[0], t[1], middle(t)), disturbed.collapse(t[0], t[1], middle(t)));
  }
  EXPECT_GT(asked, 50);
  EXPECT_EQ(plain.current().triangles, disturbed.current().triangles);
  EXPECT_LE(disturbed.distance().upper, 0.05);
}

TEST(CollapseChecker, CommitsOnlyWhatItAdmitted) {
  CollapseChecker checker(reference::unit_square(4), 0.01);
  EXPECT_THROW(checker.commit(), Error);
  EXPECT_FALSE(checker.admits(6, 7, {0, 0, 9}));
  EXPECT_THROW(checker.commit(), Error);
  EXPECT_TRUE(checker.admits(6, 7, {0.4, 0.25, 0}));
  EXPECT_FALSE(checker.admits(6, 7, {0, 0, 9}));
  EXPECT_THROW(checker.commit(), Error);
}

/// Coordinates between 0 and 2 lose their last bits on the way to a box around 0.
TEST(CollapseChecker, RoundsNoPointThatItWasGiven) {
  const TriangleMesh sphere = reference::moved(datasets::icosphere(1, 3), {1, 1, 1});
  CollapseChecker checker(sphere, 0.02);
  int near_zero = 0;
  for (const Triangle& t : sphere.triangles) {
    const Vector3d middle = 0.5 * (sphere.vertices[t[0]] + sphere.vertices[t[1]]);
    const auto point = checker.admitted_placement(t[0], t[1], middle);
    if (!point || middle.x() > 0.4) continue;
    EXPECT_EQ(*point, middle);
    ++near_zero;
  }
  EXPECT_GT(near_zero, 50);
}

TEST(CollapseChecker, GivesBackTheWantedPointToTheBitOrAnotherThatHolds) {
  const TriangleMesh far = reference::moved(datasets::icosphere(1, 3), {1000.1, -3.3, 7.7});
  CollapseChecker checker(far, 0.02);
  const Triangle t = far.triangles[100];
  const Vector3d middle = 0.5 * (far.vertices[t[0]] + far.vertices[t[1]]);
  EXPECT_EQ(checker.admitted_placement(t[0], t[1], middle), middle);
  const Vector3d away = middle + Vector3d(0.1, 0.1, 0.1);
  const auto other = checker.admitted_placement(t[0], t[1], away);
  ASSERT_TRUE(other.has_value());
  EXPECT_LT((*other - middle).norm(), 0.1);
  EXPECT_TRUE(checker.admits(t[0], t[1], *other)) << "what it gave is asked for again";
}

/// Every vertex is far above or below its neighbours, so that no edge can be collapsed.
TEST(CollapseChecker, TriesAHopelessEdgeAgainOnlyWhenSomethingHasChanged) {
  TriangleMesh rough = reference::unit_square(8);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> height(-1, 1);
  for (Vector3d& p : rough.vertices) p.z() = height(random);
  CollapseChecker checker(rough, 0.01);
  const auto pass = [&] {
    const std::uint64_t before = checker.counts().refused;
    for (const Triangle& t : rough.triangles)
      EXPECT_FALSE(checker.admitted_placement(t[0], t[1], 0.5 * (rough.vertices[t[0]] + rough.vertices[t[1]])));
    return checker.counts().refused - before;
  };
  EXPECT_GT(pass(), 50u);
  EXPECT_EQ(pass(), 0u);
  EXPECT_GT(checker.counts().repeated, 100u);
  checker.grow_tolerance(0.011);
  EXPECT_GT(pass(), 50u);
}

/// Vertices a few units in the last place apart: a point between them may be rounded to one that is there.
TEST(CollapseChecker, LeavesNoEdgeWithoutALength) {
  const double ulp = 0x1p-32;  // of coordinates between 2^20 and 2^21
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    TriangleMesh bumpy = reference::unit_square(12);
    std::mt19937 random(seed);
    for (Vector3d& p : bumpy.vertices) {
      p = 24 * ulp * p + Vector3d(1.5e6, 1.5e6, 1.5e6);
      p.z() += static_cast<double>(random() % 30) * ulp;
    }
    CheckedMesh mesh(bumpy, 16 * ulp);
    random_collapses(mesh, seed, 600, 40 * ulp);
    const TriangleMesh left = mesh.current();
    for (const Triangle& t : left.triangles)
      for (std::size_t k = 0; k < 3; ++k) EXPECT_NE(left.vertices[t[k]], left.vertices[t[(k + 1) % 3]]);
    EXPECT_LT(left.triangles.size(), bumpy.triangles.size());
    EXPECT_LE(mesh.distance().upper, 16 * ulp);
  }
}

TEST(CollapseChecker, GrowsItsToleranceButNeverShrinksIt) {
  CheckedMesh mesh(reference::unit_square(4), 0.01);
  const Vector3d above(0.4, 0.3, 0.05);
  EXPECT_FALSE(mesh.collapse(6, 7, above));
  EXPECT_THROW(mesh.checker.grow_tolerance(0.005), InvalidInput);
  mesh.checker.grow_tolerance(0.06);
  EXPECT_EQ(mesh.checker.tolerance(), 0.06);
  EXPECT_TRUE(mesh.collapse(6, 7, above));
  EXPECT_LE(mesh.distance().upper, 0.06);
}

TEST(CollapseChecker, AdmitsNothingAtToleranceZero) {
  const TriangleMesh square = reference::unit_square(4);
  CollapseChecker checker(square, 0);
  EXPECT_FALSE(checker.admits(6, 7, square.vertices[6]));
  EXPECT_FALSE(checker.admitted_placement(6, 7, square.vertices[6]).has_value());
}

TEST(CollapseChecker, KeepsLockedVerticesWhereTheyAre) {
  const TriangleMesh square = reference::unit_square(8);
  CheckedMesh mesh(square, 0.2);
  mesh.checker.lock(40);
  EXPECT_TRUE(mesh.checker.is_locked(40));
  EXPECT_THROW(mesh.checker.lock(81), InvalidInput);
  EXPECT_THROW((void)mesh.checker.is_locked(81), InvalidInput);
  EXPECT_FALSE(mesh.checker.admits(40, 41, square.vertices[41]));
  EXPECT_EQ(mesh.checker.admitted_placement(40, 41, square.vertices[41]), square.vertices[40]);
  mesh.checker.lock(49);
  EXPECT_FALSE(mesh.checker.admitted_placement(40, 49, square.vertices[40]).has_value());
  EXPECT_TRUE(mesh.collapse(41, 40, square.vertices[40]));
  EXPECT_TRUE(mesh.checker.is_locked(41)) << "the lock goes with the point";
  EXPECT_THROW(mesh.checker.lock(40), InvalidInput) << "the collapse has removed it";
  EXPECT_THROW((void)mesh.checker.is_locked(40), InvalidInput);
}

TEST(CollapseChecker, KeepsTolerancesOfTriangles) {
  const TriangleMesh sphere = datasets::icosphere(1, 3);
  CheckedMesh mesh(sphere, 0.05);
  EXPECT_THROW(mesh.checker.limit_triangles(std::vector<double>(3, 0.1)), InvalidInput);
  EXPECT_THROW(mesh.checker.limit_triangles(std::vector<double>(sphere.triangles.size(), -1)), InvalidInput);
  std::vector<double> limits;
  for (const Triangle& t : sphere.triangles) limits.push_back(sphere.vertices[t[0]].z() > 0.5 ? 0 : 0.02);
  mesh.checker.limit_triangles(limits);
  EXPECT_GT(random_collapses(mesh, 3, 3000, 0.02), 50);
  EXPECT_EQ(check_face_tolerances(sphere, limits, 0.05, mesh.current()).verdict, Verdict::Within);
  EXPECT_THROW(mesh.checker.limit_triangles(limits), InvalidInput) << "too late";
}

TEST(CollapseChecker, RefusesWhatIsNoManifoldAndTolerancesThatAreNoLengths) {
  const TriangleMesh square = reference::unit_square(1);
  EXPECT_THROW(CollapseChecker(square, -1), InvalidInput);
  EXPECT_THROW(CollapseChecker(square, std::numeric_limits<double>::quiet_NaN()), InvalidInput);
  TriangleMesh twice = square, turned = square, pinched = square;
  twice.triangles.push_back(twice.triangles[0]);
  std::swap(turned.triangles[0][0], turned.triangles[0][1]);
  pinched.vertices.emplace_back(3, 3, 3);
  pinched.vertices.emplace_back(4, 3, 3);
  pinched.triangles.push_back({pinched.triangles[0][0], 4, 5});
  TriangleMesh flat{square.vertices, {{0, 0, 1}}};
  for (const TriangleMesh& wrong : {twice, turned, pinched, flat, TriangleMesh{square.vertices, {{0, 1, 9}}}})
    EXPECT_THROW(CollapseChecker(wrong, 1), InvalidInput);
  try {
    CollapseChecker(twice, 1);
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find("two triangles run along the edge"), std::string::npos);
  }
  CollapseChecker checker(reference::unit_square(4), 0.1);
  EXPECT_THROW((void)checker.admits(0, 12, {0, 0, 0}), InvalidInput) << "no edge";
  EXPECT_THROW((void)checker.admits(0, 99, {0, 0, 0}), InvalidInput);
}

}  // namespace collapse_checker_test
}  // namespace meshbound
