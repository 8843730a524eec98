// SPDX-License-Identifier: MIT
#include <meshbound/error.h>
#include <meshbound/io.h>
#include <meshbound/level_checker.h>

#include <cstdio>

int main(int argc, char** argv) try {
  if (argc < 3) return 2;
  const meshbound::Bvh original(meshbound::read_mesh(argv[1]).mesh);
  meshbound::LevelChecker levels(original);
  for (int i = 2; i < argc; ++i) {
    const auto level = meshbound::read_mesh(argv[i]).mesh;
    const auto check = levels.check(level, 0.001 * original.bounding_box_diagonal());
    if (check.verdict != meshbound::Verdict::Within) {
      std::printf("%s: at least %.17g\n", argv[i], check.bounds.lower);
      return 1;
    }
    const auto kept = check.a_to_b.stats.proven_before + check.b_to_a.stats.proven_before;
    std::printf("%s: at most %.17g, %zu of %zu triangles kept from the level before\n", argv[i], check.bounds.upper,
                static_cast<std::size_t>(kept), original.triangle_count() + level.triangles.size());
  }
  return 0;
} catch (const meshbound::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
