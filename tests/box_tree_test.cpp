// SPDX-License-Identifier: MIT
// BoxTree against testing each box.
#include "simplify/cover/box_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
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

TEST(BoxTree, FindsNothingInEmptyBoxes) {
  const BoxTree tree(std::vector<Eigen::AlignedBox3d>(20));
  std::vector<std::uint32_t> found;
  tree.find(Eigen::AlignedBox3d(Eigen::Vector3d::Constant(-1e300), Eigen::Vector3d::Constant(1e300)), found);
  EXPECT_TRUE(found.empty());
}

}  // namespace
}  // namespace meshbound
