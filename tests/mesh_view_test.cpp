// SPDX-License-Identifier: MIT
// Views of buffers: from ranges, whose sizes are checked, and from pointers; of float and double, 16- and 32-bit
// indices.
#include "meshbound/mesh_view.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <span>
#include <vector>

namespace meshbound {
namespace mesh_view_test {

/// Corners of the unit square, two triangles.
const std::vector<double> doubles = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
const std::vector<float> floats(doubles.begin(), doubles.end());

template <class Index>
std::vector<Index> square() {
  return {0, 1, 2, 0, 2, 3};
}

void expect_square(const MeshView& view) {
  validate(view);
  ASSERT_EQ(view.vertex_count(), 4u);
  ASSERT_EQ(view.triangle_count(), 2u);
  EXPECT_EQ(view.vertex(2), Eigen::Vector3d(1, 1, 0));
  EXPECT_EQ(view.triangle(0), (Triangle{0, 1, 2}));
  EXPECT_EQ(view.triangle(1), (Triangle{0, 2, 3}));
}

template <class Index>
class MeshViewOf : public testing::Test {};
using Indices = testing::Types<std::uint16_t, std::uint32_t, int>;
TYPED_TEST_SUITE(MeshViewOf, Indices);

TYPED_TEST(MeshViewOf, ReadsEveryKindOfBuffer) {
  const std::vector<TypeParam> indices = square<TypeParam>();
  expect_square(MeshView(doubles, indices));
  expect_square(MeshView(floats, std::span(indices)));
  expect_square(MeshView(doubles.data(), 4, 3 * sizeof(double), indices));
  expect_square(MeshView(floats.data(), 4, 3 * sizeof(float), indices.data(), 2));
  struct Vertex {
    float normal[3] = {9, 9, 9}, position[3] = {};
  };
  std::array<Vertex, 4> vertices;
  for (std::size_t i = 0; i < 12; ++i) vertices[i / 3].position[i % 3] = floats[i];
  expect_square(MeshView(vertices[0].position, vertices.size(), sizeof(Vertex), indices));
}

TYPED_TEST(MeshViewOf, RefusesSizesThatAreNoMultipleOfThree) {
  std::vector<TypeParam> indices = square<TypeParam>();
  EXPECT_THROW(MeshView(std::span(doubles).first(11), indices), InvalidInput);
  indices.pop_back();
  EXPECT_THROW(MeshView(doubles, indices), InvalidInput);
  EXPECT_THROW(MeshView(floats.data(), 4, 3 * sizeof(float), indices), InvalidInput);
}

TEST(MeshViewOfInt, RefusesNegativeIndices) {
  const std::vector<int> indices = {0, 1, -1};
  EXPECT_THROW(validate(MeshView(doubles, indices)), InvalidInput);
}

}  // namespace mesh_view_test
}  // namespace meshbound
