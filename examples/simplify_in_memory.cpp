// SPDX-License-Identifier: MIT
#include <meshbound/meshbound.h>

#include <cstdio>

int main(int argc, char** argv) try {
  if (argc != 3) return 2;
  const auto original = meshbound::read_mesh(argv[1]).mesh;
  meshbound::SimplifyOptions options;
  options.tolerance = 0.001 * meshbound::bounding_box_diagonal(original);
  const auto level = meshbound::simplify_with_bound(original, options).last();
  std::printf("%zu -> %zu triangles, H <= %.17g\n", original.triangles.size(), level.faces(),
              level.distance->bounds.upper);
  meshbound::write_mesh(argv[2], level.mesh);
  return level.verdict == meshbound::Verdict::Within ? 0 : 1;
} catch (const meshbound::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
