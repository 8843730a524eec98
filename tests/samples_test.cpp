// SPDX-License-Identifier: MIT
// Samples of an original know their place on it: the vertices, and points in equal steps along its edges.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <vector>

#include "datasets/analytic_meshes.h"
#include "decimation_states.h"
#include "geometry/boxes.h"
#include "numeric/no_index.h"

namespace meshbound {
namespace samples_test {

using Point = std::array<double, 3>;

Point point(Vec3 p) { return {p.x, p.y, p.z}; }

/// Every third triangle runs the other way, which a state turns over.
TriangleMesh with_turned_triangles(TriangleMesh mesh) {
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
  return mesh;
}

/// Edges of lengths from a third of the spacing to five times as long.
TriangleMesh cylinder() { return datasets::cylinder(1, 1.7, 40); }
constexpr double spacing = 0.35;

std::set<std::array<std::uint32_t, 2>> edges_of(const TriangleMesh& mesh) {
  std::set<std::array<std::uint32_t, 2>> edges;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) edges.insert({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])});
  return edges;
}

/// The vertices, and on each edge the points that leave no more than the spacing between them, three at most. Rounded,
/// as the way from either end gives them.
std::vector<Point> expected_points(const TriangleMesh& mesh) {
  std::vector<Point> points;
  for (const Eigen::Vector3d& p : mesh.vertices) points.push_back({p.x(), p.y(), p.z()});
  for (const auto& [a, b] : edges_of(mesh)) {
    const Eigen::Vector3d p = mesh.vertices[a], q = mesh.vertices[b];
    const int count = std::min(3, static_cast<int>((q - p).norm() / spacing));
    for (int k = 1; k <= count; ++k) {
      const Eigen::Vector3d at = p + double(k) / (count + 1) * (q - p);
      points.push_back({at.x(), at.y(), at.z()});
    }
  }
  return points;
}

std::vector<Point> rounded(std::vector<Point> points) {
  for (Point& p : points)
    for (double& x : p) x = std::round(x * 0x1p40) * 0x1p-40 + 0.0;
  std::sort(points.begin(), points.end());
  return points;
}

std::vector<Point> points_of(const Samples& samples) {
  std::vector<Point> points;
  for (std::uint32_t s = 0; s < samples.size(); ++s) points.push_back(point(samples.at(s)));
  return points;
}

void expect_on_their_triangles(const Samples& samples, const DecimationState& state) {
  for (std::uint32_t s = 0; s < samples.size(); ++s) {
    const Triangle& t = state.triangles[samples.triangle_near(s)];
    double least = HUGE_VAL;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 p = state.vertices[t[k]], way = state.vertices[t[(k + 1) % 3]] - p, offset = samples.at(s) - p;
      const double share = std::clamp(dot(offset, way) / squared_length(way), 0.0, 1.0);
      least = std::min(least, length(offset - share * way));
    }
    EXPECT_LT(least, 1e-12) << "sample " << s;
  }
}

TEST(Samples, AreTheVerticesAndPointsAlongLongEdges) {
  for (const TriangleMesh& mesh : {cylinder(), with_turned_triangles(cylinder())}) {
    test::StateOf state(mesh);
    state->set_samples(spacing / DecimationState::spacing_of_samples);
    const Samples& samples = state->samples;
    for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
      const Eigen::Vector3d& p = mesh.vertices[v];
      EXPECT_EQ(point(samples.at(v)), (Point{p.x(), p.y(), p.z()}));
    }
    EXPECT_GT(samples.size(), 2 * mesh.vertices.size());
    EXPECT_EQ(rounded(points_of(samples)), rounded(expected_points(mesh)));
    expect_on_their_triangles(samples, *state);
  }
}

TEST(Samples, AreTheSameForAnyNumberOfThreads) {
  test::StateOf one(datasets::terrain(1, 100, 3)), three(datasets::terrain(1, 100, 3));
  one->set_samples(1e-3, 1);
  three->set_samples(1e-3, 3);
  ASSERT_EQ(one->samples.size(), three->samples.size());
  for (std::uint32_t s = 0; s < one->samples.size(); ++s) {
    EXPECT_EQ(point(one->samples.at(s)), point(three->samples.at(s)));
    EXPECT_EQ(one->samples.following(s), three->samples.following(s));
  }
}

/// On the original itself the faces that cover a triangle are that triangle, so that the samples are the same points.
TEST(Samples, OfAMeshThatIsNoLongerTheOriginalLieOnTheOriginalToo) {
  const TriangleMesh mesh = with_turned_triangles(cylinder());
  test::StateOf state(mesh);
  const Samples samples(state->vertices, state->triangles, state->mesh, state->neighbours, state->cover,
                        spacing / DecimationState::spacing_of_samples);
  EXPECT_EQ(rounded(points_of(samples)), rounded(expected_points(mesh)));
  expect_on_their_triangles(samples, *state);
  for (std::uint32_t s = 0; s < samples.size(); ++s) {
    const std::uint32_t face = samples.face_of(s);
    ASSERT_NE(face, no_index);
    EXPECT_LT(squared_distance(state->mesh.triangle(face), samples.at(s)), 1e-24);
  }
}

}  // namespace samples_test
}  // namespace meshbound
