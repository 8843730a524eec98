// SPDX-License-Identifier: MIT
// Passes when an installed meshbound can be compiled against, linked and run.
#include <meshbound/distance.h>
#include <meshbound/mesh_summary.h>

int main() {
  const float positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  const std::uint16_t indices[] = {0, 1, 2};
  const meshbound::MeshView view(positions, 3, 3 * sizeof(float), indices, 1);
  const meshbound::MeshSummary summary = meshbound::summarise(view);
  const meshbound::Bvh bvh(view);
  const meshbound::SymmetricDistance distance = meshbound::symmetric_distance(bvh, bvh);
  return summary.faces == 1 && !summary.closed && distance.bounds.lower == 0 ? 0 : 1;
}
