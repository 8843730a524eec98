// SPDX-License-Identifier: MIT
// Passes when an installed meshbound can be compiled against, linked and run: it measures, and simplifies without CGAL.
#include <meshbound/meshbound.h>

namespace {

/// Whether a flat grid comes out with fewer faces, within the tolerance.
bool simplifies() {
  meshbound::TriangleMesh grid;
  for (std::uint32_t i = 0; i < 16; ++i) grid.vertices.emplace_back(i % 4, i / 4, 0);
  for (std::uint32_t i = 0; i < 11; ++i) {
    if (i % 4 == 3) continue;
    grid.triangles.push_back({i, i + 1, i + 5});
    grid.triangles.push_back({i, i + 5, i + 4});
  }
  meshbound::SimplifyOptions options;
  options.tolerance = 0.01;
  const meshbound::SimplifiedLevel level = meshbound::simplify_with_bound(grid, options).last();
  return level.faces() < grid.triangles.size() && level.verdict == meshbound::Verdict::Within;
}

}  // namespace

int main() {
  const float positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  const std::uint16_t indices[] = {0, 1, 2};
  const meshbound::MeshView view(positions, 3, 3 * sizeof(float), indices, 1);
  const meshbound::MeshSummary summary = meshbound::summarise(view);
  const meshbound::Bvh bvh(view);
  const meshbound::HausdorffDistance distance = meshbound::hausdorff_distance(bvh, bvh);
  const bool is_measured = summary.faces == 1 && !summary.closed && distance.bounds.lower == 0;
  return is_measured && simplifies() ? 0 : 1;
}
