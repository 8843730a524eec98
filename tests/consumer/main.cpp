// SPDX-License-Identifier: MIT
// Passes when an installed meshbound can be compiled against, linked and run.
#include <meshbound/mesh_view.h>

int main() {
  const float positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  const std::uint16_t indices[] = {0, 1, 2};
  const meshbound::MeshView view(positions, 3, 3 * sizeof(float), indices, 1);
  meshbound::validate(view);
  return meshbound::to_triangle_mesh(view).triangles.size() == 1 ? 0 : 1;
}
