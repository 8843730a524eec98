// SPDX-License-Identifier: GPL-3.0-or-later
// Borders, creases and given edges stay within the line tolerance of where they were, both ways, and vertices of lines
// stand only where the original has vertices of lines.
#include "simplify/mesh/feature_lines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <random>
#include <set>

#include "datasets.h"
#include "datasets/analytic_meshes.h"
#include "drivers.h"
#include "meshbound/bvh.h"
#include "meshbound/error.h"
#include "meshbound/io.h"
#include "meshbound/mesh_summary.h"
#include "numeric/no_index.h"
#include "simplify/mesh/indexed_manifold.h"
#include "simplify_options.h"

namespace meshbound {
namespace feature_lines_test {

using Point = std::array<double, 3>;
using test::within;

Point point(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

/// n x n squares of the plane z = 0, of side 1 / n, and a tooth of this height in the middle of one border.
TriangleMesh sheet_with_tooth(std::uint32_t n, double height) {
  TriangleMesh mesh;
  for (std::uint32_t y = 0; y <= n; ++y)
    for (std::uint32_t x = 0; x <= n; ++x)
      mesh.vertices.emplace_back(x / static_cast<double>(n),
                                 y / static_cast<double>(n) - (y == 0 && x == n / 2 ? height : 0), 0);
  for (std::uint32_t y = 0; y < n; ++y) {
    for (std::uint32_t x = 0; x < n; ++x) {
      const std::uint32_t a = y * (n + 1) + x, b = a + 1, c = a + n + 1, d = c + 1;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
  }
  return mesh;
}

bool has_point(const TriangleMesh& mesh, const Eigen::Vector3d& p) {
  return std::any_of(mesh.vertices.begin(), mesh.vertices.end(), [&](const auto& q) { return q == p; });
}

/// Edges with one triangle.
std::set<std::set<Point>> border_of(const TriangleMesh& mesh) {
  std::set<std::set<Point>> border;
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::set<Point> edge = {point(mesh.vertices[t[k]]), point(mesh.vertices[t[(k + 1) % 3]])};
      if (!border.insert(edge).second) border.erase(edge);
    }
  }
  return border;
}

std::set<std::set<Point>> edges_at(const TriangleMesh& mesh, const std::vector<Edge>& edges) {
  std::set<std::set<Point>> points;
  for (const auto& [a, b] : edges) points.insert({point(mesh.vertices[a]), point(mesh.vertices[b])});
  return points;
}

double distance_to_segment(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const double squared = (b - a).squaredNorm();
  const double share = squared > 0 ? std::clamp((p - a).dot(b - a) / squared, 0.0, 1.0) : 0;
  return (p - (a + share * (b - a))).norm();
}

/// By other code than what gave the verdict: both ways, with points between the vertices of each line.
void expect_lines_within(const TriangleMesh& original, const std::vector<Edge>& lines, const SimplifiedLevel& level,
                         double tolerance) {
  const TriangleMesh a = line_mesh(original, lines), b = line_mesh(level.mesh, level.lines);
  const auto largest = [](const TriangleMesh& from, const TriangleMesh& to) {
    double distance = 0;
    for (const Triangle& t : from.triangles) {
      for (int k = 0; k <= 8; ++k) {
        const Eigen::Vector3d p = from.vertices[t[0]] + k / 8.0 * (from.vertices[t[1]] - from.vertices[t[0]]);
        double nearest = HUGE_VAL;
        for (const Triangle& s : to.triangles)
          nearest = std::min(nearest, distance_to_segment(p, to.vertices[s[0]], to.vertices[s[1]]));
        distance = std::max(distance, nearest);
      }
    }
    return distance;
  };
  EXPECT_LE(largest(a, b), tolerance * (1 + 1e-9));
  EXPECT_LE(largest(b, a), tolerance * (1 + 1e-9));
}

TEST(FeatureLines, KeepAToothOfTheBorderThatIsHigherThanTheLineTolerance) {
  const double height = 0.02;
  const TriangleMesh sheet = sheet_with_tooth(16, height);
  const Eigen::Vector3d tooth = sheet.vertices[8];
  for (const auto& [name, driver] : test::drivers()) {
    SimplifyOptions options = within(0.1, driver);
    options.line_tolerance = 0.95 * height;
    const SimplifyResult kept = simplify_with_bound(sheet, options);
    EXPECT_EQ(kept.last().verdict, Verdict::Within);
    EXPECT_TRUE(has_point(kept.last().mesh, tooth)) << name;
    EXPECT_EQ(edges_at(kept.last().mesh, kept.last().lines), border_of(kept.last().mesh)) << name;
    EXPECT_EQ(kept.lines.size(), 64U);
    expect_lines_within(sheet, kept.lines, kept.last(), *options.line_tolerance);
    options.line_tolerance = 1.05 * height;
    const SimplifyResult cut = simplify_with_bound(sheet, options);
    EXPECT_EQ(cut.last().verdict, Verdict::Within);
    EXPECT_FALSE(has_point(cut.last().mesh, tooth)) << name;
    EXPECT_NEAR(cut.last().line_distance->bounds.upper, height, 1e-3 * height) << name;
    EXPECT_LE(cut.last().faces(), 4U);
  }
}

TEST(FeatureLines, OfACubeAreItsEdges) {
  const TriangleMesh cube = datasets::cube(1, 6);
  SimplifyOptions options = within(0.3);
  options.feature_angle = std::numbers::pi / 4;
  options.line_tolerance = 0.01;
  const SimplifyResult result = simplify_with_bound(cube, options);
  EXPECT_EQ(result.lines.size(), 12U * 6);
  EXPECT_EQ(result.last().verdict, Verdict::Within);
  EXPECT_EQ(result.last().faces(), 12U);
  EXPECT_EQ(result.last().lines.size(), 12U);
  EXPECT_EQ(result.last().line_distance->bounds.lower, 0);
  EXPECT_EQ(result.locked_vertices, 0U);
}

/// A line of the user's across a flat sheet: nothing but the option keeps it.
TEST(FeatureLines, FollowGivenEdges) {
  const std::uint32_t n = 16;
  const TriangleMesh sheet = sheet_with_tooth(n, 0);
  SimplifyOptions options = within(0.2);
  for (std::uint32_t k = 0; k < n / 2; ++k)  // a stair along diagonals and horizontals
    options.feature_edges.push_back({k * (n + 1) + k, (k + 1) * (n + 1) + k + 1});
  for (std::uint32_t x = n / 2; x < n; ++x)
    options.feature_edges.push_back({n / 2 * (n + 1) + x, n / 2 * (n + 1) + x + 1});
  options.line_tolerance = 0.01;
  for (const auto& [name, driver] : test::drivers()) {
    options.driver = driver;
    const SimplifyResult result = simplify_with_bound(sheet, options);
    const SimplifiedLevel& level = result.last();
    EXPECT_EQ(level.verdict, Verdict::Within);
    expect_lines_within(sheet, result.lines, level, 0.01);
    EXPECT_TRUE(has_point(level.mesh, {0.5, 0.5, 0})) << "the bend, " << name;
    EXPECT_TRUE(has_point(level.mesh, {1, 0.5, 0})) << "where it meets the border, " << name;
    EXPECT_LE(level.lines.size(), 10U) << name;
    EXPECT_LE(level.faces(), 10U) << name;
  }
  options.feature_edges = {{0, 9999}};
  EXPECT_THROW((void)simplify_with_bound(sheet, options), InvalidInput);
}

TEST(FeatureLines, BoundEveryLevelForEveryEffortAndNumberOfThreads) {
  const TriangleMesh terrain = datasets::terrain(1, 60, 5);
  SimplifyOptions options = within(0.02);
  options.levels = {0.004};
  options.line_tolerance = 0.003;
  options.feature_angle = 0.5;
  for (const Effort effort : {Effort::Normal, Effort::High}) {
    options.effort = effort;
    options.threads = 1;
    const SimplifyResult result = simplify_with_bound(terrain, options);
    EXPECT_GT(result.lines.size(), 4U * 60);
    for (const SimplifiedLevel& level : result.levels) {
      EXPECT_EQ(level.verdict, Verdict::Within);
      EXPECT_LE(level.line_distance->bounds.upper, 0.003);
      EXPECT_LT(level.lines.size(), result.lines.size());
      expect_lines_within(terrain, result.lines, level, 0.003);
    }
    options.threads = 2;
    const SimplifyResult other = simplify_with_bound(terrain, options);
    EXPECT_TRUE(other.last().mesh.vertices == result.last().mesh.vertices);
    EXPECT_EQ(other.last().lines, result.last().lines);
  }
}

/// Collapses in any order, taken back in reverse order, leave the lines as they were.
TEST(FeatureLines, AreAsBeforeWhenCollapsesAreTakenBack) {
  const TriangleMesh sheet = sheet_with_tooth(6, 0.01);
  ArrayMesh mesh = indexed_manifold(sheet);
  FeatureLines lines(mesh, std::vector<std::uint8_t>(3 * mesh.face_count(), 0));
  const auto state = [&] {
    std::vector<std::uint32_t> all;
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) all.push_back(mesh.is_vertex(v) ? lines.at(v) : 0);
    for (Corner c = 0; c < 3 * mesh.face_count(); ++c)
      all.push_back(!mesh.is_removed(c / 3) && lines.is_line(mesh, c) ? 1 : 0);
    return all;
  };
  const std::vector<std::uint32_t> before = state();
  const std::uint32_t tooth = 3, left = 2, right = 4;
  Corner edge = no_index;
  for (Corner c = 0; c < 3 * mesh.face_count(); ++c)
    if (mesh.start(c) == left && mesh.end(c) == tooth) edge = c;
  ASSERT_NE(edge, no_index);
  ASSERT_EQ(lines.allowed(mesh, edge), OnLines::AtEitherEnd);
  // Without the tooth the line from `left` to `right` passes it at its height; without `left` the one from the tooth to
  // the vertex before passes `left` at that height's share.
  EXPECT_NEAR(std::sqrt(lines.squared_deviation(mesh, edge, true)), 0.01, 1e-12);
  EXPECT_LT(lines.squared_deviation(mesh, edge, false), 0.01 * 0.01);
  const FeatureLines::Before kept = lines.before(mesh, edge);
  const Vec3 position = mesh.position(left);
  lines.collapse(mesh, edge, mesh.position(tooth));
  mesh.collapse(edge);
  mesh.move(left, {0.5, -0.01, 0});
  EXPECT_EQ(lines.at(left), tooth);
  EXPECT_NE(state(), before);
  mesh.undo_collapse(edge);
  mesh.move(left, position);
  lines.undo_collapse(mesh, edge, kept);
  EXPECT_EQ(state(), before);
  EXPECT_TRUE(lines.is_on_line(right));
}

TEST(SubsetPlacements, PutEveryVertexWhereTheOriginalHasItsSource) {
  const TriangleMesh torus = datasets::torus(1, 0.3, 80, 32);
  for (const auto& [name, driver] : test::drivers()) {
    SimplifyOptions options = within(0.02, driver);
    const std::size_t anywhere = simplify_with_bound(torus, options).last().faces();
    options.placements = CollapsePlacements::Subset;
    options.levels = {0.005, 0.01};
    for (const Effort effort : {Effort::Normal, Effort::High}) {
      options.effort = effort;
      const SimplifyResult result = simplify_with_bound(torus, options);
      for (const SimplifiedLevel& level : result.levels) {
        EXPECT_EQ(level.verdict, Verdict::Within) << name;
        for (std::size_t v = 0; v < level.mesh.vertices.size(); ++v)
          ASSERT_EQ(level.mesh.vertices[v], torus.vertices[level.source_vertex[v]]) << name;
      }
      EXPECT_GE(result.last().faces(), anywhere);
      EXPECT_LT(result.last().faces(), torus.triangles.size() / 5) << name;
    }
  }
}

TEST(FeatureLines, OfRealMeshesStayWithinATenthOfTheTolerance) {
  std::size_t found = 0;
  for (const char* const folder : {"cad", "game", "organic"}) {
    std::size_t of_folder = 0;
    for (const std::filesystem::path& file : test::datasets_in(folder)) {
      const TriangleMesh mesh = read_mesh(file).mesh;
      if (mesh.triangles.size() < 200 || mesh.triangles.size() > 6000 || ++of_folder > 3) continue;
      const double diagonal = bounding_box_diagonal(mesh);
      ++found;
      for (const auto& [name, driver] : test::drivers()) {
        SimplifyOptions options = within(0.003 * diagonal, driver);
        options.line_tolerance = 0.0003 * diagonal;
        options.feature_angle = 0.6;
        const SimplifyResult result = simplify_with_bound(mesh, options);
        EXPECT_EQ(result.last().verdict, Verdict::Within) << file << name;
        EXPECT_EQ(result.last().line_distance.has_value(), !result.lines.empty()) << file << name;
        if (!result.lines.empty()) expect_lines_within(mesh, result.lines, result.last(), *options.line_tolerance);
      }
    }
  }
  if (found == 0) GTEST_SKIP() << "no real meshes on this machine";
}

}  // namespace feature_lines_test
}  // namespace meshbound
