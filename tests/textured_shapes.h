// SPDX-License-Identifier: MIT
/// Small meshes with texture coordinates, and what their deviation is expected to be.
#pragma once
#include <gtest/gtest.h>

#include <functional>

#include "meshbound/texture_deviation.h"

namespace meshbound::test {

inline constexpr double tight = 1e-9;

inline TextureDeviation measured(const TexturedMesh& a, const TexturedMesh& b, double error_bound = tight,
                                 int threads = 1) {
  TextureDeviationOptions options;
  options.error_bound = error_bound;
  options.threads = threads;
  return texture_deviation(a, b, options);
}

inline void expect_value(const Bounds& bounds, double value, double width = tight) {
  EXPECT_LE(bounds.lower, value * (1 + 1e-15));
  EXPECT_GE(bounds.upper, value * (1 - 1e-15));
  EXPECT_LE(bounds.upper - bounds.lower, width);
}

/// A point in space and its texture coordinate.
struct Corner {
  Eigen::Vector3d at;
  Eigen::Vector2d uv;
};

inline TexturedTriangle triangle(const Corner& a, const Corner& b, const Corner& c) {
  return {{a.at, b.at, c.at}, {a.uv, b.uv, c.uv}};
}

inline TexturedMesh numbered(TexturedMesh mesh) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) mesh.triangles[t].triangle = static_cast<std::uint32_t>(t);
  return mesh;
}

using Shape = std::function<Corner(double s, double t)>;

/// n x n squares of the unit square, cut into triangles, mapped by `shape`.
inline TexturedMesh grid(int n, const Shape& shape) {
  TexturedMesh mesh;
  const auto at = [&](int i, int j) { return shape(i / static_cast<double>(n), j / static_cast<double>(n)); };
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      mesh.triangles.push_back(triangle(at(i, j), at(i + 1, j), at(i + 1, j + 1)));
      mesh.triangles.push_back(triangle(at(i, j), at(i + 1, j + 1), at(i, j + 1)));
    }
  }
  return numbered(mesh);
}

inline Corner flat(double s, double t) { return {{s, t, 0}, {s, t}}; }

inline TexturedMesh joined(TexturedMesh a, const TexturedMesh& b) {
  a.triangles.insert(a.triangles.end(), b.triangles.begin(), b.triangles.end());
  return numbered(a);
}

}  // namespace meshbound::test
