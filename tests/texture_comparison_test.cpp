// SPDX-License-Identifier: MIT
// Texture deviation measured again after a small change: as if it were measured anew, with less work.
#include "texture/texture_comparison.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <set>

#include "meshbound/error.h"

namespace meshbound {
namespace texture_comparison_test {

using Random = std::mt19937_64;

constexpr double error_bound = 1e-6, tolerance = 0.05;

TextureDeviationOptions options() {
  TextureDeviationOptions options;
  options.error_bound = error_bound;
  options.tolerance = tolerance;
  options.threads = 1;
  return options;
}

TexturedMesh numbered(TexturedMesh mesh) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) mesh.triangles[t].triangle = static_cast<std::uint32_t>(t);
  return mesh;
}

using Height = std::function<double(double s, double t)>;

/// 16 x 16 squares of the unit square, cut into triangles, above which the surface has this height.
TexturedMesh sheet(const Height& height) {
  constexpr int n = 16;
  TexturedMesh mesh;
  const auto add = [&](const std::array<std::array<int, 2>, 3>& corners) {
    TexturedTriangle& triangle = mesh.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const double s = corners[k][0] / static_cast<double>(n), t = corners[k][1] / static_cast<double>(n);
      triangle.corners[k] = {s, t, height(s, t)};
      triangle.coordinates[k] = {s, t};
    }
  };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      add({{{i, j}, {i + 1, j}, {i + 1, j + 1}}});
      add({{{i, j}, {i + 1, j + 1}, {i, j + 1}}});
    }
  return numbered(mesh);
}

TexturedMesh flat() {
  return sheet([](double, double) { return 0; });
}

TexturedMesh joined(TexturedMesh a, const TexturedMesh& b) {
  a.triangles.insert(a.triangles.end(), b.triangles.begin(), b.triangles.end());
  return numbered(a);
}

void expect_value(const Bounds& bounds, double value) {
  EXPECT_LE(bounds.lower, value + 1e-12);
  EXPECT_GE(bounds.upper, value - 1e-12);
  EXPECT_LE(bounds.upper - bounds.lower, error_bound);
}

double wave(double s, double t) { return 0.01 + 0.01 * s * t; }

TEST(TextureComparison, MeasuresOnlyAroundAChange) {
  const TexturedMesh a = flat();
  TextureComparison comparison;
  expect_value(comparison.measure({a, sheet(wave)}, options()).bounds, 0.02);
  const TexturedMesh raised = sheet([](double s, double t) { return s == 0.5 && t == 0.5 ? 0.04 : wave(s, t); });
  const TextureDeviation again = comparison.measure({a, raised}, options()),
                         anew = texture_deviation(a, raised, options());
  expect_value(again.bounds, 0.04);
  expect_value(anew.bounds, 0.04);
  EXPECT_LT(2 * again.a_to_b.pairs, anew.a_to_b.pairs);
  EXPECT_LT(2 * again.b_to_a.pairs, anew.b_to_a.pairs);
}

/// Two sheets, one far above the other, with the same texture coordinates.
TexturedMesh storeys(const TexturedMesh& below, const Height& above) {
  return joined(below, sheet([&](double s, double t) { return 1 + above(s, t); }));
}

/// What changes high above is nearest to nothing below, though it has the same coordinates.
TEST(TextureComparison, MeasuresOnlyNearAChangeInSpace) {
  const TexturedMesh a = storeys(flat(), [](double, double) { return 0; });
  TextureComparison comparison;
  expect_value(comparison.measure({a, storeys(sheet(wave), wave)}, options()).bounds, 0.02);
  const TexturedMesh b = storeys(sheet(wave), [](double s, double t) { return 0.005 + wave(s, t); });
  const TextureDeviation again = comparison.measure({a, b}, options()), anew = texture_deviation(a, b, options());
  expect_value(again.bounds, 0.025);
  expect_value(anew.bounds, 0.025);
  EXPECT_LT(3 * again.a_to_b.pairs, 2 * anew.a_to_b.pairs);
}

double bump(double s, double t) { return s == 0.5 && t == 0.5 ? 0.045 : wave(s, t); }

/// Takes the triangles at the bump out of the sheet.
TexturedMesh without_bump(TexturedMesh sheet) {
  std::erase_if(sheet.triangles, [](const TexturedTriangle& t) {
    return std::any_of(t.coordinates.begin(), t.coordinates.end(),
                       [](const Eigen::Vector2d& uv) { return uv == Eigen::Vector2d(0.5, 0.5); });
  });
  return numbered(sheet);
}

/// Near triangles hide the bump and go again: those below have not changed, but what is known of them no longer holds.
TEST(TextureComparison, SeesWhatGoes) {
  TextureComparison comparison;
  expect_value(comparison.measure({flat(), joined(sheet(bump), sheet(wave))}, options()).a_to_b.bounds, 0.02);
  expect_value(comparison.measure({flat(), sheet(bump)}, options()).a_to_b.bounds, 0.045);
}

/// What was uncovered, and so had no distance, is covered by far triangles.
TEST(TextureComparison, SeesWhatComes) {
  TextureComparison comparison;
  const TextureDeviation open = comparison.measure({flat(), without_bump(sheet(bump))}, options());
  expect_value(open.a_to_b.bounds, 0.02);
  EXPECT_NEAR(open.a_to_b.uncovered.lower, 6.0 / 512, 1e-9);
  const TextureDeviation closed = comparison.measure({flat(), sheet(bump)}, options());
  expect_value(closed.a_to_b.bounds, 0.045);
  EXPECT_LE(closed.a_to_b.uncovered.upper, 1e-9);
}

TEST(TextureComparison, RemembersWhatIsUncovered) {
  TextureComparison comparison;
  TexturedMesh b = without_bump(sheet(bump));
  EXPECT_NEAR(comparison.measure({flat(), b}, options()).a_to_b.uncovered.upper, 6.0 / 512, 1e-9);
  b.triangles.pop_back();
  EXPECT_NEAR(comparison.measure({flat(), b}, options()).a_to_b.uncovered.upper, 7.0 / 512, 1e-9);
}

TEST(TextureComparison, RepeatsTheResultForEqualMeshes) {
  TextureComparison comparison;
  const TextureDeviation first = comparison.measure({flat(), sheet(wave)}, options()),
                         second = comparison.measure({flat(), sheet(wave)}, options());
  EXPECT_EQ(first.bounds.lower, second.bounds.lower);
  EXPECT_EQ(first.bounds.upper, second.bounds.upper);
  EXPECT_EQ(first.a_to_b.pairs, second.a_to_b.pairs);
}

/// Triangles that both meshes have need no look, in whatever order their corners come.
TEST(TextureComparison, KnowsEqualTriangles) {
  const TexturedMesh a = flat();
  TexturedMesh b = a;
  for (TexturedTriangle& t : b.triangles) {
    std::swap(t.corners[0], t.corners[2]);
    std::swap(t.coordinates[0], t.coordinates[2]);
  }
  const TextureDeviation found = texture_deviation(a, b, options());
  EXPECT_EQ(found.bounds.upper, 0);
  EXPECT_LE(found.a_to_b.pairs, 20);  // those of the triangle that the witness lies on
}

TEST(TextureComparison, RefusesWhatIsNoNumber) {
  TextureComparison comparison;
  TexturedMesh broken = flat();
  broken.triangles[7].coordinates[1].x() = NAN;
  EXPECT_THROW((void)comparison.measure({flat(), broken}, options()), InvalidInput);
  EXPECT_EQ(comparison.measure({flat(), flat()}, options()).bounds.upper, 0);
}

/// A corner on a coarse lattice, so that coordinates coincide, edges are shared, and triangles have no area.
TexturedTriangle random_triangle(Random& random) {
  std::uniform_int_distribution<int> place(0, 4), uv(0, 3);
  TexturedTriangle triangle;
  for (std::size_t k = 0; k < 3; ++k) {
    triangle.corners[k] = {0.25 * place(random), 0.25 * place(random), 0.25 * place(random)};
    triangle.coordinates[k] = {uv(random) / 3.0, 0.5 * uv(random)};
  }
  return triangle;
}

std::set<std::uint32_t> exceeding_triangles(const OneSidedTextureDeviation& direction) {
  std::set<std::uint32_t> triangles;
  for (const TextureWitness& w : direction.exceeding) triangles.insert(w.from.triangle);
  return triangles;
}

double width(const Bounds& bounds) { return bounds.upper - bounds.lower; }

void expect_as_anew(const OneSidedTextureDeviation& again, const OneSidedTextureDeviation& anew) {
  EXPECT_LE(again.bounds.lower, anew.bounds.upper);
  EXPECT_LE(anew.bounds.lower, again.bounds.upper);
  EXPECT_LE(width(again.bounds), std::max(error_bound, width(anew.bounds)));
  EXPECT_LE(again.uncovered.lower, anew.uncovered.upper);
  EXPECT_LE(anew.uncovered.lower, again.uncovered.upper);
  EXPECT_EQ(exceeding_triangles(again), exceeding_triangles(anew));
}

TEST(TextureComparison, AgreesWithAMeasurementFromNothing) {
  Random random(3);
  for (int trial = 0; trial < 30; ++trial) {
    std::array<TexturedMesh, 2> meshes;
    for (TexturedMesh& mesh : meshes)
      for (int i = 0; i < 8; ++i) mesh.triangles.push_back(random_triangle(random));
    TextureComparison comparison;
    for (int step = 0; step < 6; ++step) {
      for (TexturedMesh& mesh : meshes) mesh = numbered(mesh);
      const TextureDeviation again = comparison.measure(meshes, options()),
                             anew = texture_deviation(meshes[0], meshes[1], options());
      expect_as_anew(again.a_to_b, anew.a_to_b);
      expect_as_anew(again.b_to_a, anew.b_to_a);
      std::vector<TexturedTriangle>& changed = meshes[random() % 4 == 0 ? 0 : 1].triangles;
      changed[random() % changed.size()] = random_triangle(random);
      std::shuffle(changed.begin(), changed.end(), random);
    }
  }
}

}  // namespace texture_comparison_test
}  // namespace meshbound
