// SPDX-License-Identifier: MIT
// Where the arithmetic is not the one that the bounds are proven for, no bound is given; coordinates at the ends of the
// range of doubles get a bound that holds or a clear refusal.
#include <gtest/gtest.h>
#include <omp.h>

#include <array>
#include <cfenv>
#include <cmath>
#include <random>

#include "mesh_files.h"
#include "meshbound/collapse_checker.h"
#include "meshbound/distance.h"
#include "meshbound/error.h"
#include "meshbound/floating_point_scope.h"
#include "meshbound/io.h"
#include "meshbound/tiles.h"
#include "reference/claims.h"
#include "reference/small_meshes.h"
#include "run_tool.h"
#include "tiles/certificate_in_tiles.h"
#include "tiles/decimate_in_tiles.h"

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace meshbound {
namespace floating_point_model_test {

using namespace reference;

/// The message with which a tree is refused; empty when one is built.
std::string refusal_of_a_tree() {
  const TriangleMesh mesh = cube(1);
  try {
    const Bvh tree(mesh);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

/// An engine has started the threads of OpenMP in another mode, and calls in the one that bounds need.
TEST(FloatingPointModel, ThreadsThatWereStartedInAnotherModeAnswerAsTheCallerDoes) {
  constexpr int threads = 3;
  const TriangleMesh mesh = moved(icosphere(4), {0.1, 0.2, 0.3});
  const Bvh tree(mesh, BvhOptions{1});
  std::mt19937 random(5);
  std::uniform_real_distribution<double> coordinate(-1.5, 1.5);
  std::vector<Eigen::Vector3d> queries(20000);
  for (Eigen::Vector3d& q : queries) q = {coordinate(random), coordinate(random), coordinate(random)};
  const std::vector<ClosestPoint> alone = closest_points(tree, queries, {1});
  for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
#pragma omp parallel num_threads(threads)
    if (omp_get_thread_num() != 0) std::fesetround(mode);
    const std::vector<ClosestPoint> shared = closest_points(tree, queries, {threads});
#pragma omp parallel num_threads(threads)
    std::fesetround(FE_TONEAREST);
    std::size_t different = 0;
    for (std::size_t i = 0; i < queries.size(); ++i)
      if (shared[i].distance.lower != alone[i].distance.lower || shared[i].distance.upper != alone[i].distance.upper ||
          shared[i].point.position != alone[i].point.position)
        ++different;
    EXPECT_EQ(different, 0U) << mode;
  }
}

#if defined(__SSE2__)
TEST(FloatingPointModel, FlushToZeroIsRefused) {
  const unsigned before = _mm_getcsr();
  constexpr unsigned flush_to_zero = 0x8000, denormals_are_zero = 0x0040;
  for (const unsigned mode : {flush_to_zero, denormals_are_zero, flush_to_zero | denormals_are_zero}) {
    _mm_setcsr(before | mode);
    const std::string reason = refusal_of_a_tree();
    _mm_setcsr(before);
    EXPECT_NE(reason.find("flushed to zero"), std::string::npos) << reason;
  }
  EXPECT_EQ(refusal_of_a_tree(), "");
}

/// Trees may have been built before, or are not needed.
TEST(FloatingPointModel, FlushToZeroIsRefusedByEveryQuestion) {
  const TriangleMesh mesh = cube(1);
  TriangleMesh moved = mesh;
  for (Eigen::Vector3d& p : moved.vertices) p.x() += 3e-310;
  Bvh tree(mesh);
  const Bvh other(cube(2));
  CollapseChecker checker(mesh, 0.1);
  const unsigned before = _mm_getcsr();
  const auto refuses = [&](const char* what, const auto& question) {
    bool is_refused = false;
    _mm_setcsr(before | 0x8040);  // both: to zero, and from zero
    try {
      question();
    } catch (const Error&) {
      is_refused = true;
    }
    _mm_setcsr(before);
    EXPECT_TRUE(is_refused) << what;
  };
  refuses("trees", [&] { (void)hausdorff_distance(tree, other); });
  refuses("meshes", [&] { (void)hausdorff_distance(mesh, moved); });
  refuses("check", [&] { (void)check_tolerance(mesh, moved, 0); });
  refuses("same", [&] { (void)same_surface(mesh, moved); });
  refuses("closest", [&] { (void)closest_point(tree, {1, 2, 3}); });
  refuses("refit", [&] { tree.refit(moved); });
  refuses("admits", [&] { (void)checker.admits(0, 1, mesh.vertices[1]); });
  // There is no time for a tile, and so for its tree.
  DistanceOptions distance;
  distance.budget.seconds = 0;
  refuses("tiles", [&] { (void)hausdorff_distance_in_tiles(mesh, moved, distance); });
  refuses("tiles, one side", [&] { (void)one_sided_hausdorff_distance_in_tiles(mesh, moved, distance); });
  SimplifyOptions simplification;
  simplification.tolerance = 0.1;
  simplification.time_limit = 0;
  ThreadRunner runner(1);
  refuses("simplify", [&] { (void)decimate_in_tiles(MeshInMemory(mesh), simplification, {}, runner); });
  CertificateOptions certificate;
  certificate.seconds = 0;
  refuses("certify",
          [&] { (void)certify_in_tiles(MeshInMemory(mesh), MeshInMemory(moved), 0.1, certificate, {}, runner); });
  refuses("placement", [&] { (void)checker.admitted_placement(0, 1, mesh.vertices[1]); });
}

/// Flush-to-zero as it is on each thread of an engine: before, within and after a scope.
template <int threads, class MakeScope>
void expect_scope_gives_all_threads_the_mode_of_bounds(const MakeScope& make_scope) {
  constexpr unsigned flush_to_zero = 0x8000;
  const unsigned before = _mm_getcsr();
  std::array<unsigned, threads> inside{}, after{};
#pragma omp parallel num_threads(threads)
  _mm_setcsr(before | flush_to_zero);
  _mm_setcsr(before | flush_to_zero);  // clang's OpenMP gives the caller its mode back after a region
  {
    const FloatingPointScope scope = make_scope();
    EXPECT_EQ(refusal_of_a_tree(), "");
#pragma omp parallel num_threads(threads)
    inside[static_cast<std::size_t>(omp_get_thread_num())] = _mm_getcsr() & flush_to_zero;
  }
#pragma omp parallel num_threads(threads)
  {
    after[static_cast<std::size_t>(omp_get_thread_num())] = _mm_getcsr() & flush_to_zero;
    _mm_setcsr(before);
  }
  _mm_setcsr(before);
  for (const unsigned mode : inside) EXPECT_EQ(mode, 0u);
  for (const unsigned mode : after) EXPECT_EQ(mode, flush_to_zero);
}

TEST(FloatingPointModel, ScopeGivesTheThreadsOfAnEngineTheModeThatBoundsNeed) {
  const int threads_before = omp_get_max_threads();
  omp_set_num_threads(3);
  expect_scope_gives_all_threads_the_mode_of_bounds<3>([] { return FloatingPointScope(); });
  omp_set_num_threads(1);
  expect_scope_gives_all_threads_the_mode_of_bounds<3>([] { return FloatingPointScope(3); });
  omp_set_num_threads(threads_before);
}
#endif

TEST(FloatingPointModel, AnotherRoundingModeIsRefused) {
  for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
    ASSERT_EQ(std::fesetround(mode), 0);
    const std::string reason = refusal_of_a_tree();
    std::fesetround(FE_TONEAREST);
    EXPECT_NE(reason.find("rounding mode"), std::string::npos) << reason;
  }
  EXPECT_EQ(refusal_of_a_tree(), "");
}

#if defined(__x86_64__)
TEST(FloatingPointModel, AProgramLinkedWithFastMathIsRefused) {
  const testing_tools::ToolRun run = testing_tools::run_tool(FAST_MATH_PROGRAM, {});
  EXPECT_EQ(run.exit_code, 2) << "this linker sets no flush to zero for -ffast-math";
  EXPECT_NE(run.err.find("flushed to zero"), std::string::npos) << run.err;
}
#endif

#if defined(CONTRACTING_PROGRAM)
TEST(FloatingPointModel, FusedMultiplyAddsAreRefused) {
  if (!__builtin_cpu_supports("fma")) GTEST_SKIP() << "this processor has no fused multiply-add";
  const testing_tools::ToolRun run = testing_tools::run_tool(CONTRACTING_PROGRAM, {});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.err.find("fused"), std::string::npos) << run.err;
}
#endif

TEST(FloatingPointModel, DoesNotCompileWithFastMath) {
  const std::string source = MESHBOUND_SOURCE_DIR "/src/numeric/floating_point_model.cpp";
  const std::vector<std::string> plain = {"-std=c++20", "-fsyntax-only", "-I" MESHBOUND_SOURCE_DIR "/src",
                                          "-I" MESHBOUND_SOURCE_DIR "/include", source};
  std::vector<std::string> fast = plain;
  fast.emplace_back("-ffast-math");
  EXPECT_EQ(testing_tools::run_tool(COMPILER, plain).exit_code, 0);
  const testing_tools::ToolRun refused = testing_tools::run_tool(COMPILER, fast);
  EXPECT_NE(refused.exit_code, 0);
  EXPECT_NE(refused.err.find("without -ffast-math"), std::string::npos) << refused.err;
}

TEST(CoordinateRange, BoundsHoldAtItsEnds) {
  for (const double scale : {5e-324, 1e-320, 1e-310, 1e-300, 1e-160, 1e155, 1e300, largest_coordinate / 2}) {
    SCOPED_TRACE(scale);
    const TriangleMesh a = scaled(cube(1), scale), b = scaled(cube(2), scale);
    for (const Method method : {Method::CellWalking, Method::CrossCulling}) {
      DistanceOptions options;
      options.method = method;
      const HausdorffDistance result = hausdorff_distance(Bvh(a), Bvh(b), options);
      // Furthest is a corner of the larger cube; the distance to one triangle is largest at a corner.
      const ExactLength truth = exact_distance(b.vertices[0], a);
      EXPECT_GE(truth.compare(result.bounds.lower), 0);
      EXPECT_LE(truth.compare(result.bounds.upper), 0);
      EXPECT_TRUE(std::isfinite(result.bounds.upper));
    }
  }
}

TEST(CoordinateRange, BoundsHoldBetweenMeshesFromBothEnds) {
  const TriangleMesh small = scaled(cube(1), 1e-310), large = scaled(cube(1), 1e300);
  for (const auto& [a, b] : {std::pair(small, large), std::pair(large, small)}) {
    const OneSidedDistance result = one_sided_hausdorff_distance(Bvh(a), Bvh(b));
    ExactLength smallest = exact_distance(a.vertices[0], b);
    for (const Eigen::Vector3d& v : a.vertices) smallest = std::max(smallest, exact_distance(v, b));
    EXPECT_LE(smallest.compare(result.bounds.upper), 0);
    EXPECT_LE(result.bounds.lower, result.bounds.upper);
    EXPECT_LE(result.bounds.lower, 1e300 * 1.7320508075688774);
  }
}

/// In units of a model of size 2^900 a coordinate of 1e-318 is nothing, but the meshes are not the same for that.
TEST(CoordinateRange, MeshesThatDifferByWhatUnderflowsAreNotIdentical) {
  const Eigen::Vector3d far(0x1p900, 0, 0);
  const TriangleMesh a = single_triangle({0, 1e-318, 0}, far, {0, 0x1p900, 0}),
                     b = single_triangle({0, 0, 0}, far, {0, 0x1p900, 0});
  const TriangleMesh flat = single_triangle({0, 0, 1e-318}, far, far), line = single_triangle({0, 0, 0}, far, far);
  for (const auto& [x, y] : {std::pair(a, b), std::pair(flat, line)}) {
    const HausdorffDistance result = hausdorff_distance(Bvh(x), Bvh(y));
    EXPECT_LE(exact_distance(x.vertices[0], y).compare(result.a_to_b.bounds.upper), 0);
    EXPECT_LE(exact_distance(y.vertices[0], x).compare(result.b_to_a.bounds.upper), 0);
  }
}

TEST(CoordinateRange, WhatIsBeyondItIsRefused) {
  for (const double beyond : {1e302, 1.7e308, std::numeric_limits<double>::infinity(), std::nan("")}) {
    TriangleMesh mesh = cube(1);
    mesh.vertices[3].y() = beyond;
    EXPECT_THROW(Bvh{mesh}, InvalidInput);
  }
  for (const std::string coordinate : {"1e302", "1e999", "-1e308", "inf", "nan"}) {
    const std::string file = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 " + coordinate + " 0\n3 0 1 2\n";
    EXPECT_CONTAINS(test::refusal("mesh.off", file), "line ");
  }
  // Smaller than the smallest denormal is 0, to the nearest double: what the file says is what is measured.
  EXPECT_EQ(test::read_content("mesh.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1e-400 0\n3 0 1 2\n").mesh.vertices[2].y(), 0);
}

}  // namespace floating_point_model_test
}  // namespace meshbound
