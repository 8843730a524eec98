// SPDX-License-Identifier: MIT
// Edges are matched by the positions of their ends: a mesh whose triangles have vertices of their own is walked like
// one whose triangles share them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "bvh/bvh_data.h"
#include "meshbound/distance.h"
#include "reference/hard_meshes.h"
#include "reference/small_meshes.h"

namespace meshbound {
namespace seam_test {

using Eigen::Vector3d;
using namespace reference;

bool same_adjacency(const Bvh& a, const Bvh& b) {
  const auto &p = a.data().neighbours, &q = b.data().neighbours;
  return p.size() == q.size() && std::memcmp(p.data(), q.data(), p.size() * sizeof(p[0])) == 0;
}

/// Pages on one spine, the first `shared` of them with the vertices of the spine in common.
TriangleMesh book(std::uint32_t pages, std::uint32_t shared) {
  const Vector3d foot(0, 0, 0), head(0, 0, 1);
  TriangleMesh mesh;
  mesh.vertices = {foot, head};
  for (std::uint32_t page = 0; page < pages; ++page) {
    const auto next = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.emplace_back(std::cos(page), std::sin(page), 0.5);
    if (page < shared) {
      mesh.triangles.push_back({0, 1, next});
    } else {
      mesh.vertices.push_back(foot);
      mesh.vertices.push_back(head);
      mesh.triangles.push_back({next + 1, next + 2, next});
    }
  }
  return mesh;
}

/// Every third triangle with vertices of its own.
TriangleMesh torn(TriangleMesh mesh) {
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 3) {
    for (std::uint32_t& v : mesh.triangles[i]) {
      mesh.vertices.push_back(mesh.vertices[v]);
      v = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
    }
  }
  return mesh;
}

TriangleMesh turned_in_places(TriangleMesh mesh) {
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 5) std::swap(mesh.triangles[i][0], mesh.triangles[i][1]);
  return mesh;
}

TEST(Seams, ASoupHasTheAdjacencyOfTheWeldedMesh) {
  for (const TriangleMesh& mesh :
       {icosphere(3), unit_square(9), cube(0.3), turned_in_places(icosphere(3)), book(5, 5), fan(5000)}) {
    const Bvh welded(mesh);
    EXPECT_TRUE(same_adjacency(Bvh(unwelded(mesh)), welded)) << mesh.triangles.size();
    EXPECT_TRUE(same_adjacency(Bvh(torn(mesh)), welded)) << mesh.triangles.size();
  }
}

TEST(Seams, PagesJoinOneRingWhateverVerticesTheyShare) {
  for (const std::uint32_t shared : {0U, 1U, 2U, 4U, 5U}) {
    const Bvh bvh(book(5, shared));
    const Bvh::Data& data = bvh.data();
    std::uint32_t slot = 0;
    std::vector<bool> met(5, false);
    for (int step = 0; step < 5; ++step) {
      EXPECT_FALSE(met[slot]);
      met[slot] = true;
      std::uint32_t next = no_slot;
      for (const Neighbour& across : data.neighbours[slot])
        if (across.slot != no_slot) next = across.slot;
      ASSERT_LT(next, 5U) << shared;
      slot = next;
    }
    EXPECT_EQ(slot, 0U) << shared;
  }
}

TEST(Seams, ZeroAndMinusZeroAreOnePosition) {
  const TriangleMesh square = soup({{Vector3d(-1, -1, 0.0), Vector3d(1, -1, 0.0), Vector3d(0.0, 1, 0.0)},
                                    {Vector3d(1, -1, -0.0), Vector3d(2, 1, 0.0), Vector3d(-0.0, 1, -0.0)}});
  const Bvh bvh(square);
  int linked = 0;
  for (const auto& across : bvh.data().neighbours)
    for (const Neighbour& neighbour : across)
      if (neighbour.slot != no_slot) {
        EXPECT_EQ(neighbour.flipped, 0U);
        ++linked;
      }
  EXPECT_EQ(linked, 2);
}

/// Segments go on at their ends, whatever edges they have there; a triangle that is a point leads nowhere.
TEST(Seams, EdgesWithoutLengthJoinSegmentsOnly) {
  const Vector3d here(0.5, 0.5, 0.5);
  const Bvh bvh(soup({{here, here, Vector3d(1, 0, 0)}, {here, here, Vector3d(0, 1, 0)}, {here, here, here}}));
  const auto& of_slot = bvh.data().triangle_of_slot;
  const auto point = static_cast<std::uint32_t>(std::find(of_slot.begin(), of_slot.end(), 2) - of_slot.begin());
  const auto joined = [&](std::uint32_t i, std::uint32_t j) {
    const auto& across = bvh.data().neighbours[i];
    return std::any_of(across.begin(), across.end(), [j](const Neighbour& n) { return n.slot == j; });
  };
  for (std::uint32_t i = 0; i < 3; ++i)
    for (std::uint32_t j = 0; j < 3; ++j) EXPECT_EQ(joined(i, j), i != j && i != point && j != point) << i << ' ' << j;
}

TEST(Seams, AreTheSameForAnyNumberOfThreads) {
  for (const TriangleMesh& mesh : {unwelded(icosphere(6)), torn(icosphere(5)), unwelded(fan(20000)),
                                   torn(unit_square(64)), both(unwelded(icosphere(5)), icosphere(5))}) {
    const Bvh one(mesh, {.threads = 1});
    for (const int threads : {2, 3, 20}) EXPECT_TRUE(same_adjacency(one, Bvh(mesh, {.threads = threads}))) << threads;
  }
}

/// Where two triangles lie in one plane, no bound by one of them covers a piece over their seam: a walk that cannot
/// cross it halves pieces down to the error bound, millions of them.
TEST(Seams, AWalkCrossesTheSeamOfTwoTriangles) {
  const TriangleMesh one = single_triangle({0, 1, 0}, {1, 1, 0}, {1, 2, 0});
  const TriangleMesh two = soup({{Vector3d(0, 0, 0), Vector3d(1, 1, 0), Vector3d(1, 2, 0)},
                                 {Vector3d(0, 0, 0), Vector3d(1, 2, 0), Vector3d(0, 2, 0)}});
  DistanceOptions options;
  options.error_bound = 1e-9;
  options.budget.subdivisions = 1000;
  const OneSidedDistance result = one_sided_hausdorff_distance(Bvh(one), Bvh(two), options);
  EXPECT_LE(result.bounds.upper, 1e-9);
  EXPECT_LE(result.stats.pieces, 20U);
}

struct Work {
  std::uint64_t pieces, queries;
};

Work work_between(const TriangleMesh& a, const TriangleMesh& b) {
  DistanceOptions options;
  options.error_bound = 1e-7;
  options.budget.subdivisions = 100000;
  const Bvh tree_a(a), tree_b(b);
  const OneSidedDistance there = one_sided_hausdorff_distance(tree_a, tree_b, options),
                         back = one_sided_hausdorff_distance(tree_b, tree_a, options);
  EXPECT_EQ(there.outcome, Outcome::Converged);
  EXPECT_EQ(back.outcome, Outcome::Converged);
  return {there.stats.pieces + back.stats.pieces, there.stats.closest_point_queries + back.stats.closest_point_queries};
}

TEST(Seams, SoupsAreMeasuredByAsMuchWorkAsWeldedMeshes) {
  const std::pair<TriangleMesh, TriangleMesh> pairs[] = {
      {unit_square(6), unit_square(7)}, {icosphere(3), icosphere(2)}, {cube(0.5), subdivided(subdivided(cube(0.5)))}};
  for (const auto& [a, b] : pairs) {
    const Work welded = work_between(a, b), soups = work_between(unwelded(a), unwelded(b));
    EXPECT_LE(static_cast<double>(soups.pieces), 1.3 * static_cast<double>(welded.pieces));
    // A query costs about as much as a piece, and a soup has more vertices to ask for.
    EXPECT_LE(static_cast<double>(soups.pieces + soups.queries),
              1.3 * static_cast<double>(welded.pieces + welded.queries));
  }
}

/// Vertices at one position when the tree was built need not stay there: adjacency is a hint.
TEST(Seams, RefitMayTearThemApart) {
  const TriangleMesh square = unwelded(unit_square(4)), probe = moved(unit_square(3), {0.1, 0.1, 0.05});
  TriangleMesh apart = square;
  for (std::size_t v = 0; v < apart.vertices.size(); ++v)
    apart.vertices[v] += Vector3d(0, 0, 0.03 * static_cast<double>(v / 3 % 7));
  Bvh tree(square);
  tree.refit(apart);
  const Bvh anew(apart), other(probe);
  const HausdorffDistance refitted = hausdorff_distance(tree, other), built = hausdorff_distance(anew, other);
  EXPECT_LE(refitted.bounds.lower, built.bounds.upper);
  EXPECT_LE(built.bounds.lower, refitted.bounds.upper);
  tree.refit(square);
  EXPECT_TRUE(same_adjacency(tree, Bvh(square)));
}

}  // namespace seam_test
}  // namespace meshbound
