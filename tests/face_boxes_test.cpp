// SPDX-License-Identifier: MIT
// FaceBoxes against asking each face.
#include "simplify/cover/face_boxes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "geometry/boxes.h"
#include "reference/point_triangle_cases.h"
#include "reference/small_meshes.h"
#include "simplify/mesh/indexed_manifold.h"

namespace meshbound {
namespace face_boxes_test {

using Near = std::pair<double, std::uint32_t>;

std::vector<Near> nearest_of_all(const ArrayMesh& mesh, Vec3 point, double limit, std::size_t max_count) {
  std::vector<Near> near;
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    const double squared = squared_distance(mesh.triangle(f), point);
    if (!mesh.is_removed(f) && squared <= limit * limit) near.emplace_back(squared, f);
  }
  std::sort(near.begin(), near.end());
  if (near.size() > max_count) near.resize(max_count);
  return near;
}

std::vector<Near> nearest_of(const FaceBoxes& boxes, const ArrayMesh& mesh, Vec3 point, double limit,
                             std::size_t max_count) {
  std::vector<FaceBoxes::NearFace> nearest(3);  // what was there before goes
  boxes.find_nearest(mesh, point, limit, max_count, nearest);
  std::vector<Near> near;
  for (const FaceBoxes::NearFace& face : nearest) near.emplace_back(face.squared, face.face);
  return near;
}

/// Near what is wanted, all faces are found that lie there, and few others.
TEST(FaceBoxes, AreThoseOfTheFacesThatAreWanted) {
  const ArrayMesh mesh = indexed_manifold(reference::unit_square(20));
  const std::vector<Eigen::AlignedBox3d> wanted = {{Eigen::Vector3d(-9, -9, 0), Eigen::Vector3d(-0.6, -0.6, 0)},
                                                   {Eigen::Vector3d(0.6, 0.6, 0), Eigen::Vector3d(9, 9, 0)}};
  const FaceBoxes all(mesh), some(mesh, BoxTree(wanted));
  std::set<std::uint32_t> near;
  for (const Eigen::AlignedBox3d& box : wanted) {
    std::vector<std::uint32_t> of_all, of_some;
    all.find(box, of_all);
    some.find(box, of_some);
    EXPECT_TRUE(std::ranges::is_permutation(of_all, of_some));
    near.insert(of_all.begin(), of_all.end());
  }
  std::vector<std::uint32_t> anywhere;
  some.find({Eigen::Vector3d(-9, -9, -9), Eigen::Vector3d(9, 9, 9)}, anywhere);
  EXPECT_EQ(std::set<std::uint32_t>(anywhere.begin(), anywhere.end()), near);
  EXPECT_GT(near.size(), 10U);
  EXPECT_LT(near.size(), mesh.face_count() / 2);
}

TEST(FaceBoxes, FindFewFacesUnlessThereAreMore) {
  const ArrayMesh mesh = indexed_manifold(reference::unit_square(20));
  const FaceBoxes boxes(mesh);
  const Eigen::AlignedBox3d box(Eigen::Vector3d(0.2, 0.3, 0), Eigen::Vector3d(0.4, 0.6, 0));
  std::vector<std::uint32_t> all = {7};
  boxes.find(box, all);
  const std::size_t count = all.size() - 1;
  ASSERT_GT(count, 20U);
  for (const std::size_t max_count : {std::size_t{0}, count - 1, count, count + 1}) {
    std::vector<std::uint32_t> few = {7};
    EXPECT_EQ(boxes.find_few(box, max_count, few), max_count >= count);
    ASSERT_EQ(few.size(), 1 + std::min(max_count, count));
    EXPECT_TRUE(std::equal(few.begin(), few.end(), all.begin()));
  }
}

/// Of a surface, of small triangles anywhere and of large ones; half of the faces go after the boxes were made.
TEST(FaceBoxes, FindTheNearestFaces) {
  reference::Random random(1);
  for (const TriangleMesh& of : {reference::unit_square(30), reference::icosphere(3),
                                 reference::random_soup(1, 2000, 0.02), reference::random_soup(2, 1000, 0.5)}) {
    ArrayMesh mesh = indexed_manifold(of);
    const FaceBoxes boxes(mesh);
    for (const bool are_some_removed : {false, true}) {
      if (are_some_removed) {
        std::vector<std::uint32_t> odd;
        for (std::uint32_t f = 1; f < mesh.face_count(); f += 2) odd.push_back(f);
        mesh.remove_component(odd);
      }
      for (int query = 0; query < 50; ++query) {
        const Eigen::Vector3d p = random.in_cube();
        const Vec3 point{p.x(), p.y(), p.z()};
        const double limit = random.uniform(0, 1);
        for (const std::size_t max_count : {1, 16, 2000})
          ASSERT_EQ(nearest_of(boxes, mesh, point, limit, max_count), nearest_of_all(mesh, point, limit, max_count));
      }
    }
  }
}

/// Where the boxes of very many needles contain a point, it is enough to find some that are near.
TEST(FaceBoxes, FindNearFacesAroundAHub) {
  const ArrayMesh mesh = indexed_manifold(reference::fan(20000));
  const FaceBoxes boxes(mesh);
  for (const double limit : {0.01, 0.3}) {
    const std::vector<Near> near = nearest_of(boxes, mesh, {0.004, 0.003, 0}, limit, 16);
    EXPECT_EQ(near.size(), 16U);
    EXPECT_TRUE(std::ranges::is_sorted(near));
    for (const auto& [squared, face] : near) {
      EXPECT_EQ(squared, squared_distance(mesh.triangle(face), {0.004, 0.003, 0}));
      EXPECT_LE(squared, limit * limit);
    }
  }
}

}  // namespace face_boxes_test
}  // namespace meshbound
