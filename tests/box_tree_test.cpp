// SPDX-License-Identifier: MIT
// BoxTree against testing each box.
#include "simplify/cover/box_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "reference/point_triangle_cases.h"

namespace meshbound {
namespace {

/// Corners on a coarse grid: many boxes touch, and many are points.
Eigen::AlignedBox3d random_box(reference::Random& random) {
  Eigen::AlignedBox3d box;
  for (int corner = 0; corner < 2; ++corner)
    box.extend(Eigen::Vector3d(random.below(12), random.below(12), random.below(3)));
  return box;
}

TEST(BoxTree, FindsTheBoxesThatMeetABox) {
  reference::Random random(1);
  for (const std::size_t count : {0, 1, 7, 8, 9, 63, 64, 65, 511, 513, 3000}) {
    std::vector<Eigen::AlignedBox3d> boxes;
    for (std::size_t i = 0; i < count; ++i) boxes.push_back(random_box(random));
    const BoxTree tree(boxes);
    for (int query = 0; query < 100; ++query) {
      const Eigen::AlignedBox3d box = random_box(random);
      std::vector<std::uint32_t> found = {7}, expected = {7};
      tree.find(box, found);
      for (std::uint32_t i = 0; i < count; ++i)
        if (boxes[i].intersects(box)) expected.push_back(i);
      std::sort(found.begin() + 1, found.end());
      ASSERT_EQ(found, expected) << count;
    }
  }
}

// A box that touches the query in a corner is found wherever both are, however large their coordinates; one that is
// apart by more than single precision is not, even if there is another one far away.
TEST(BoxTree, LosesNoBoxToRounding) {
  reference::Random random(2);
  for (const double scale : {1e-300, 1.0 / 3, 1e5 / 3, 1e290}) {
    for (const double offset : {0.0, 1e9}) {
      std::vector<Eigen::AlignedBox3d> boxes;
      for (int i = 0; i < 500; ++i) {
        const Eigen::AlignedBox3d box = random_box(random);
        const Eigen::Vector3d to = Eigen::Vector3d::Constant(offset);
        boxes.emplace_back(scale * (box.min() + to), scale * (box.max() + to));
      }
      boxes.emplace_back(Eigen::Vector3d::Constant(1e12 * scale), Eigen::Vector3d::Constant(1e13 * scale));
      const BoxTree tree(boxes);
      for (const Eigen::AlignedBox3d& box : boxes) {
        const Eigen::AlignedBox3d query(box.max(), 1.1 * box.max());
        std::vector<std::uint32_t> found;
        tree.find(query, found);
        std::sort(found.begin(), found.end());
        for (std::uint32_t i = 0; i < boxes.size(); ++i) {
          const bool is_found = std::binary_search(found.begin(), found.end(), i);
          if (boxes[i].intersects(query)) {
            EXPECT_TRUE(is_found) << scale << " " << offset;
          } else if (scale > 1e-300 && scale < 1e290) {
            EXPECT_FALSE(is_found) << scale << " " << offset;
          }
        }
      }
    }
  }
}

std::vector<std::uint32_t> visited_near(const BoxTree& tree, const Eigen::Vector3d& point, double reach) {
  std::vector<std::uint32_t> visited;
  tree.visit_near(point, reach * reach, [&](std::uint32_t i) {
    visited.push_back(i);
    return reach * reach;
  });
  return visited;
}

TEST(BoxTree, VisitsTheBoxesNearAPoint) {
  reference::Random random(3);
  for (const std::size_t count : {0, 1, 7, 8, 9, 64, 65, 513, 3000}) {
    std::vector<Eigen::AlignedBox3d> boxes(count);
    for (std::size_t i = 0; i < count; i += i % 5 == 3 ? 2 : 1) boxes[i] = random_box(random);  // some stay empty
    const BoxTree tree(boxes);
    for (int query = 0; query < 100; ++query) {
      const Eigen::Vector3d point = 7 * (random.in_cube() + Eigen::Vector3d::Ones());
      const double reach = random.uniform(0, 4);
      const std::vector<std::uint32_t> visited = visited_near(tree, point, reach);
      for (std::uint32_t i = 0; i < count; ++i) {
        const double distance = boxes[i].isEmpty() ? HUGE_VAL : boxes[i].exteriorDistance(point);
        if (std::abs(distance - reach) < 1e-4) continue;
        ASSERT_EQ(std::count(visited.begin(), visited.end(), i), distance <= reach ? 1 : 0) << count;
      }
    }
  }
}

TEST(BoxTree, VisitsNearerBoxesFirst) {
  reference::Random random(4);
  std::vector<Eigen::AlignedBox3d> boxes(20000);
  for (Eigen::AlignedBox3d& box : boxes) {
    const Eigen::Vector3d lo = random.in_cube();
    box = Eigen::AlignedBox3d(lo, lo + 1e-3 * Eigen::Vector3d::Ones());
  }
  const BoxTree tree(boxes);
  for (int query = 0; query < 50; ++query) {
    const Eigen::Vector3d point = random.in_cube();
    double nearest = HUGE_VAL;
    std::size_t visits = 0;
    tree.visit_near(point, nearest, [&](std::uint32_t i) {
      ++visits;
      return nearest = std::min(nearest, boxes[i].squaredExteriorDistance(point));
    });
    for (const Eigen::AlignedBox3d& box : boxes) EXPECT_GE(box.squaredExteriorDistance(point), nearest);
    EXPECT_LT(visits, 100U);
    visits = 0;
    tree.visit_near(point, HUGE_VAL, [&](std::uint32_t) { return ++visits < 7 ? HUGE_VAL : BoxTree::end_of_visit; });
    EXPECT_EQ(visits, 7U);
  }
}

// A box whose corner is at the reach, or touches the point, is visited however large the coordinates of both are.
TEST(BoxTree, LosesNoNearBoxToRounding) {
  reference::Random random(5);
  for (const double scale : {1e-300, 1.0 / 3, 1e5 / 3, 1e290}) {
    for (const double offset : {0.0, 1e9}) {
      std::vector<Eigen::AlignedBox3d> boxes;
      for (int i = 0; i < 500; ++i) {
        const Eigen::AlignedBox3d box = random_box(random);
        const Eigen::Vector3d to = Eigen::Vector3d::Constant(offset);
        boxes.emplace_back(scale * (box.min() + to), scale * (box.max() + to));
      }
      const BoxTree tree(boxes);
      for (std::uint32_t i = 0; i < boxes.size(); ++i) {
        for (const double reach : {0.0, 1e-3, 1.0}) {
          const Eigen::Vector3d point = boxes[i].max() + scale * reach * Eigen::Vector3d::UnitX();
          const std::vector<std::uint32_t> visited = visited_near(tree, point, 1.0001 * scale * reach);
          EXPECT_TRUE(std::ranges::count(visited, i) == 1) << scale << " " << offset << " " << reach;
        }
      }
    }
  }
}

TEST(BoxTree, FindsNothingInEmptyBoxes) {
  const BoxTree tree(std::vector<Eigen::AlignedBox3d>(20));
  std::vector<std::uint32_t> found;
  tree.find(Eigen::AlignedBox3d(Eigen::Vector3d::Constant(-1e300), Eigen::Vector3d::Constant(1e300)), found);
  EXPECT_TRUE(found.empty());
  EXPECT_TRUE(visited_near(tree, Eigen::Vector3d::Zero(), HUGE_VAL).empty());
}

}  // namespace
}  // namespace meshbound
