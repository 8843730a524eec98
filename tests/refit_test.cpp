// SPDX-License-Identifier: MIT
// A tree whose vertices have moved answers as one that is built anew.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "bvh/bvh_data.h"
#include "meshbound/bvh.h"
#include "meshbound/distance.h"
#include "meshbound/error.h"
#include "reference/small_meshes.h"

namespace refit_test {

using namespace meshbound;
using namespace meshbound::reference;
using Eigen::Vector3d;

Vector3d random_offset(std::mt19937& random, double size) {
  const auto uniform = [&] { return size * (2 * (static_cast<double>(random()) / 4294967296.0) - 1); };
  return {uniform(), uniform(), uniform()};
}

TriangleMesh deformed(TriangleMesh mesh, std::mt19937& random) {
  switch (random() % 7) {
    case 0:  // small noise
      for (Vector3d& v : mesh.vertices) v += random_offset(random, 0.01);
      return mesh;
    case 1:  // each vertex anywhere
      for (Vector3d& v : mesh.vertices) v = random_offset(random, 1);
      return mesh;
    case 2:  // bent
      for (Vector3d& v : mesh.vertices) v = {v.x() * std::cos(v.y()), v.y() + v.x() * v.x(), std::exp(v.z())};
      return mesh;
    case 3:
      return moved(scaled(mesh, 1e-12), {1e3, -1e3, 1e3});
    case 4:
      return scaled(mesh, 1e100);
    case 5:  // flat
      for (Vector3d& v : mesh.vertices) v.z() = 0;
      return mesh;
    default:  // a point
      for (Vector3d& v : mesh.vertices) v = {0.1, 0.2, 0.3};
      return mesh;
  }
}

void expect_overlap(const Bounds& a, const Bounds& b) {
  EXPECT_LE(a.lower, a.upper);
  EXPECT_LE(a.lower, b.upper);
  EXPECT_LE(b.lower, a.upper);
}

template <class Vector>
bool same_bytes(const Vector& a, const Vector& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0;
}

void expect_same_geometry(const Bvh& a, const Bvh& b) {
  EXPECT_TRUE(same_bytes(a.data().vertices, b.data().vertices));
  EXPECT_TRUE(same_bytes(a.data().nodes, b.data().nodes));
  EXPECT_TRUE(same_bytes(a.data().normals, b.data().normals));
  EXPECT_TRUE(same_bytes(a.data().corners, b.data().corners));
  EXPECT_TRUE(same_bytes(a.data().neighbours, b.data().neighbours));
}

class Deformations : public testing::TestWithParam<std::uint32_t> {};

TEST_P(Deformations, AreAnsweredAsByATreeBuiltAnew) {
  std::mt19937 random(GetParam());
  const TriangleMesh shape = GetParam() % 3 == 0 ? random_soup(GetParam(), 60, 0.3) : icosphere(2);
  const Bvh other(cube(0.7));
  Bvh tree(shape);
  TriangleMesh mesh = shape;
  for (int step = 0; step < 8; ++step) {
    mesh = deformed(shape, random);
    tree.refit(mesh, {.threads = 1 + step % 2});
    const Bvh anew(mesh);
    EXPECT_EQ(tree.bounding_box_diagonal(), anew.bounding_box_diagonal());
    EXPECT_EQ(tree.bounding_box().min(), anew.bounding_box().min());
    EXPECT_EQ(tree.bounding_box().max(), anew.bounding_box().max());
    expect_overlap(hausdorff_distance(tree, other).bounds, hausdorff_distance(anew, other).bounds);
    expect_overlap(hausdorff_distance(other, tree).bounds, hausdorff_distance(other, anew).bounds);
    const double size = anew.bounding_box_diagonal();
    const HausdorffDistance self = hausdorff_distance(tree, anew);
    EXPECT_LE(self.bounds.upper, 1e-9 * size) << step;
    for (int i = 0; i < 20; ++i) {
      const Vector3d query = anew.bounding_box().center() + random_offset(random, size + 1e-3);
      expect_overlap(closest_point(tree, query).distance, closest_point(anew, query).distance);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, Deformations, testing::Range(0U, 24U));

TEST(Refit, BackToTheStartGivesTheSameTree) {
  const TriangleMesh shape = icosphere(3);
  std::mt19937 random(1);
  const Bvh built(shape);
  Bvh tree(shape);
  tree.refit(moved(scaled(shape, 3), {5, 5, 5}));
  tree.refit(shape);
  expect_same_geometry(tree, built);
  EXPECT_EQ(tree.growth(), 1);
}

TEST(Refit, GivesTheSameTreeForAnyNumberOfThreads) {
  const TriangleMesh shape = random_soup(5, 3000, 0.1), other = random_soup(6, 3000, 0.1);
  Bvh one(shape), two(shape);
  one.refit(other, {.threads = 1});
  two.refit(other, {.threads = 2});
  expect_same_geometry(one, two);
}

/// More than a process may have: a team of that many ends it.
TEST(Refit, FormsNoThreadsThatItHasNoWorkFor) {
  const TriangleMesh shape = icosphere(3);
  Bvh one(shape), many(shape, {.threads = 1000000});
  one.refit(scaled(shape, 3), {.threads = 1});
  many.refit(scaled(shape, 3), {.threads = 1000000});
  expect_same_geometry(one, many);
}

TEST(Refit, TurnsTrianglesSoThatTheirLongestEdgeIsFirst) {
  Bvh tree(single_triangle({0, 0, 0}, {3, 0, 0}, {0, 1, 0}));
  const TriangleMesh moved = single_triangle({0, 0, 0}, {1, 0, 0}, {0, 5, 0});
  tree.refit(moved);
  const Bvh::Data& data = tree.data();
  const Triangle& t = data.corners[0];
  const auto edge = [&](int k) { return length(data.vertices[t[(k + 1) % 3]] - data.vertices[t[k]]); };
  EXPECT_GE(edge(0), edge(1));
  EXPECT_GE(edge(0), edge(2));
}

TEST(Refit, TreeStaysAsItWasWhenTheMeshIsRefused) {
  const TriangleMesh shape = icosphere(2);
  Bvh tree(shape);
  const Bvh before(shape);
  const Bvh::Data* const data = &tree.data();
  TriangleMesh fewer = shape, rejoined = shape, broken = shape, mirrored = shape;
  fewer.triangles.pop_back();
  std::swap(rejoined.triangles[3], rejoined.triangles[4]);
  broken.vertices.back().y() = std::numeric_limits<double>::infinity();
  std::swap(mirrored.triangles[7][0], mirrored.triangles[7][1]);
  for (const TriangleMesh& mesh : {fewer, rejoined, broken, mirrored, TriangleMesh{}})
    EXPECT_THROW(tree.refit(mesh), InvalidInput);
  EXPECT_EQ(&tree.data(), data);
  expect_same_geometry(tree, before);
}

TEST(Refit, FiguresGrowthOfTheBoxes) {
  const TriangleMesh shape = icosphere(4);
  Bvh tree(shape);
  EXPECT_EQ(tree.growth(), 1);
  tree.refit(moved(scaled(shape, 8), {16, 0, 0}));
  EXPECT_NEAR(tree.growth(), 1, 1e-3);
  TriangleMesh shuffled = shape;
  std::mt19937 random(1);
  std::shuffle(shuffled.vertices.begin(), shuffled.vertices.end(), random);
  tree.refit(shuffled);
  EXPECT_GT(tree.growth(), 5);
  TriangleMesh point = shape;
  for (Vector3d& v : point.vertices) v = {1, 1, 1};
  tree.refit(point);
  EXPECT_TRUE(std::isfinite(tree.growth()));
}

}  // namespace refit_test
