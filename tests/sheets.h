// SPDX-License-Identifier: MIT
/// Uneven sheets, and which of their triangles lies at a point.
#pragma once
#include <cstddef>
#include <cstdint>
#include <random>

#include "geometry/boxes.h"
#include "geometry/vec3.h"
#include "reference/small_meshes.h"

namespace meshbound::test {

/// 2 n n faces above and below the unit square, with vertices up to `height` away from it.
inline TriangleMesh bumpy_sheet(int n, double height, std::mt19937& random) {
  std::uniform_real_distribution<double> any(-height, height);
  TriangleMesh sheet = reference::unit_square(n);
  for (Eigen::Vector3d& p : sheet.vertices) p.z() = any(random);
  return sheet;
}

/// The one of the first `count` triangles of a soup that is nearest to a point.
template <class Soup>
std::uint32_t nearest_at(const Soup& soup, std::size_t count, Vec3 p) {
  std::uint32_t best = 0;
  for (std::uint32_t f = 1; f < count; ++f)
    if (squared_distance(soup.corners(f), p) < squared_distance(soup.corners(best), p)) best = f;
  return best;
}

}  // namespace meshbound::test
