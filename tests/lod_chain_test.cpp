// SPDX-License-Identifier: GPL-3.0-or-later
// The chain of levels as a library: each level holds against the original, the run goes on instead of starting again,
// and what nobody asks for is not computed.
#include "meshbound/lod_chain.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <utility>
#include <vector>

#if defined(MESHBOUND_WITH_CGAL)
#include "meshbound/cgal/lod_chain.h"
#endif

#include "datasets/analytic_meshes.h"
#include "meshbound/error.h"
#include "reference/small_meshes.h"

namespace meshbound {
namespace lod_chain_test {

LodOptions one_thread() {
  LodOptions options;
  options.threads = 1;
  return options;
}

/// A collapse that ends a run is made and measured before the texture around it was looked at: what is known of another
/// one must not be written to its faces. A grid without seams has one coordinate at each vertex.
TEST(LodChain, KeepsTheTextureTogetherWhereItStopsAtTheTolerance) {
  constexpr int n = 40;
  std::mt19937 random(13);
  std::uniform_real_distribution<double> noise(-1, 1);
  TriangleMesh mesh;
  std::vector<Eigen::Vector2d> uv;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) {
      uv.emplace_back(double(i) / n, double(j) / n);
      mesh.vertices.emplace_back(
          uv.back().x(), uv.back().y(),
          0.1 * std::sin(6 * uv.back().x()) * std::cos(5 * uv.back().y()) + 0.002 * noise(random));
    }
  LodOptions options = one_thread();
  for (std::uint32_t i = 0; i < n; ++i)
    for (std::uint32_t j = 0; j < n; ++j) {
      const std::uint32_t a = i * (n + 1) + j, b = a + 1, c = a + n + 1, d = c + 1;
      mesh.triangles.push_back({a, c, d});
      mesh.triangles.push_back({a, d, b});
    }
  for (const Triangle& t : mesh.triangles) options.texture_coordinates.push_back({uv[t[0]], uv[t[1]], uv[t[2]]});
  options.on_exceed = OnExceed::Stop;
  options.texture_tolerance = 0.004;
  LodChain chain(mesh, options);
  const LodLevel level = chain.next(0.004);
  EXPECT_LT(level.faces(), mesh.triangles.size() / 4);
  std::map<std::uint32_t, Eigen::Vector2d> of_vertex;
  for (std::size_t t = 0; t < level.faces(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector2d& here = level.texture_coordinates[t][k];
      EXPECT_EQ(of_vertex.try_emplace(level.mesh.triangles[t][k], here).first->second, here);
    }
}

TEST(LodChain, HandsOutLevelsThatGrowCoarserAndHoldAgainstTheOriginal) {
  const TriangleMesh torus = datasets::torus(1, 0.3, 60, 24);
  const std::vector<double> tolerances = {0.002, 0.01, 0.04};
  std::vector<LodLevel> levels;
  const std::size_t given = build_lod_chain(torus, tolerances, one_thread(), [&](std::size_t index, LodLevel&& level) {
    EXPECT_EQ(index, levels.size());
    levels.push_back(std::move(level));
    return true;
  });
  EXPECT_EQ(given, 3u);
  ASSERT_EQ(levels.size(), 3u);
  const Bvh original(torus);
  std::size_t faces = torus.triangles.size();
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(levels[i].tolerance, tolerances[i]);
    EXPECT_EQ(levels[i].verdict, Verdict::Within);
    EXPECT_LE(levels[i].distance->bounds.upper, tolerances[i]);
    EXPECT_EQ(check_tolerance(original, Bvh(levels[i].mesh), tolerances[i]).verdict, Verdict::Within);
    EXPECT_EQ(levels[i].faces(), levels[i].mesh.triangles.size());
    EXPECT_LT(levels[i].faces(), faces);
    faces = levels[i].faces();
  }
}

TEST(LodChain, GivesTheLevelsThatSimplifyWithBoundGives) {
  const TriangleMesh terrain = datasets::terrain(1, 30, 3);
  SimplifyOptions options;
  options.tolerance = 0.02;
  options.levels = {0.005};
  options.threads = 1;
  const SimplifyResult whole = simplify_with_bound(terrain, options);
  LodChain chain(terrain, one_thread());
  for (const SimplifiedLevel& level : whole.levels)
    EXPECT_EQ(chain.next(level.tolerance).mesh.triangles, level.mesh.triangles);
}

TEST(LodChain, ComputesNoLevelAfterTheSinkHasSaidNo) {
  const TriangleMesh torus = datasets::torus(1, 0.3, 60, 24);
  std::size_t progress_after_end = 0, calls = 0;
  bool ended = false;
  LodOptions options = one_thread();
  options.progress = [&](double) { progress_after_end += ended ? 1 : 0; };
  const std::size_t given =
      build_lod_chain(torus, std::vector<double>{0.001, 0.002, 0.05, 0.1}, options, [&](std::size_t index, LodLevel&&) {
        ++calls;
        ended = index == 1;
        return !ended;
      });
  EXPECT_EQ(given, 2u);
  EXPECT_EQ(calls, 2u);
  EXPECT_EQ(progress_after_end, 0u);
}

TEST(LodChain, GoesOnFromTheLevelBefore) {
  LodChain chain(datasets::icosphere(1, 4), one_thread());
  const LodLevel first = chain.next(0.005);
  const LodLevel second = chain.next(0.02);
  EXPECT_GT(first.collapses_performed, 1000u);
  EXPECT_GT(second.collapses_performed, first.collapses_performed);
  // Each collapse of a closed mesh takes two faces: those of the first level are not made again.
  EXPECT_EQ(second.collapses_performed - first.collapses_performed, (first.faces() - second.faces()) / 2);
  const SimplifyResult run = chain.describe();
  EXPECT_EQ(run.counts.proven_together + run.counts.proven_alone, second.collapses_performed);
}

/// How often two threads call `progress` depends on how they share the regions: at least once for each cut.
TEST(LodChain, GoesOnAfterAnExceptionOfProgress) {
  struct NoMore {};
  const TriangleMesh mesh = datasets::torus(1, 0.4, 80, 60);
  const std::vector<std::pair<int, int>> cases = {{1, 1}, {1, 2}, {1, 5}, {1, 12}, {1, 20}, {2, 1}, {2, 2}, {2, 3}};
  for (const auto& [threads, call] : cases) {
    SCOPED_TRACE(std::to_string(threads) + " threads, call " + std::to_string(call));
    int left = 0;
    LodOptions options;
    options.threads = threads;
    options.progress = [&](double) {
      if (--left == 0) throw NoMore();
    };
    LodChain chain(mesh, options);
    const LodLevel first = chain.next(0.002);
    left = call;
    EXPECT_THROW((void)chain.next(0.006), NoMore);
    for (const double tolerance : {0.006, 0.02}) {
      const LodLevel level = chain.next(tolerance);
      EXPECT_EQ(level.verdict, Verdict::Within);
      EXPECT_EQ(check_tolerance(mesh, level.mesh, tolerance).verdict, Verdict::Within);
      EXPECT_LT(level.faces(), first.faces());
    }
  }
}

TEST(LodChain, TakesBuffersOfAnEngine) {
  const TriangleMesh sphere = datasets::icosphere(1, 3);
  std::vector<float> positions;
  for (const Eigen::Vector3d& p : sphere.vertices)
    for (int i = 0; i < 3; ++i) positions.push_back(static_cast<float>(p[i]));
  std::vector<std::uint16_t> indices;
  for (const Triangle& t : sphere.triangles)
    for (const std::uint32_t v : t) indices.push_back(static_cast<std::uint16_t>(v));
  const MeshView view(positions.data(), sphere.vertices.size(), 3 * sizeof(float), indices.data(),
                      sphere.triangles.size());
  const std::size_t given =
      build_lod_chain(view, std::vector<double>{0.02}, one_thread(), [](std::size_t, LodLevel&& level) {
        EXPECT_LT(level.faces(), 600u);
        EXPECT_EQ(level.verdict, Verdict::Within);
        return true;
      });
  EXPECT_EQ(given, 1u);
}

#if defined(MESHBOUND_WITH_CGAL)
TEST(LodChain, TakesGraphsOfCgal) {
  const cgal::SurfaceMesh sphere = cgal::to_surface_mesh(datasets::icosphere(1, 3));
  const std::size_t given =
      cgal::build_lod_chain(sphere, std::vector<double>{0.02}, one_thread(), [](std::size_t, LodLevel&& level) {
        EXPECT_LT(level.faces(), 600u);
        EXPECT_EQ(level.verdict, Verdict::Within);
        return true;
      });
  EXPECT_EQ(given, 1u);
}
#endif

TEST(LodChain, IsDescribedBeforeItsFirstLevel) {
  const LodChain chain(datasets::icosphere(1, 2), one_thread());
  EXPECT_EQ(chain.describe().counts.tried, 0u);
}

TEST(LodChain, RefusesTolerancesThatDoNotGrowAndOptionsThatAreNotItsOwn) {
  const TriangleMesh sphere = datasets::icosphere(1, 1);
  const auto build = [&](const std::vector<double>& tolerances, const LodOptions& options) {
    build_lod_chain(sphere, tolerances, options, [](std::size_t, LodLevel&&) {
      ADD_FAILURE() << "a level was computed";
      return true;
    });
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const std::vector<double>& wrong : {std::vector<double>{0.2, 0.1}, {0.1, 0.1}, {-1}, {nan}, {0.1, nan}})
    EXPECT_THROW(build(wrong, one_thread()), InvalidInput);
  LodOptions options = one_thread();
  options.tolerance = 0.1;
  EXPECT_THROW(build({0.1}, options), InvalidInput);
  options = one_thread();
  options.time_limit = 0;
  options.locked_vertices = {true};
  EXPECT_THROW(build({0.1}, options), InvalidInput) << "also where no time is left";
  options = one_thread();
  options.target_faces = 10;
  EXPECT_THROW(build({0.1}, options), InvalidInput);
  EXPECT_EQ(build_lod_chain(sphere, {}, one_thread(), nullptr), 0u);
  EXPECT_THROW(build_lod_chain(sphere, std::vector<double>{0.1}, one_thread(), nullptr), InvalidInput);
  LodChain chain(sphere, one_thread());
  (void)chain.next(0.1);
  EXPECT_THROW((void)chain.next(0.05), InvalidInput);
}

}  // namespace lod_chain_test
}  // namespace meshbound
