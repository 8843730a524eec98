// SPDX-License-Identifier: MIT
#include "simplify/stray_faces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "decimation_states.h"
#include "reference/small_meshes.h"

namespace meshbound {
namespace stray_faces_test {

constexpr double tolerance = 1.0 / 40;

/// A sheet with a fold at x = 0.5 between x = 0.25 and 0.75, and the mesh without the fold: its vertices there are
/// moved to the foot, so that edges of twenty tolerances pass below it with both ends in place.
struct Unfolded {
  explicit Unfolded(double height) : state(folded(height)) {
    state->grow_tolerance(tolerance);
    state->set_samples(tolerance);
    ArrayMesh& mesh = state->mesh;
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
      if (const Vec3 p = mesh.position(v); is_fold(p.x)) mesh.move(v, {0.74, p.y, 0.04 * height});
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) state->last_changes.set(v, 1);
    faces.resize(mesh.face_count());
    std::iota(faces.begin(), faces.end(), 0);
  }
  static bool is_fold(double x) { return std::abs(x - 0.5) < 0.01; }
  static TriangleMesh folded(double height) {
    TriangleMesh mesh = reference::unit_square(4);
    for (Eigen::Vector3d& p : mesh.vertices)
      if (is_fold(p.x())) p.z() = height;
    return mesh;
  }
  [[nodiscard]] std::vector<std::uint32_t> strays(int threads = 1) {
    DecimationThreads of_run(*state, threads);
    return stray_faces(*state, faces, of_run, {});
  }
  [[nodiscard]] bool passes_below(std::uint32_t face) const {
    const auto corners = state->mesh.triangle(face);
    const auto [low, high] = std::minmax({corners[0].x, corners[1].x, corners[2].x});
    return low < 0.5 && high > 0.5;
  }
  test::StateOf state;
  std::vector<std::uint32_t> faces;
};

TEST(StrayFaces, HaveLongEdgesFarFromTheOriginal) {
  Unfolded high(2 * tolerance), low(0.8 * tolerance);
  const std::vector<std::uint32_t> strays = high.strays();
  // Each of the nine edges below the fold is looked at from one of its eight faces.
  EXPECT_GE(strays.size(), 4u);
  for (const std::uint32_t f : strays) EXPECT_TRUE(high.passes_below(f)) << f;
  EXPECT_EQ(high.strays(2), strays);
  EXPECT_TRUE(low.strays().empty());
}

TEST(StrayFaces, AreUnproven) {
  Unfolded it(2 * tolerance);
  const std::vector<std::uint32_t> strays = it.strays();
  ASSERT_FALSE(strays.empty());
  it.state->is_fixed[strays.front()] = 1;
  EXPECT_EQ(it.strays(), std::vector<std::uint32_t>(strays.begin() + 1, strays.end()));
  it.faces = {strays.back()};
  EXPECT_EQ(it.strays(), it.faces);
}

TEST(StrayFaces, AreNotLookedForOnceARunIsStopped) {
  Unfolded it(2 * tolerance);
  DecimationThreads threads(*it.state, 1);
  const StopToken stopped = StopToken().until(StopToken::Clock::now(), 0);
  EXPECT_THROW((void)stray_faces(*it.state, it.faces, threads, stopped), Stopped);
}

}  // namespace stray_faces_test
}  // namespace meshbound
