// SPDX-License-Identifier: GPL-3.0-or-later
// A decimation with a tolerance of normals: few faces turn more before anything is taken back, also where sheets lie
// near each other, and threads and vector code change nothing.
#include <gtest/gtest.h>

#include <algorithm>

#include "datasets/analytic_meshes.h"
#include "drivers.h"
#include "levels/level_run.h"
#include "meshbound/normal_deviation.h"
#include "meshbound/simplify.h"
#include "numeric/vector_code.h"
#include "setting.h"
#include "simplify/faults.h"
#include "simplify_options.h"

namespace meshbound {
namespace normal_tolerance_test {

constexpr double tolerance = 0.02, degrees = 30;

/// A terrain and another sheet below it, half the tolerance away and turned over.
TriangleMesh two_sheets(int size) {
  TriangleMesh mesh = datasets::terrain(1, size, 3);
  const auto vertices = static_cast<std::uint32_t>(mesh.vertices.size());
  const std::size_t triangles = mesh.triangles.size();
  for (std::uint32_t v = 0; v < vertices; ++v)
    mesh.vertices.push_back(mesh.vertices[v] - Eigen::Vector3d(0, 0, tolerance / 2));
  for (std::size_t t = 0; t < triangles; ++t) {
    const auto [a, b, c] = mesh.triangles[t];
    mesh.triangles.push_back({vertices + a, vertices + c, vertices + b});
  }
  return mesh;
}

class NormalTolerance : public testing::TestWithParam<test::NamedDriver> {
 protected:
  [[nodiscard]] SimplifyOptions options() const {
    SimplifyOptions options = test::within(tolerance);
    options.driver = GetParam().driver;
    options.normal_tolerance = degrees;
    return options;
  }
};

/// Without rivals 530 of 25,600 faces turn too much.
TEST_P(NormalTolerance, HoldsNearlyEverywhereWithoutAMeasurement) {
  const TriangleMesh sheets = two_sheets(80);
  const SimplifiedLevel level = decimate_levels(sheets, options()).last();
  EXPECT_LT(level.faces(), sheets.triangles.size() / 2);
  const NormalDeviation deviation = normal_deviation(sheets, level.mesh, {degrees, 0});
  EXPECT_LT(deviation.exceeding.size(), sheets.triangles.size() / 500);
}

TEST_P(NormalTolerance, GivesTheSameMeshForEveryNumberOfThreads) {
  const TriangleMesh sheets = two_sheets(80);
  SimplifyOptions with = options();
  with.threads = 1;
  const SimplifiedLevel one = decimate_levels(sheets, with).last();
  for (const int threads : {2, 5}) {
    with.threads = threads;
    const SimplifiedLevel more = decimate_levels(sheets, with).last();
    EXPECT_EQ(one.mesh.vertices, more.mesh.vertices);
    EXPECT_EQ(one.mesh.triangles, more.mesh.triangles);
  }
}

TEST_P(NormalTolerance, GivesTheSameMeshWithAndWithoutVectorCode) {
  if (!uses_avx2()) GTEST_SKIP() << "this machine has no AVX2";
  const TriangleMesh sheets = two_sheets(40);
  const SimplifiedLevel with_vectors = decimate_levels(sheets, options()).last();
  const test::Setting portable(internal::portable_kernels, true);
  ASSERT_FALSE(uses_avx2());
  const SimplifiedLevel without = decimate_levels(sheets, options()).last();
  EXPECT_EQ(with_vectors.mesh.vertices, without.mesh.vertices);
  EXPECT_EQ(with_vectors.mesh.triangles, without.mesh.triangles);
}

INSTANTIATE_TEST_SUITE_P(With, NormalTolerance, testing::ValuesIn(test::drivers()),
                         [](const auto& driver) { return driver.param.name; });

}  // namespace normal_tolerance_test
}  // namespace meshbound
