// SPDX-License-Identifier: MIT
#include <meshbound/io.h>
#include <meshbound/mesh_summary.h>
#include <meshbound/simplify.h>

#include <cstdio>

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const auto original = meshbound::read_mesh(argv[1]).mesh;
  meshbound::SimplifyOptions options;
  options.tolerance = 0.001 * meshbound::bounding_box_diagonal(original);
  const auto level = meshbound::simplify_with_bound(original, options).last();
  std::printf("%zu -> %zu triangles, H <= %.17g\n", original.triangles.size(), level.faces(),
              level.distance->bounds.upper);
  // What vertices carry goes with them: vertex 0 of the result began as this one of the original.
  std::printf("vertex 0 was vertex %u\n", level.source_vertex[0]);
  meshbound::write_mesh(argv[2], level.mesh);
  return level.verdict == meshbound::Verdict::Within ? 0 : 1;
}
