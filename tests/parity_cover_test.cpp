// SPDX-License-Identifier: MIT
// Large triangles that many triangles of a tree cover together: no point of them is further away than is said, whatever
// the tree is of.
#include "distance/kernel/parity_cover.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <random>

#include "datasets/analytic_meshes.h"
#include "distance/kernel/search_kernel.h"
#include "meshbound/bvh.h"
#include "meshbound/distance.h"
#include "reference/hard_meshes.h"
#include "reference/small_meshes.h"

namespace meshbound {
namespace parity_cover_test {

using Eigen::Vector3d;
using reference::moved;
using reference::unit_square;

/// A tree, with covers and closest points in its working frame.
class Target {
 public:
  explicit Target(const TriangleMesh& mesh) : tree(mesh) { look_at_tree(); }

  void refit(const TriangleMesh& mesh) {
    tree.refit(mesh);
    look_at_tree();
  }

  [[nodiscard]] Vec3 in_frame(const Vector3d& p) const { return tree.data().frame.to_working({p.x(), p.y(), p.z()}); }
  [[nodiscard]] double in_frame(double length) const { return std::ldexp(length, -tree.data().frame.exponent); }
  [[nodiscard]] Nearest nearest(const Vec3& p) const { return kernel_->nearest(p, 0, 0); }

  /// Bounds a triangle, beginning at what is nearest to its centroid.
  std::optional<double> distance(const TriangleCorners& triangle, double limit) {
    cover->begin();
    const auto found = cover->distance(triangle, limit, nearest(centroid(triangle)).slot);
    return found;
  }
  /// In model units, of which the frame's differ by a power of two.
  std::optional<double> distance(const Vector3d& a, const Vector3d& b, const Vector3d& c, double limit) {
    const auto found = distance({in_frame(a), in_frame(b), in_frame(c)}, in_frame(limit));
    return found ? std::optional(std::ldexp(*found, tree.data().frame.exponent)) : std::nullopt;
  }
  [[nodiscard]] bool is_over(std::uint32_t slot, const Vec3& p) const {
    const auto spaces = cover->half_spaces_over(slot);
    return std::all_of(spaces.begin(), spaces.end(),
                       [&](const HalfSpace& space) { return dot(space.normal, p) <= space.offset; });
  }
  [[nodiscard]] bool is_over_too_high(const Vec3& p) const {
    const auto slots = cover->too_high();
    return std::any_of(slots.begin(), slots.end(), [&](std::uint32_t slot) { return is_over(slot, p); });
  }

  Bvh tree;
  std::optional<ParityCover> cover;

 private:
  void look_at_tree() {
    Goal goal;
    set_slack(goal, 1, 0);
    kernel_ = make_search_kernel(tree.data(), goal);
    cover.emplace(tree.data(), 1);
  }

  std::unique_ptr<SearchKernel> kernel_;
};

class Random : public reference::Choices {
 public:
  explicit Random(std::uint32_t seed) : engine_(seed) {}
  double between(double low, double high) { return std::uniform_real_distribution(low, high)(engine_); }
  Vector3d point() override { return {between(-1, 1), between(-1, 1), between(-1, 1)}; }
  unsigned below(unsigned n) override { return static_cast<unsigned>(engine_() % n); }

 private:
  std::mt19937 engine_;
};

/// A point of a triangle, often on its border.
Vec3 point_of(const TriangleCorners& t, Random& random) {
  double v = random.between(0, 1), w = random.between(0, 1);
  if (v + w > 1) v = 1 - v, w = 1 - w;
  if (random.below(4) == 0) v = 0;
  if (random.below(4) == 0) w = 0;
  return t[0] + v * (t[1] - t[0]) + w * (t[2] - t[0]);
}

struct Rough {
  const char* name;
  TriangleMesh mesh;
};

std::vector<Rough> rough_meshes() {
  Random random(1);
  const TriangleMesh terrain = datasets::terrain(1, 24, 7), spikes = datasets::spiked_plane(1, 0.2, 24, 5);
  TriangleMesh torn = terrain;
  std::erase_if(torn.triangles, [&](const Triangle&) { return random.below(40) == 0; });
  TriangleMesh flipped = terrain;
  for (Triangle& t : flipped.triangles)
    if (random.below(2) == 0) std::swap(t[0], t[1]);
  return {{"terrain", terrain},
          {"plane with spikes", spikes},
          {"thin sheet", datasets::thin_sheet(1, 0.03, 16)},
          {"sphere", datasets::icosphere(0.5, 4)},
          {"spheres through each other",
           reference::both(datasets::icosphere(0.5, 3), moved(datasets::icosphere(0.5, 3), {0.3, 0, 0}))},
          {"terrain with seams", reference::with_seams(terrain, random)},
          {"terrain without a shared vertex", reference::unwelded(terrain)},
          {"terrain with missing triangles", torn},
          {"terrain of mixed orientation", flipped},
          {"terrain twice", reference::both(terrain, terrain)},
          {"spikes on terrain", reference::both(terrain, moved(spikes, {0, 0, 0.01}))}};
}

/// A triangle with its corners near points of the mesh.
TriangleCorners triangle_near(const Target& target, double reach, Random& random) {
  const Bvh::Data& data = target.tree.data();
  TriangleCorners corners;
  for (Vec3& corner : corners) {
    const Vec3& v = data.vertices[random.below(256) * data.vertices.size() / 256];
    const Vector3d away = reach * random.point();
    corner = v + Vec3{away.x(), away.y(), away.z()};
  }
  return corners;
}

/// 8 x 8 squares of the unit square lie on one of its halves. Within a limit of half a square a proof is worth it;
/// within one of ten squares a walk is, as it is on a triangle that few lie on.
TEST(ParityCover, IsTriedWhereItCostsLessThanAWalk) {
  const Target target(unit_square(8));
  const auto corner = [&](double x, double y) { return target.in_frame(Vector3d(x, y, 0)); };
  const TriangleCorners large = {corner(0, 0), corner(1, 0), corner(1, 1)},
                        small = {corner(0, 0), corner(0.25, 0), corner(0.25, 0.25)};
  EXPECT_TRUE(target.cover->spans_many(large, target.in_frame(0.5 / 8), 0));
  EXPECT_FALSE(target.cover->spans_many(large, target.in_frame(10.0 / 8), 0));
  EXPECT_FALSE(target.cover->spans_many(small, target.in_frame(0.5 / 8), 0));
}

TEST(ParityCover, NeverSaysLessThanTheDistanceOfAPoint) {
  std::size_t proven = 0, with_too_high = 0;
  for (const Rough& rough : rough_meshes()) {
    SCOPED_TRACE(rough.name);
    Target target(rough.mesh);
    Random random(2);
    for (int i = 0; i < 1500; ++i) {
      const double limit = std::pow(10, random.between(-2, -0.7));
      const TriangleCorners triangle = triangle_near(target, 0.5 * limit, random);
      const std::optional<double> found = target.distance(triangle, limit);
      if (!found) continue;
      ++proven;
      if (!target.cover->too_high().empty()) ++with_too_high;
      ASSERT_LE(*found, limit);
      for (int k = 0; k < 100; ++k) {
        const Vec3 p = point_of(triangle, random);
        if (target.is_over_too_high(p)) continue;
        ASSERT_LE(std::sqrt(target.nearest(p).squared), *found + 1e-14);
      }
    }
  }
  EXPECT_GT(proven, 1000u);
  EXPECT_GT(with_too_high, 100u);
}

TEST(ParityCover, IntervalsOfTheEngineHoldTheDistancesOfPoints) {
  for (const Rough& rough : rough_meshes()) {
    SCOPED_TRACE(rough.name);
    Target target(rough.mesh);
    Random random(3);
    for (int i = 0; i < 100; ++i) {
      const TriangleCorners triangle = triangle_near(target, 0.05, random);
      TriangleMesh a;
      for (const Vec3& corner : triangle) {
        const Vec3 p = target.tree.data().frame.to_model(corner);
        a.vertices.emplace_back(p.x, p.y, p.z);
      }
      a.triangles = {{0, 1, 2}};
      DistanceOptions options;
      options.error_bound = std::pow(10, random.between(-6, -1));
      const Bounds bounds = one_sided_hausdorff_distance(Bvh(a), target.tree, options).bounds;
      EXPECT_LE(bounds.upper - bounds.lower, *options.error_bound);
      for (int k = 0; k < 200; ++k) {
        const double distance = std::sqrt(target.nearest(point_of(triangle, random)).squared);
        ASSERT_LE(distance, target.in_frame(bounds.upper) + 1e-14);
      }
    }
  }
}

TEST(ParityCover, OfAParallelPlaneIsTheHeight) {
  Target target(unit_square(16));
  const auto found = target.distance({0.1, 0.1, 0.1}, {0.9, 0.15, 0.1}, {0.4, 0.8, 0.1}, 0.2);
  ASSERT_TRUE(found);
  EXPECT_GE(*found, 0.1);
  EXPECT_LE(*found, 0.1 + 0.0003);  // a thousandth of the limit is given away at the border
  EXPECT_TRUE(target.cover->too_high().empty());
  EXPECT_FALSE(target.distance({0.1, 0.1, 0.1}, {0.9, 0.15, 0.1}, {0.4, 0.8, 0.1}, 0.1));
}

TEST(ParityCover, CountsWhatReachesBeyondTheBorderByALittle) {
  Target target(unit_square(16));
  const auto found = target.distance({-0.0001, 0.5, 0}, {0.9, 0.1, 0}, {0.9, 0.9, 0}, 0.2);
  ASSERT_TRUE(found);
  EXPECT_GE(*found, 0.0001);
}

/// A square with one vertex far below it, looked at from a little above.
class Tip : public testing::Test {
 protected:
  Tip() : target_(with_tip(unit_square(16))) {
    found_ = target_.distance({0.1, 0.1, 0.01}, {0.9, 0.12, 0.01}, {0.4, 0.8, 0.01}, 0.02);
  }
  [[nodiscard]] bool is_over_too_high(double x, double y) const {
    return target_.is_over_too_high(target_.in_frame(Vector3d(x, y, 0.01)));
  }

  Target target_;
  std::optional<double> found_;

 private:
  static TriangleMesh with_tip(TriangleMesh mesh) {
    std::find(mesh.vertices.begin(), mesh.vertices.end(), Vector3d(0.5, 0.25, 0))->z() = -0.5;
    return mesh;
  }
};
using ParityCoverOfATip = Tip;

TEST_F(ParityCoverOfATip, LeavesOutWhatIsOverIt) {
  ASSERT_TRUE(found_);
  EXPECT_EQ(target_.cover->too_high().size(), 6u);
  for (const std::uint32_t slot : target_.cover->too_high())
    EXPECT_TRUE(target_.is_over(slot, target_.in_frame(Vector3d(0.5, 0.25, 0.01))));
  EXPECT_TRUE(is_over_too_high(0.55, 0.26));
  EXPECT_FALSE(is_over_too_high(0.6, 0.25));
}

TEST_F(ParityCoverOfATip, LeavesOutAThousandthOfTheLimitAroundIt) {
  ASSERT_TRUE(found_);
  EXPECT_TRUE(is_over_too_high(0.5625 + 0.00003, 0.25));
  EXPECT_FALSE(is_over_too_high(0.5625 + 0.0001, 0.25));
}

TEST_F(ParityCoverOfATip, LeavesOutNothingBesideItsTriangles) {
  ASSERT_TRUE(found_);
  const Bvh::Data& data = target_.tree.data();
  Random random(4);
  for (const std::uint32_t slot : target_.cover->too_high()) {
    std::array<Vec3, 3> seen;
    for (std::size_t k = 0; k < 3; ++k) seen[k] = data.vertices[data.corners[slot][k]], seen[k].z = 0;
    for (int i = 0; i < 100; ++i) {
      const double v = random.between(-1, 1.5), w = random.between(-1, 1.5), least = std::min({v, w, 1 - v - w});
      if (std::abs(least) < 0.02) continue;
      const Vec3 p = seen[0] + v * (seen[1] - seen[0]) + w * (seen[2] - seen[0]);
      EXPECT_EQ(target_.is_over(slot, p), least > 0);
    }
  }
}

TEST(ParityCover, NeedsHalvesWhereTheSurfaceEnds) {
  Target target(unit_square(16));
  EXPECT_FALSE(target.distance({0.1, 0.1, 0.01}, {1.1, 0.15, 0.01}, {0.4, 0.8, 0.01}, 0.02));
  EXPECT_TRUE(target.cover->is_worth_halving());
  EXPECT_FALSE(target.distance({0.1, 0.1, 0.3}, {0.9, 0.15, 0.3}, {0.4, 0.8, 0.3}, 0.2)) << "all is too high";
  EXPECT_FALSE(target.cover->is_worth_halving());
}

/// Two halves of a square that meet in vertices of their own.
TriangleMesh square_with_seam() {
  const TriangleMesh square = unit_square(16);
  TriangleMesh halves;
  for (const bool right : {false, true}) {
    const auto first = static_cast<std::uint32_t>(halves.vertices.size());
    halves.vertices.insert(halves.vertices.end(), square.vertices.begin(), square.vertices.end());
    for (const Triangle& t : square.triangles) {
      const double x = (square.vertices[t[0]] + square.vertices[t[1]] + square.vertices[t[2]]).x() / 3;
      if ((x > 0.5) == right) halves.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
  }
  return halves;
}

/// The tree goes on to call the two sides neighbours.
TEST(ParityCover, SeesASeamThatOpensAsItsTreeIsRefitted) {
  TriangleMesh mesh = square_with_seam();
  Target target(mesh);
  const Vector3d a(0.1, 0.1, 0.01), b(0.9, 0.15, 0.01), c(0.4, 0.8, 0.01);
  EXPECT_TRUE(target.distance(a, b, c, 0.05));
  for (std::size_t v = mesh.vertices.size() / 2; v < mesh.vertices.size(); ++v) mesh.vertices[v].x() += 0.3;
  target.refit(mesh);
  EXPECT_FALSE(target.distance(a, b, c, 0.05));
}

/// All three lie on one side of the edge: an odd number over one part of T, and none over the other.
TEST(ParityCover, TakesAnEdgeOfThreeTrianglesForABorder) {
  TriangleMesh mesh;
  mesh.vertices = {{0, -10, 0}, {0, 10, 0}, {10, 0, 0}, {10, 0, 0.01}, {10, 0, 0.02}};
  mesh.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}};
  Target target(mesh);
  EXPECT_TRUE(target.distance({0.1, 0, 0.01}, {1, -1, 0.01}, {1, 1, 0.01}, 0.05));
  EXPECT_FALSE(target.distance({-0.3, 0, 0.01}, {1, -1, 0.01}, {1, 1, 0.01}, 0.05));
  EXPECT_EQ(target.cover->too_high().size(), 0u);
}

/// Two triangles without area at every second vertex of the border, which share the edge from there to itself.
TEST(ParityCover, TakesTrianglesThatHaveAnEdgeTwiceForBorders) {
  TriangleMesh mesh = unit_square(16);
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]).x() > 1.5;
  });
  const auto at_border = [&](int i) {
    const auto found = std::find(mesh.vertices.begin(), mesh.vertices.end(), Vector3d(0.5, i / 16.0, 0));
    return static_cast<std::uint32_t>(found - mesh.vertices.begin());
  };
  for (int i = 1; i < 16; i += 2)
    for (const int next : {i - 1, i + 1}) mesh.triangles.push_back({at_border(i), at_border(next), at_border(i)});
  Target target(mesh);
  EXPECT_TRUE(target.distance({0.1, 0.1, 0.01}, {0.45, 0.1, 0.01}, {0.1, 0.9, 0.01}, 0.05));
  EXPECT_FALSE(target.distance({0.1, 0.1, 0.01}, {0.7, 0.15, 0.01}, {0.1, 0.9, 0.01}, 0.05));
}

/// h(A, B) of a square of two triangles beside one of 8,192; returns the pieces that it took.
std::uint64_t pieces_of_square_moved_by(const Vector3d& by) {
  DistanceOptions options;
  options.error_bound = 1e-4;
  const Bvh square(moved(unit_square(1), by)), fine(unit_square(64));
  const OneSidedDistance found = one_sided_hausdorff_distance(square, fine, options);
  EXPECT_LE(found.bounds.lower, by.norm());
  EXPECT_GE(found.bounds.upper, by.norm());
  EXPECT_LE(found.bounds.upper - found.bounds.lower, 1e-4);
  return found.stats.pieces;
}

TEST(ParityCover, SparesAWalkMostOfItsPieces) {
  EXPECT_LT(pieces_of_square_moved_by({0, 0, 0.01}), 8192u / 32);
  EXPECT_LT(pieces_of_square_moved_by({0.003, 0.004, 0.01}), 8192u) << "where it reaches beyond the border";
}

}  // namespace parity_cover_test
}  // namespace meshbound
