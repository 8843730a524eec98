// SPDX-License-Identifier: GPL-3.0-or-later
// Passes when an installed meshbound::cgal simplifies a flat grid to fewer faces within the tolerance.
#include <meshbound/cgal/simplify_with_bound.h>

int main() {
  meshbound::TriangleMesh grid;
  for (std::uint32_t i = 0; i < 16; ++i) grid.vertices.emplace_back(i % 4, i / 4, 0);
  for (std::uint32_t i = 0; i < 11; ++i) {
    if (i % 4 == 3) continue;
    grid.triangles.push_back({i, i + 1, i + 5});
    grid.triangles.push_back({i, i + 5, i + 4});
  }
  meshbound::cgal::SimplifyOptions options;
  options.tolerance = 0.01;
  const auto simplified = meshbound::cgal::simplify_with_bound(grid, options).last();
  const bool fewer = simplified.mesh.triangles.size() < grid.triangles.size();
  return fewer && simplified.verdict == meshbound::Verdict::Within ? 0 : 1;
}
