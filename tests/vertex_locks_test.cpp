// SPDX-License-Identifier: GPL-3.0-or-later
// What the user wants kept is there afterwards, to the bit, and the rest is simplified all the same.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "datasets/analytic_meshes.h"
#include "meshbound/cgal/lod_chain.h"
#include "meshbound/cgal/simplify_with_bound.h"
#include "meshbound/error.h"
#include "reference/small_meshes.h"
#include "simplify_options.h"

namespace meshbound::cgal {
namespace vertex_locks_test {

using Place = std::array<double, 3>;

Place place(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

std::set<Place> places(const TriangleMesh& mesh) {
  std::set<Place> all;
  for (const Eigen::Vector3d& p : mesh.vertices) all.insert(place(p));
  return all;
}

std::set<std::pair<Place, Place>> edges_of(const TriangleMesh& mesh) {
  std::set<std::pair<Place, Place>> edges;
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i)
      edges.insert(std::minmax(place(mesh.vertices[t[i]]), place(mesh.vertices[t[(i + 1) % 3]])));
  }
  return edges;
}

using test::within;

std::vector<bool> every(std::size_t step, std::size_t count) {
  std::vector<bool> locked(count, false);
  for (std::size_t v = 0; v < count; v += step) locked[v] = true;
  return locked;
}

TEST(VertexLocks, KeepLockedVerticesToTheBitAndSimplifyTheRest) {
  const TriangleMesh far = reference::moved(datasets::torus(1, 0.3, 60, 24), {100.1, -3.3, 7.7});
  for (const CollapseCost cost : {CollapseCost::GarlandHeckbert, CollapseCost::LindstromTurk}) {
    SimplifyOptions options = within(0.03);
    options.driver = edge_collapse_driver(cost);
    options.locked_vertices = every(17, far.vertices.size());
    const SimplifiedLevel level = cgal::simplify_with_bound(far, options).last();
    EXPECT_EQ(level.verdict, Verdict::Within);
    EXPECT_LT(level.faces(), far.triangles.size() / 3);
    const std::set<Place> left = places(level.mesh);
    for (std::size_t v = 0; v < far.vertices.size(); ++v) {
      EXPECT_TRUE(!options.locked_vertices[v] || left.contains(place(far.vertices[v]))) << v;
    }
    options.locked_vertices.clear();
    EXPECT_LT(cgal::simplify_with_bound(far, options).last().faces(), level.faces()) << "locks cost nothing here";
  }
}

TEST(VertexLocks, HoldInAllLevelsOfAChainAndOnDuplicatedVertices) {
  TriangleMesh sphere = datasets::icosphere(1, 3);
  const auto copy = static_cast<std::uint32_t>(sphere.vertices.size());
  sphere.vertices.push_back(sphere.vertices[5]);
  const auto user = std::find_if(sphere.triangles.begin(), sphere.triangles.end(),
                                 [](const Triangle& t) { return t[0] == 5 || t[1] == 5 || t[2] == 5; });
  for (std::uint32_t& v : *user) v = v == 5 ? copy : v;
  LodOptions options;
  options.threads = 1;
  options.locked_vertices.assign(sphere.vertices.size(), false);
  options.locked_vertices[copy] = true;
  cgal::build_lod_chain(sphere, std::vector<double>{0.02, 0.1, 0.3}, options, [&](std::size_t, LodLevel&& level) {
    EXPECT_EQ(level.verdict, Verdict::Within);
    EXPECT_TRUE(places(level.mesh).contains(place(sphere.vertices[copy])));
    return true;
  });
}

/// Locks as above where vertices are moved by themselves and edges flipped.
TEST(VertexLocks, HoldWithHighEffort) {
  const TriangleMesh torus = datasets::torus(1, 0.3, 60, 24);
  SimplifyOptions options = within(0.03);
  options.locked_vertices = every(17, torus.vertices.size());
  const std::size_t normal = cgal::simplify_with_bound(torus, options).last().faces();
  options.effort = Effort::High;
  const SimplifiedLevel level = cgal::simplify_with_bound(torus, options).last();
  EXPECT_EQ(level.verdict, Verdict::Within);
  EXPECT_LT(level.faces(), normal);
  const std::set<Place> left = places(level.mesh);
  for (std::size_t v = 0; v < torus.vertices.size(); v += 17) EXPECT_TRUE(left.contains(place(torus.vertices[v]))) << v;
}

TEST(VertexLocks, AllLockedChangesNothing) {
  const TriangleMesh sphere = datasets::icosphere(1, 2);
  SimplifyOptions options = within(0.5);
  options.locked_vertices.assign(sphere.vertices.size(), true);
  EXPECT_EQ(cgal::simplify_with_bound(sphere, options).last().faces(), sphere.triangles.size());
}

/// The rim of each side of a box and nothing else: a right angle is above 60 degrees, flat is below.
void expect_rim_kept(Effort effort) {
  const TriangleMesh cube = datasets::cube(1, 8);
  SimplifyOptions options = within(0.2);
  options.effort = effort;
  options.feature_angle = std::numbers::pi / 3;
  const SimplifiedLevel level = cgal::simplify_with_bound(cube, options).last();
  EXPECT_EQ(level.verdict, Verdict::Within);
  const auto on_rim = [](const Place& p) {
    return std::count_if(p.begin(), p.end(), [](double x) { return x == 0 || x == 1; }) > 1;
  };
  const auto left = edges_of(level.mesh);
  std::size_t rim = 0;
  for (const auto& edge : edges_of(cube)) {
    const Place middle = {(edge.first[0] + edge.second[0]) / 2, (edge.first[1] + edge.second[1]) / 2,
                          (edge.first[2] + edge.second[2]) / 2};
    if (!on_rim(middle)) continue;
    ++rim;
    EXPECT_TRUE(left.contains(edge));
  }
  EXPECT_EQ(rim, 12u * 8);
  EXPECT_LT(level.faces(), cube.triangles.size() / 2);
  options.feature_angle = std::numbers::pi / 2 + 0.01;
  EXPECT_LT(cgal::simplify_with_bound(cube, options).last().faces(), level.faces());
}

TEST(FeatureAngle, KeepsSharpEdgesAsTheyAre) { expect_rim_kept(Effort::Normal); }
TEST(FeatureAngle, KeepsSharpEdgesAsTheyAreWithHighEffort) { expect_rim_kept(Effort::High); }

TEST(VertexLocks, RefuseAWrongNumberOfVerticesAndAWrongAngle) {
  const TriangleMesh sphere = datasets::icosphere(1, 1);
  SimplifyOptions options = within(0.1);
  options.locked_vertices.assign(3, true);
  EXPECT_THROW((void)cgal::simplify_with_bound(sphere, options), InvalidInput);
  options.locked_vertices.clear();
  options.feature_angle = -0.1;
  EXPECT_THROW((void)cgal::simplify_with_bound(sphere, options), InvalidInput);
}

}  // namespace vertex_locks_test
}  // namespace meshbound::cgal
