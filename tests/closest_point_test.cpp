// SPDX-License-Identifier: MIT
// closest_point and closest_points: certified against exact arithmetic, and the same answer whatever came before.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "bvh/bvh_data.h"
#include "distance/kernel/point_query.h"
#include "distance/query_order.h"
#include "meshbound/bvh.h"
#include "meshbound/error.h"
#include "numeric/rounding.h"
#include "reference/exact_distance.h"
#include "reference/hard_meshes.h"
#include "reference/point_triangle_cases.h"
#include "reference/small_meshes.h"

namespace meshbound {
namespace closest_point_test {

using Eigen::Vector3d;
using namespace reference;

class RandomChoices : public Choices {
 public:
  explicit RandomChoices(std::uint32_t seed) : random_(seed) {}
  Vector3d point() override { return random_.in_cube(); }
  unsigned below(unsigned n) override { return static_cast<unsigned>(random_.below(static_cast<int>(n))); }

 private:
  Random random_;
};

/// Meshes on which queries tie, search long or round badly.
std::vector<TriangleMesh> hard_meshes() {
  std::vector<TriangleMesh> meshes{icosphere(3),
                                   unit_square(8),
                                   cube(0.5),
                                   random_soup(1, 300, 0.05),
                                   moved(scaled(icosphere(2), 1e-6), {5, 6, 7}),
                                   unwelded(unit_square(6)),
                                   needles(500)};
  for (unsigned shape = 0; shape < hard_shapes; ++shape) {
    RandomChoices choices(shape);
    meshes.push_back(hard_mesh(static_cast<HardShape>(shape), choices, 200));
  }
  return meshes;
}

/// Vertices, points on triangles, next to them, around the model and far from it.
std::vector<Vector3d> queries_around(const TriangleMesh& mesh, int count, std::uint32_t seed) {
  Random random(seed);
  const Bvh bvh(mesh);
  const double size = bvh.bounding_box_diagonal();
  std::vector<Vector3d> queries;
  for (int i = 0; i < count; ++i) {
    const Triangle& t = mesh.triangles[static_cast<std::size_t>(random.below(static_cast<int>(mesh.triangles.size())))];
    const double u = random.uniform(0, 1), v = random.uniform(0, 1 - u);
    const Vector3d a = mesh.vertices[t[0]], b = mesh.vertices[t[1]], c = mesh.vertices[t[2]];
    Vector3d p = random.below(3) == 0 ? a : Vector3d((1 - u - v) * a + u * b + v * c);
    const double away[] = {0, 1e-15, 1e-9, 1e-4, 0.1, 2, 1e5, 1e9};
    p += away[random.below(8)] * size * random.in_cube();
    queries.push_back(p);
  }
  return queries;
}

void expect_same(const ClosestPoint& a, const ClosestPoint& b) {
  EXPECT_EQ(a.point.triangle, b.point.triangle);
  EXPECT_EQ(a.point.position, b.point.position);
  EXPECT_EQ(a.distance.lower, b.distance.lower);
  EXPECT_EQ(a.distance.upper, b.distance.upper);
}

TEST(ClosestPoint, HoldsTheExactDistance) {
  for (const TriangleMesh& mesh : hard_meshes()) {
    const Bvh bvh(mesh);
    for (const Vector3d& query : queries_around(mesh, 60, 7)) {
      const ClosestPoint found = closest_point(bvh, query);
      const ExactLength truth = exact_distance(query, mesh);
      EXPECT_GE(truth.compare(found.distance.lower), 0);
      EXPECT_LE(truth.compare(found.distance.upper), 0);
      const double reach = std::max({query.cwiseAbs().maxCoeff(), found.distance.upper, bvh.bounding_box_diagonal()});
      EXPECT_LE(found.distance.upper - found.distance.lower, 1e-12 * reach);
      EXPECT_LE((found.point.position - query).norm(), found.distance.upper + 1e-12 * reach);
    }
  }
}

TEST(ClosestPoint, HoldsTheExactDistanceOfHardTriangles) {
  for (const CaseFamily& family : case_families()) {
    Random random(11);
    for (int i = 0; i < 300; ++i) {
      const PointTriangleCase hard = family.make(random);
      const auto& [a, b, c] = hard.triangle;
      const ClosestPoint found = closest_point(Bvh(single_triangle(a, b, c)), hard.query);
      const ExactLength truth = exact_distance(hard.query, hard.triangle);
      ASSERT_GE(truth.compare(found.distance.lower), 0) << family.name << ' ' << i;
      ASSERT_LE(truth.compare(found.distance.upper), 0) << family.name << ' ' << i;
    }
  }
}

/// The interval is what roundings make it, 192 u for coordinates of 1, and at most 1/16 more for the fast way.
TEST(ClosestPoint, IsAsNarrowAsRoundingsAllow) {
  const TriangleMesh mesh = scaled(icosphere(4), 0.99);
  const Bvh bvh(mesh);
  for (const Vector3d& query : queries_around(mesh, 2000, 3)) {
    if (query.cwiseAbs().maxCoeff() > 1) continue;
    const ClosestPoint found = closest_point(bvh, query);
    if (found.distance.lower == 0) continue;
    EXPECT_LE(found.distance.upper - found.distance.lower, 2 * 17.0 / 16 * 128 * unit_roundoff + 4 * unit_roundoff);
  }
}

TEST(ClosestPoint, IsTheSameWhateverWasAskedBefore) {
  for (const TriangleMesh& mesh : hard_meshes()) {
    const Bvh bvh(mesh), other(cube(1));
    std::vector<Vector3d> queries = queries_around(mesh, 60, 5);
    std::vector<ClosestPoint> cold;
    for (const Vector3d& query : queries) {
      static_cast<void>(closest_point(other, query));  // forgets where the last answer was
      cold.push_back(closest_point(bvh, query));
    }
    for (std::size_t i = queries.size(); i-- > 0;) expect_same(closest_point(bvh, queries[i]), cold[i]);
  }
}

TEST(ClosestPoint, IsTheSameForEveryHintAndInstructionSet) {
  const std::vector<PointKernel> kernels = point_kernels();
  for (const TriangleMesh& mesh : hard_meshes()) {
    const Bvh bvh(mesh);
    const Bvh::Data& data = bvh.data();
    for (const Vector3d& query : queries_around(mesh, 12, 9)) {
      const Vec3 p = data.frame.to_working({query.x(), query.y(), query.z()});
      const double magnitude = std::max({1.0, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
      const PointRoundings roundings{2 * primal_error * magnitude, 0.25 * dual_error * magnitude};
      const PointDistance cold = point_kernel().one(data, p, roundings, no_slot);
      for (std::uint32_t hint = 0; hint < data.triangle_count(); hint += 7) {
        for (const PointKernel& kernel : kernels) {
          const PointDistance warm = kernel.one(data, p, roundings, hint);
          ASSERT_EQ(warm.nearest.slot, cold.nearest.slot);
          ASSERT_EQ(warm.nearest.squared, cold.nearest.squared);
          ASSERT_EQ(warm.separated, cold.separated);
          ASSERT_TRUE(warm.offset.x == cold.offset.x && warm.offset.y == cold.offset.y &&
                      warm.offset.z == cold.offset.z);
        }
      }
    }
  }
}

/// With no slack allowed, the slow way is taken wherever the plane across an offset does not prove the distance to the
/// last bit. It then proves what `certified_distance` proves by asking every triangle for its best plane.
TEST(ClosestPoint, ProvesNoMoreThanThePlanesOfEachTriangle) {
  for (const TriangleMesh& mesh : hard_meshes()) {
    const Bvh bvh(mesh);
    const Bvh::Data& data = bvh.data();
    for (const Vector3d& query : queries_around(mesh, 60, 17)) {
      const Vec3 p = data.frame.to_working({query.x(), query.y(), query.z()});
      const double magnitude = std::max({1.0, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
      const PointDistance found = point_kernel().one(data, p, {2 * primal_error * magnitude, 0}, no_slot);
      QueryCounters counters;
      const double proven = certified_distance(data, p, found.nearest.squared, counters);
      EXPECT_NEAR(found.separated, proven, 8 * unit_roundoff * magnitude);
    }
  }
}

/// The last block of a tree repeats its last triangle where it has fewer than four.
TEST(ClosestPoint, IsNeverBeyondTheLastTriangle) {
  for (int count = 9; count <= 40; ++count) {
    const TriangleMesh mesh = random_soup(static_cast<std::uint32_t>(count), count, 0.1);
    const Bvh bvh(mesh);
    const Bvh::Data& data = bvh.data();
    const std::uint32_t last = data.triangle_count() - 1;
    const Vec3 corner = data.vertices[data.corners[last][1]];
    for (const PointKernel& kernel : point_kernels()) {
      for (std::uint32_t hint = 0; hint <= last; ++hint) {
        const PointDistance found = kernel.one(data, corner, {2 * primal_error, 0.25 * dual_error}, hint);
        EXPECT_EQ(found.nearest.slot, last);
        EXPECT_LE(found.nearest.squared, 1e-30);
      }
    }
  }
}

/// All boxes are equally near: more of them than the walk by levels holds.
TEST(ClosestPoint, OfCopiesIsTheFirstAlongTheCurve) {
  const TriangleMesh one = single_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  TriangleMesh copies = one;
  for (int i = 0; i < 3000; ++i) copies.triangles.push_back({0, 1, 2});
  const Bvh bvh(copies), single(one);
  for (const Vector3d& query : {Vector3d(0.2, 0.2, 0.5), Vector3d(0.2, 0.2, 0), Vector3d(3, 4, 5)}) {
    const ClosestPoint found = closest_point(bvh, query), alone = closest_point(single, query);
    EXPECT_EQ(found.point.triangle, bvh.data().triangle_of_slot[0]);
    EXPECT_EQ(found.point.position, alone.point.position);
    EXPECT_EQ(found.distance.lower, alone.distance.lower);
    EXPECT_EQ(found.distance.upper, alone.distance.upper);
  }
}

TEST(ClosestPoints, AreAskedAlongACurveWhereTheyDoNotFollowOneAnother) {
  std::vector<Vector3d> queries;
  for (int i = 0; i < 4096; ++i) queries.emplace_back(i % 64, i / 64, 0);
  EXPECT_TRUE(order_of_queries(queries).empty());
  Random random(1);
  for (std::size_t i = queries.size() - 1; i > 0; --i)
    std::swap(queries[i], queries[static_cast<std::size_t>(random.below(static_cast<int>(i)))]);

  std::vector<std::uint32_t> order = order_of_queries(queries);
  ASSERT_EQ(order.size(), queries.size());
  double length = 0;
  for (std::size_t i = 1; i < order.size(); ++i) length += (queries[order[i]] - queries[order[i - 1]]).norm();
  EXPECT_LT(length, 2.0 * static_cast<double>(order.size()));  // at random 33 times as many
  std::sort(order.begin(), order.end());
  for (std::uint32_t i = 0; i < order.size(); ++i) ASSERT_EQ(order[i], i);
}

/// The search refuses them; the order comes first.
TEST(ClosestPoints, RefuseOneThatIsNotFiniteAmongMany) {
  const Bvh bvh(icosphere(2));
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL, 1.7e308}) {
    std::vector<Vector3d> queries = queries_around(icosphere(2), 1000, 3);
    queries[700].y() = bad;
    EXPECT_THROW((void)closest_points(bvh, queries), InvalidInput);
  }
}

TEST(ClosestPoints, AreThoseAskedOneByOneForAnyNumberOfThreads) {
  for (const TriangleMesh& mesh : {icosphere(3), random_soup(4, 2000, 0.1)}) {
    const Bvh bvh(mesh);
    const std::vector<Vector3d> queries = queries_around(mesh, 5000, 13);
    std::vector<ClosestPoint> expected;
    for (const Vector3d& query : queries) expected.push_back(closest_point(bvh, query));
    for (const int threads : {0, 1, 2, 7}) {
      const std::vector<ClosestPoint> found = closest_points(bvh, queries, {.threads = threads});
      ASSERT_EQ(found.size(), queries.size());
      for (std::size_t i = 0; i < found.size(); ++i) expect_same(found[i], expected[i]);
    }
  }
}

/// The query at the end would be refused, so `Stopped` shows that the ones before it were not answered.
TEST(ClosestPoints, EndWhenTheyAreToldBeforeTheirQueriesAreAnswered) {
  const Bvh bvh(icosphere(2));
  std::vector<Vector3d> queries = queries_around(icosphere(2), 1000, 3);
  queries.back().x() = std::nan("");
  const std::atomic<bool> told = true;
  for (const int threads : {1, 4})
    EXPECT_THROW((void)closest_points(bvh, queries, {.threads = threads, .stop = {.cancel = &told}}), Stopped);
  EXPECT_THROW((void)closest_points(bvh, queries, {.stop = {.deadline = StopToken::Clock::now()}}), Stopped);
}

/// Points around points of the mesh or beside it, at most `spread` of its size apart from each other in each
/// coordinate.
std::vector<Vector3d> neighbours(const TriangleMesh& mesh, std::size_t count, double spread, std::uint32_t seed) {
  const double size = Bvh(mesh).bounding_box_diagonal();
  const Vector3d middle = queries_around(mesh, 1, seed)[0];
  Random random(seed);
  std::vector<Vector3d> points;
  for (std::size_t i = 0; i < count; ++i) points.emplace_back(middle + spread * size * random.in_cube());
  return points;
}

void expect_same_bits(const PointDistance& a, const PointDistance& b) {
  EXPECT_EQ(a.nearest.slot, b.nearest.slot);
  EXPECT_EQ(a.nearest.squared, b.nearest.squared);
  EXPECT_EQ(a.separated, b.separated);
  EXPECT_TRUE(a.offset.x == b.offset.x && a.offset.y == b.offset.y && a.offset.z == b.offset.z);
}

/// A query in the working frame. `loss`: see `PointRoundings::allowed`, in units of `dual_error`.
GroupQuery placed(const Bvh::Data& data, const Vector3d& query, double loss) {
  const Vec3 p = data.frame.to_working({query.x(), query.y(), query.z()});
  const double magnitude = std::max({1.0, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
  return {p, {2 * primal_error * magnitude, loss * dual_error * magnitude}};
}

/// Groups of every size, from equal points to ones as far apart as the mesh is large, for every instruction set; with
/// no loss allowed, where planes mostly fail to prove the distance, too.
TEST(ClosestPoints, OfAGroupHaveTheBitsOfEachByItself) {
  std::vector<TriangleMesh> meshes = hard_meshes();
  meshes.push_back(icosphere(5));
  const std::vector<PointKernel> kernels = point_kernels();
  std::size_t answered = 0, asked = 0;
  for (const TriangleMesh& mesh : meshes) {
    const Bvh bvh(mesh);
    const Bvh::Data& data = bvh.data();
    std::uint32_t seed = 0;
    for (const double spread : {0.0, 1e-12, 1e-6, 1e-3, 0.02, 0.5}) {
      for (std::size_t size = 1; size <= max_group_width; ++size) {
        std::vector<GroupQuery> queries;
        for (const Vector3d& query : neighbours(mesh, size, spread, ++seed))
          queries.push_back(placed(data, query, size % 2 == 0 ? 0 : 0.25));
        if (!(std::fabs(queries[0].point.x) < 0x1p10)) continue;
        const std::uint32_t hint = size % 5 == 0 ? no_slot : seed % data.triangle_count();
        for (const PointKernel& kernel : kernels) {
          if (size > kernel.group_width) continue;
          std::vector<PointDistance> found(size);
          ++asked;
          if (!kernel.group(data, queries, hint, found)) continue;
          ++answered;
          for (std::size_t i = 0; i < size; ++i)
            expect_same_bits(found[i], kernel.one(data, queries[i].point, queries[i].roundings, no_slot));
        }
      }
    }
  }
  EXPECT_GT(2 * answered, asked);
}

/// The bounds of groups hold the exact distance, whatever `closest_point` says.
TEST(ClosestPoints, HoldTheExactDistance) {
  for (const TriangleMesh& mesh : hard_meshes()) {
    const Bvh bvh(mesh);
    for (const double spread : {0.0, 1e-6, 0.02}) {
      const std::vector<Vector3d> queries = neighbours(mesh, 17, spread, 21);
      const std::vector<ClosestPoint> found = closest_points(bvh, queries);
      for (std::size_t i = 0; i < queries.size(); ++i) {
        const ExactLength truth = exact_distance(queries[i], mesh);
        EXPECT_GE(truth.compare(found[i].distance.lower), 0);
        EXPECT_LE(truth.compare(found[i].distance.upper), 0);
      }
    }
  }
}

TEST(ClosestPoints, AreThoseAskedOneByOneForAnyNumberOfNeighbours) {
  std::vector<TriangleMesh> meshes = hard_meshes();
  meshes.push_back(icosphere(5));
  for (const TriangleMesh& mesh : meshes) {
    const Bvh bvh(mesh);
    for (std::size_t size = 1; size <= 2 * max_group_width + 1; ++size) {
      std::vector<Vector3d> queries;
      for (const double spread : {0.0, 1e-4, 0.01, 2.0})
        for (const Vector3d& query : neighbours(mesh, size, spread, static_cast<std::uint32_t>(size)))
          queries.push_back(query);
      const std::vector<ClosestPoint> found = closest_points(bvh, queries);
      for (std::size_t i = 0; i < found.size(); ++i) expect_same(found[i], closest_point(bvh, queries[i]));
    }
  }
}

/// The first queries are so far away that the mesh is a point beside their distances: they leave no hint.
TEST(ClosestPoints, OfFarAndNearQueriesAreThoseAskedOneByOne) {
  const Bvh bvh(icosphere(3));
  std::vector<Vector3d> queries(5, Vector3d(1e15, 2e15, 3e15));
  for (int i = 0; i < 20; ++i) queries.emplace_back(1.1, 0.01 * i, i % 10 == 9 ? 1e15 : 0.0);
  const std::vector<ClosestPoint> found = closest_points(bvh, queries);
  for (std::size_t i = 0; i < found.size(); ++i) expect_same(found[i], closest_point(bvh, queries[i]));
}

TEST(ClosestPoints, OfNoneAreNone) { EXPECT_TRUE(closest_points(Bvh(cube(1)), {}).empty()); }

TEST(ClosestPoints, RefuseWhatOneQueryIsRefusedFor) {
  const Bvh bvh(cube(1));
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e302}) {
    std::vector<Vector3d> queries(3000, Vector3d(1, 2, 3));
    queries[2500].y() = bad;
    EXPECT_THROW(static_cast<void>(closest_point(bvh, queries[2500])), InvalidInput);
    EXPECT_THROW(static_cast<void>(closest_points(bvh, queries)), InvalidInput);
  }
}

}  // namespace closest_point_test
}  // namespace meshbound
