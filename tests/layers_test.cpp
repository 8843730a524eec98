// SPDX-License-Identifier: MIT
// Triangles with the same corners: where they look different, each layer keeps its side, its material and its area;
// where looks do not count, as in scans, those after the first change nothing.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "meshbound/attributes.h"
#include "meshbound/simplify.h"
#include "simplify_options.h"

namespace meshbound {
namespace layers_test {

struct WithAttributes {
  TriangleMesh mesh;
  MeshAttributes attributes;
};

/// n x n rectangles of 0.3 x 1.1: the sums of the corners of a triangle and of its back differ in their last bits here
/// and there.
TriangleMesh plate(std::uint32_t n) {
  TriangleMesh result;
  for (std::uint32_t x = 0; x <= n; ++x)
    for (std::uint32_t y = 0; y <= n; ++y) result.vertices.emplace_back(0.3 * x, 1.1 * y, 0);
  for (std::uint32_t x = 0; x < n; ++x) {
    for (std::uint32_t y = 0; y < n; ++y) {
      const std::uint32_t a = x * (n + 1) + y, b = a + n + 1;
      result.triangles.push_back({a, b, b + 1});
      result.triangles.push_back({a, b + 1, a + 1});
    }
  }
  return result;
}

void add_backs(TriangleMesh& mesh) {
  const std::size_t fronts = mesh.triangles.size();
  for (std::size_t t = 0; t < fronts; ++t) {
    const auto [a, b, c] = mesh.triangles[t];
    mesh.triangles.push_back({c, b, a});
  }
}

/// By material: the area that shows up, and the area that shows down.
std::array<std::array<double, 2>, 2> areas(const TriangleMesh& mesh, const std::vector<std::uint32_t>& materials) {
  std::array<std::array<double, 2>, 2> result{};
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = mesh.triangles[t];
    const Eigen::Vector3d& p = mesh.vertices[a];
    const double doubled = (mesh.vertices[b] - p).cross(mesh.vertices[c] - p).z();
    result.at(materials[t]).at(doubled > 0 ? 0 : 1) += std::abs(doubled) / 2;
  }
  return result;
}

TEST(Layers, KeepTheirSideTheirMaterialAndTheirArea) {
  WithAttributes sheet = {plate(17), {}};
  const std::size_t fronts = sheet.mesh.triangles.size();
  add_backs(sheet.mesh);
  sheet.attributes.materials.names = {"front", "back"};
  for (std::size_t t = 0; t < 2 * fronts; ++t) sheet.attributes.materials.index.push_back(t < fronts ? 0 : 1);
  SimplifyOptions options = test::within(0.01);
  options.feature_edges = seams(sheet.mesh, sheet.attributes);
  options.looks = looks(sheet.mesh, sheet.attributes);
  const SimplifiedLevel level = simplify_with_bound(sheet.mesh, options).last();
  EXPECT_EQ(level.faces(), 4U) << "two for each side";
  const auto labels = transferred_attributes(sheet.mesh, sheet.attributes, level).materials.index;
  const auto before = areas(sheet.mesh, sheet.attributes.materials.index), after = areas(level.mesh, labels);
  for (std::size_t m = 0; m < 2; ++m)
    for (std::size_t side = 0; side < 2; ++side)
      EXPECT_NEAR(after.at(m).at(side), before.at(m).at(side), 1e-9) << "material " << m << ", side " << side;
}

/// A wavy sheet whose colour and height follow from x and y.
WithAttributes scan(std::uint32_t n) {
  WithAttributes result = {plate(n), {}};
  NamedAttribute colours;
  colours.name = "COLOR_0";
  colours.width = 3;
  colours.has_seams = false;
  for (Eigen::Vector3d& p : result.mesh.vertices) {
    const double u = p.x() / (0.3 * n), v = p.y() / (1.1 * n);
    p = {u, v, 0.1 * std::sin(5 * u) * std::cos(4 * v)};
    for (const double value : {u, v, 0.5}) colours.values.push_back(value);
    result.attributes.normals.values.push_back(
        Eigen::Vector3d(-0.5 * std::cos(5 * u) * std::cos(4 * v), 0.4 * std::sin(5 * u) * std::sin(4 * v), 1)
            .normalized());
  }
  colours.index = result.mesh.triangles;
  result.attributes.normals.index = result.mesh.triangles;
  result.attributes.named.push_back(colours);
  return result;
}

/// The largest error of a colour and of a normal (as a length) in a simplification.
std::array<double, 2> errors(const WithAttributes& from, bool keeps_positions) {
  SimplifyOptions options = test::within(0.01);
  options.feature_edges = seams(from.mesh, from.attributes);
  options.looks = looks(from.mesh, from.attributes);
  if (keeps_positions) options.placements = CollapsePlacements::Subset;
  EXPECT_TRUE(options.feature_edges.empty());
  EXPECT_TRUE(options.looks.empty());
  const SimplifiedLevel level = simplify_with_bound(from.mesh, options).last();
  EXPECT_LT(level.faces(), from.mesh.triangles.size() / 8);
  const MeshAttributes found = transferred_attributes(from.mesh, from.attributes, level);
  std::array<double, 2> result{};
  for (std::size_t t = 0; t < level.mesh.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d& p = level.mesh.vertices[level.mesh.triangles[t][k]];
      if (found.named[0].index[t][k] == CornerAttribute::none || found.normals.index[t][k] == CornerAttribute::none) {
        ADD_FAILURE() << "a corner has no values";
        return {HUGE_VAL, HUGE_VAL};
      }
      const double* const colour = found.named[0].values.data() + 3 * std::size_t{found.named[0].index[t][k]};
      result[0] = std::max({result[0], std::abs(colour[0] - p.x()), std::abs(colour[1] - p.y())});
      const Eigen::Vector3d right(-0.5 * std::cos(5 * p.x()) * std::cos(4 * p.y()),
                                  0.4 * std::sin(5 * p.x()) * std::sin(4 * p.y()), 1);
      const Eigen::Vector3d& normal = found.normals.values[found.normals.index[t][k]];
      result[1] = std::max(result[1], (normal - right.normalized()).norm());
    }
  }
  return result;
}

/// All triangles twice, from another corner on; a few of them; and all with their backs.
TEST(Layers, RepetitionsInAScanChangeNoValues) {
  for (const bool keeps_positions : {false, true}) {
    const WithAttributes once = scan(40);
    const auto before = errors(once, keeps_positions);
    EXPECT_LT(before[0], 0.05);
    for (const std::size_t step : {1, 100}) {
      for (const bool are_backs : {false, true}) {
        WithAttributes twice = once;
        for (std::size_t t = 0; t < once.mesh.triangles.size(); t += step) {
          auto [a, b, c] = once.mesh.triangles[t];
          if (are_backs) std::swap(b, c);
          twice.mesh.triangles.push_back({b, c, a});
        }
        twice.attributes.named[0].index = twice.attributes.normals.index = twice.mesh.triangles;
        const auto after = errors(twice, keeps_positions);
        EXPECT_LE(after[0], 1.5 * before[0]) << "colours, every " << step << ", backs " << are_backs;
        EXPECT_LE(after[1], 1.5 * before[1] + 0.02) << "normals, every " << step << ", backs " << are_backs;
      }
    }
  }
}

}  // namespace layers_test
}  // namespace meshbound
