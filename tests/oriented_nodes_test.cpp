// SPDX-License-Identifier: MIT
// Boxes that lie along what they hold: they hold it, exactly, and spare queries the needles that are not near.
#include "bvh/oriented_nodes.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <thread>
#include <vector>

#include "bvh/build.h"
#include "bvh/nearest.h"
#include "datasets/analytic_meshes.h"
#include "geometry/eigen_vec3.h"
#include "meshbound/bvh.h"
#include "reference/exact_distance.h"
#include "reference/point_triangle_cases.h"
#include "reference/small_meshes.h"

namespace oriented_nodes_test {

using namespace meshbound;
using namespace meshbound::reference;

/// A winding strip of needles, askew and ten times as long as wide: few of their boxes meet a line through the mesh.
TriangleMesh ribbon(std::uint32_t steps) {
  TriangleMesh mesh;
  const Eigen::Quaterniond turn = Eigen::Quaterniond(4, 1, 2, 3).normalized();
  for (std::uint32_t i = 0; i <= steps; ++i) {
    const double share = static_cast<double>(i) / steps;
    for (const double across : {0.0, 0.5})
      mesh.vertices.push_back(turn * Eigen::Vector3d(10 * share, across, 0.3 * std::sin(20 * share)));
    const std::uint32_t at = 2 * i;
    if (i < steps) mesh.triangles.insert(mesh.triangles.end(), {{at, at + 2, at + 3}, {at, at + 3, at + 1}});
  }
  return mesh;
}

/// Meshes of many needles, whose trees have oriented nodes.
std::vector<TriangleMesh> meshes_of_needles() {
  TriangleMesh rough = needles(400), tilted = fan(3000);
  Random random(3);
  for (Eigen::Vector3d& p : rough.vertices) p += 0.01 * random.in_cube();
  for (Eigen::Vector3d& p : tilted.vertices) p = Eigen::Quaterniond(4, 1, 3, 2).normalized() * p;
  return {needles(400),
          rough,
          tilted,
          ribbon(4000),
          moved(scaled(needles(400), 1e-6), {1, 2, 3}),
          scaled(needles(500), 1e200)};
}

/// Coordinate `axis` of a point in the frame of a node, exactly.
mpq_class exact_coordinate(const OrientedNode& node, std::size_t axis, const Vec3& p) {
  const auto product = [](double a, double q, double c) -> mpq_class { return mpq_class(a) * (mpq_class(q) - c); };
  return product(node.axes[axis].x, p.x, node.centre.x) + product(node.axes[axis].y, p.y, node.centre.y) +
         product(node.axes[axis].z, p.z, node.centre.z);
}

TEST(OrientedNodes, HoldTheTrianglesBelowThem) {
  for (const TriangleMesh& mesh : meshes_of_needles()) {
    const Bvh bvh(mesh);
    const Bvh::Data& data = bvh.data();
    const std::vector<OrientedNode>& nodes = oriented_nodes(data);
    ASSERT_EQ(nodes.size(), data.nodes.size());
    for (std::uint32_t level = 1; level < data.levels(); ++level) {
      for (std::uint32_t i = 0; i < data.level_begin[level + 1] - data.level_begin[level]; ++i) {
        const OrientedNode& node = nodes[data.level_begin[level] + i];
        for (std::uint32_t k = 0; k < node_width; ++k) {
          const auto [begin, end] = slots_below(data, level - 1, i * node_width + k);
          EXPECT_EQ(begin == end, node.children.lo[0][k] > node.children.hi[0][k]);
          for (std::uint32_t slot = begin; slot < end; ++slot) {
            for (const std::uint32_t v : data.corners[slot]) {
              for (std::size_t axis = 0; axis < 3; ++axis) {
                const mpq_class at = exact_coordinate(node, axis, data.vertices[v]);
                ASSERT_LE(mpq_class(node.children.lo[axis][k]), at) << "level " << level << " node " << i;
                ASSERT_GE(mpq_class(node.children.hi[axis][k]), at) << "level " << level << " node " << i;
              }
            }
          }
        }
      }
    }
  }
}

TEST(OrientedNodes, HaveRotationsAsFrames) {
  for (const TriangleMesh& mesh : meshes_of_needles()) {
    const Bvh bvh(mesh);
    for (const OrientedNode& node : oriented_nodes(bvh.data())) {
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = i; j < 3; ++j) EXPECT_NEAR(dot(node.axes[i], node.axes[j]), i == j ? 1 : 0, 0x1p-42);
    }
  }
}

/// Tested against the distance to the triangles below, at points on them, next to them and as far as queries may be.
TEST(OrientedNodes, BoundDistancesFromBelow) {
  for (const TriangleMesh& mesh : meshes_of_needles()) {
    const Bvh bvh(mesh);
    const Bvh::Data& data = bvh.data();
    const std::vector<OrientedNode>& nodes = oriented_nodes(data);
    Random random(5);
    for (std::uint32_t i = 0; i < data.level_begin[2]; i += 7) {
      const double away[] = {0, 1e-12, 1e-6, 0.01, 1, 500};
      const Vec3 corner = data.vertices[data.corners[i * block_width * node_width][1]];
      const Vec3 p = corner + away[i / 7 % 6] * to_vec3(random.in_cube());
      const Float8 squared = OrientedQuery(data, nodes, p).to_boxes(data.nodes[i]).squared;
      for (std::uint32_t k = 0; k < node_width; ++k) {
        const auto [begin, end] = slots_below(data, 0, i * node_width + k);
        for (std::uint32_t slot = begin; slot < end; ++slot) {
          const Triangle& t = data.corners[slot];
          const Corners corners{to_eigen(data.vertices[t[0]]), to_eigen(data.vertices[t[1]]),
                                to_eigen(data.vertices[t[2]])};
          EXPECT_GE(exact_distance(to_eigen(p), corners).compare(std::sqrt(double{squared[k]}) * (1 - 0x1p-21)), 0);
        }
      }
    }
  }
}

TEST(OrientedNodes, AreMadeWhereNeedlesAreAskewOnly) {
  TriangleMesh straight = needles(400);
  const Eigen::Quaterniond back = Eigen::Quaterniond(3, 1, 2, 1).normalized().conjugate();
  for (Eigen::Vector3d& p : straight.vertices) p = back * p;
  for (const TriangleMesh& mesh :
       {straight, icosphere(5), datasets::terrain(1, 100, 3), random_soup(1, 3000, 0.5), needles(3), cube(1)})
    EXPECT_TRUE(oriented_nodes(Bvh(mesh).data()).empty()) << mesh.triangles.size();
  EXPECT_FALSE(oriented_nodes(Bvh(needles(400)).data()).empty());
  EXPECT_FALSE(oriented_nodes(Bvh(fan(5000)).data()).empty());
  EXPECT_FALSE(oriented_nodes(Bvh(ribbon(8000)).data()).empty());
}

TEST(OrientedNodes, SpareQueriesMostNeedles) {
  const TriangleMesh mesh = needles(5000);
  const Bvh bvh(mesh);
  const Bvh::Data& data = bvh.data();
  QueryCounters counters;
  Random random(9);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d on = mesh.vertices[static_cast<std::size_t>(random.below(10000))];
    const Eigen::Vector3d query = random.uniform(0, 1) * on + 0.01 * random.in_cube();
    Nearest best;
    find_nearest(data, data.frame.to_working({query.x(), query.y(), query.z()}), 0, best, counters);
  }
  EXPECT_LT(counters.triangles, 200u * data.triangle_count() / 20);
}

TEST(OrientedNodes, AreMadeOnceHoweverManyThreadsAskFirst) {
  const Bvh bvh(needles(400));
  std::array<const OrientedNode*, 4> seen{};
  std::vector<std::thread> threads;
  for (const OrientedNode*& nodes : seen) threads.emplace_back([&] { nodes = oriented_nodes(bvh.data()).data(); });
  for (std::thread& thread : threads) thread.join();
  EXPECT_NE(seen[0], nullptr);
  EXPECT_EQ(std::count(seen.begin(), seen.end(), seen[0]), 4);
}

TEST(OrientedNodes, FollowVerticesThatMove) {
  Bvh bvh(needles(400));
  const Eigen::Vector3d at = needles(400).vertices[7];
  EXPECT_LT(closest_point(bvh, at).distance.upper, 1e-12);
  const TriangleMesh elsewhere = moved(needles(400), {0, 30, 0});
  bvh.refit(elsewhere);
  EXPECT_FALSE(oriented_nodes(bvh.data()).empty());
  EXPECT_LE(exact_distance(at, elsewhere).compare(closest_point(bvh, at).distance.upper), 0);
  EXPECT_GT(closest_point(bvh, at).distance.lower, 1);
}

}  // namespace oriented_nodes_test
