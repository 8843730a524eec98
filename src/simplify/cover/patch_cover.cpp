// SPDX-License-Identifier: MIT
#include "simplify/cover/patch_cover.h"

namespace meshbound {

/// Two cuts from the ends of the edge to the sides that leave it; both parts at a cut share its rounded point.
PatchCover::Part PatchCover::without_strip(const Part& part, std::size_t side, double share, std::vector<Part>& open) {
  const Vec3 p = part.corners[side], q = part.corners[(side + 1) % 3], apex = part.corners[(side + 2) % 3];
  const Vec3 at_p = p + share * (apex - p), at_q = q + share * (apex - q);
  open.push_back({{p, q, at_p}, part.cuts + 1});
  open.push_back({{at_p, q, at_q}, part.cuts + 2});
  return {{at_p, at_q, apex}, part.cuts + 2};
}

}  // namespace meshbound
