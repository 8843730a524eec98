// SPDX-License-Identifier: MIT
// The smallest program that asks for a bound. Exit 0 when it got one, 2 with a line on stderr when it was refused.
#include <cstdio>

#include "meshbound/bvh.h"
#include "meshbound/error.h"

int main() {
  const meshbound::TriangleMesh triangle{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  try {
    const meshbound::Bvh tree(triangle);
    return closest_point(tree, {0, 0, 1}).distance.upper >= 1 ? 0 : 1;
  } catch (const meshbound::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
