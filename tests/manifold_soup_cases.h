// SPDX-License-Identifier: MIT
/// Soups that are no 2-manifolds, random ones and the real files, for the tests of `manifold_soup`.
#pragma once
#include <filesystem>
#include <random>
#include <utility>
#include <vector>

#include "datasets.h"
#include "meshbound/error.h"
#include "meshbound/io.h"
#include "meshbound/mesh_view.h"
#include "meshbound/triangle_mesh.h"

namespace meshbound::test {

/// Triangles of a torus grid with some missing, some turned over, some repeated, some with a corner elsewhere and some
/// vertices twice; or, for every third seed, any triangles of a few vertices. One at least.
inline TriangleMesh tangled_soup(std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto below = [&](std::uint32_t n) { return static_cast<std::uint32_t>(random() % n); };
  const std::uint32_t n = 3 + below(4);
  TriangleMesh soup;
  for (std::uint32_t v = 0; v < n * n; ++v) soup.vertices.emplace_back(v / n, v % n, (v * v) % 7);
  if (seed % 3 == 0) {
    for (std::uint32_t count = 1 + below(3 * n * n); count > 0; --count)
      soup.triangles.push_back({below(n * n), below(n * n), below(n * n)});
    return soup;
  }
  const std::uint32_t missing = 2 + below(20), turned = 2 + below(20), elsewhere = 5 + below(40);
  soup.triangles.push_back({0, 1, n});
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      const std::uint32_t i1 = (i + 1) % n, j1 = (j + 1) % n;
      if (below(missing) != 0) soup.triangles.push_back({n * i + j, n * i1 + j, n * i1 + j1});
      if (below(missing) != 0) soup.triangles.push_back({n * i + j, n * i1 + j1, n * i + j1});
    }
  }
  for (Triangle& corners : soup.triangles) {
    if (below(turned) == 0) std::swap(corners[0], corners[1]);
    if (below(elsewhere) == 0) corners[below(3)] = below(n * n);
    if (below(9) != 0) continue;
    std::uint32_t& corner = corners[below(3)];
    soup.vertices.push_back(soup.vertices[corner]);
    corner = static_cast<std::uint32_t>(soup.vertices.size() - 1);
  }
  if (below(3) == 0) soup.triangles.push_back(soup.triangles[below(static_cast<std::uint32_t>(soup.triangles.size()))]);
  return soup;
}

/// The files among the shared meshes that are a valid soup, by name.
inline std::vector<std::pair<std::filesystem::path, TriangleMesh>> readable_meshes(
    const std::vector<std::string>& folders) {
  std::vector<std::pair<std::filesystem::path, TriangleMesh>> meshes;
  for (const std::string& folder : folders) {
    for (const std::filesystem::path& path : datasets_in(folder)) {
      try {
        TriangleMesh mesh = read_mesh(path).mesh;
        validate(mesh);
        meshes.emplace_back(path, std::move(mesh));
      } catch (const Error&) {
      }
    }
  }
  return meshes;
}

}  // namespace meshbound::test
