// SPDX-License-Identifier: MIT
#include "simplify/cover/parity_proof.h"

#include <algorithm>
#include <cmath>

namespace meshbound {
namespace {

/// A patch of more triangles is given up: a quarter of what a tile has.
constexpr std::size_t largest_patch = std::size_t{1} << 18;

}  // namespace

ParityProof::ParityProof() : patch_(largest_patch) {}

void ParityProof::note_obstacle(const Window<3>& window, const Window<3>::Clipped& seen) {
  double min_share = HUGE_VAL;
  for (std::size_t side = 0; side < 3; ++side) {
    const double height = -window.outside(side, window.corner[(side + 2) % 3]);
    double depth = 0;
    for (const Projected& p : seen.corners()) depth = std::max(depth, -window.outside(side, p));
    if (!(depth < min_share * height)) continue;
    min_share = depth / height;
    obstacle_ = {side, depth, height};
  }
}

}  // namespace meshbound
