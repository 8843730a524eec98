// SPDX-License-Identifier: MIT
// The displacement bound of an affine map holds in exact rational arithmetic, and is 0 where nothing is rounded.
#include "meshbound/transform.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "meshbound/error.h"
#include "reference/small_meshes.h"

namespace meshbound {
namespace transform_test {

using Eigen::Affine3d;
using Eigen::Vector3d;

/// Squared distance between the exact image of `from` and `to`.
mpq_class squared_displacement(const Affine3d& map, const Vector3d& from, const Vector3d& to) {
  mpq_class sum = 0;
  for (int i = 0; i < 3; ++i) {
    mpq_class image(map.matrix()(i, 3));
    for (int j = 0; j < 3; ++j) image += mpq_class(map.matrix()(i, j)) * mpq_class(from[j]);
    image -= mpq_class(to[i]);
    sum += image * image;
  }
  return sum;
}

/// The claim; returns the largest displacement over the bound.
double check(const TriangleMesh& mesh, const Affine3d& map) {
  const TransformedMesh image = transformed(mesh, map);
  const mpq_class bound(image.displacement_bound);
  mpq_class worst = 0;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    worst = std::max(worst, squared_displacement(map, mesh.vertices[i], image.mesh.vertices[i]));
  EXPECT_LE(worst, bound * bound) << map.matrix();
  EXPECT_EQ(image.mesh.triangles, mesh.triangles);
  return image.displacement_bound > 0 ? std::sqrt(mpq_class(worst / (bound * bound)).get_d()) : 1;
}

TEST(TransformedMesh, IsWithinTheDisplacementBound) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  double tightness = 0;
  for (int i = 0; i < 300; ++i) {
    Affine3d map = Affine3d::Identity();
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 4; ++c) map.matrix()(r, c) = normal(random) * std::pow(10.0, (i % 7 - 3) * 3 * (c == 3));
    }
    tightness = std::max(tightness, check(reference::random_soup(static_cast<std::uint32_t>(i), 20, 1.0), map));
  }
  EXPECT_GT(tightness, 0.1) << "a bound far above the rounding widens every interval for nothing";
}

TEST(TransformedMesh, IsWithinTheDisplacementBoundUnderCancellation) {
  for (int i = 0; i < 100; ++i) {
    Affine3d map = Affine3d::Identity();
    map.matrix().row(0) << 1e8 / 3, -1e8 / 3, 1e-9 / 7, -1e-20;
    map.matrix().row(1) << 0.1, 0.2, -0.3, 1e16;
    const TriangleMesh mesh = reference::scaled(reference::random_soup(static_cast<std::uint32_t>(i), 10, 1.0),
                                                std::ldexp(1.0, 20 * (i % 20) - 200));
    check(mesh, map);
  }
}

TEST(TransformedMesh, IsWithinTheDisplacementBoundNextToUnderflow) {
  const Affine3d map(Eigen::Scaling(1.0 / 3, 1e-10 / 3, 0x1p-60));
  for (const double scale : {1e-300, 1e-310, 1e-320}) check(reference::scaled(reference::icosphere(1), scale), map);
}

TEST(TransformedMesh, IsExactWhereNothingIsRounded) {
  const TriangleMesh mesh = reference::random_soup(2, 50, 1.0);
  EXPECT_EQ(transformed(mesh, Affine3d::Identity()).displacement_bound, 0);
  Affine3d permutation;
  permutation.matrix() << 0, -1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 0, 0, 1;
  const TransformedMesh permuted = transformed(mesh, permutation);
  EXPECT_EQ(permuted.displacement_bound, 0);
  EXPECT_EQ(permuted.mesh.vertices[7], Vector3d(-mesh.vertices[7].y(), mesh.vertices[7].z(), mesh.vertices[7].x()));
  EXPECT_EQ(transformed(mesh, Affine3d(Eigen::Scaling(0.25))).displacement_bound, 0);
  const Affine3d shift(Eigen::Translation3d(1, -2, 0.5));
  EXPECT_EQ(transformed(reference::cube(1), shift).displacement_bound, 0);
}

TEST(TransformedMesh, RefusesWhatHasNoImage) {
  const TriangleMesh mesh = reference::cube(1);
  Affine3d map = Affine3d::Identity();
  map.matrix()(3, 0) = 1;
  EXPECT_THROW((void)transformed(mesh, map), InvalidInput);
  map = Affine3d::Identity();
  map.matrix()(0, 0) = std::nan("");
  EXPECT_THROW((void)transformed(mesh, map), InvalidInput);
  map = Affine3d(Eigen::Scaling(1e300));
  EXPECT_NO_THROW((void)transformed(mesh, map));
  EXPECT_THROW((void)transformed(reference::cube(1e10), map), InvalidInput);
}

TEST(TransformedMesh, DoesNotCareForUnusedVertices) {
  TriangleMesh mesh = reference::cube(1);
  mesh.vertices.emplace_back(std::nan(""), 1e308, 0);
  const TransformedMesh image = transformed(mesh, Affine3d(Eigen::Scaling(2.0)));
  EXPECT_EQ(image.displacement_bound, 0);
  EXPECT_EQ(image.mesh.vertices.size(), 9u);
}

TEST(Widened, ContainsEveryNumberThatNear) {
  const Bounds bounds = widened({1, 2}, 0.1);
  EXPECT_LE(mpq_class(bounds.lower), mpq_class(1) - mpq_class(0.1));
  EXPECT_GE(mpq_class(bounds.upper), mpq_class(2) + mpq_class(0.1));
  EXPECT_NEAR(bounds.lower, 0.9, 1e-15);
  EXPECT_NEAR(bounds.upper, 2.1, 1e-15);
  EXPECT_EQ(widened({0.5, 1}, 0.75).lower, 0);
  EXPECT_EQ(widened({0.1, 0.3}, 0).lower, 0.1);
  EXPECT_EQ(widened({0.1, 0.3}, 0).upper, 0.3);
  const Bounds unknown = widened({}, 1);
  EXPECT_EQ(unknown.upper, std::numeric_limits<double>::infinity());
  for (const double displacement : {-1.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW((void)widened({1, 2}, displacement), InvalidInput);
}

}  // namespace transform_test
}  // namespace meshbound
