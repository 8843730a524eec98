// SPDX-License-Identifier: MIT
#include <meshbound/meshbound.h>

#include <cstdio>

int main(int argc, char** argv) try {
  if (argc != 3) return 2;
  const auto [original, simplified] =
      meshbound::build_trees(meshbound::read_mesh(argv[1]).mesh, meshbound::read_mesh(argv[2]).mesh);
  const auto check = meshbound::check_tolerance(original, simplified, 0.001 * original.bounding_box_diagonal());
  std::printf("%.17g <= H <= %.17g\n", check.bounds.lower, check.bounds.upper);
  return check.verdict == meshbound::Verdict::Within ? 0 : 1;
} catch (const meshbound::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
