// SPDX-License-Identifier: MIT
#include "penetration/parity.h"

#include <algorithm>
#include <cmath>

#include "bvh/build.h"
#include "numeric/rounding.h"

namespace meshbound {
namespace {

/// Sign of the turn from edge (from, to) of the other side to v, seen from above; 0 only for an edge that is seen as a
/// point. It is (to - from) x (v - from) by the first two coordinates. If that is 0, the motion e of side 0 decides: it
/// adds +-(d_x e_2 - d_y e_1) with d = to - from, the sign being + where v is on side 0.
int turn_from_above(PlacedPair& pair, PairVertex from, PairVertex to, PairVertex v) {
  const Vec3 d = pair.local(to) - pair.local(from), w = pair.local(v) - pair.local(from);
  const double h = 2 * std::max(pair.error(0), pair.error(1));
  const double magnitude = std::fabs(d.x * w.y) + std::fabs(d.y * w.x);
  const double sum = std::fabs(d.x) + std::fabs(d.y) + std::fabs(w.x) + std::fabs(w.y) + 4 * h;
  const double bound = 8 * unit_roundoff * magnitude + 2 * h * sum + 0x1p-1000;
  const double turn = d.x * w.y - d.y * w.x;
  if (turn > bound) return 1;
  if (turn < -bound) return -1;
  const ExactPoint direction = pair.exact(to) - pair.exact(from), offset = pair.exact(v) - pair.exact(from);
  const mpz_class exact_turn = direction.x * offset.y - direction.y * offset.x;
  if (sgn(exact_turn) != 0) return sgn(exact_turn);
  const int moved = v.side == 0 ? 1 : -1;
  return sgn(direction.y) != 0 ? -moved * sgn(direction.y) : moved * sgn(direction.x);
}

/// False where nothing inside the box lies above v; `v` is off by at most `error`, the box holds that of its side.
bool may_be_above(const Box& box, const Vec3& v, double error) {
  return box.lo.x <= v.x + error && box.hi.x >= v.x - error && box.lo.y <= v.y + error && box.hi.y >= v.y - error &&
         box.hi.z >= v.z - error;
}

/// Whether the triangle lies above v.
bool is_above(PlacedPair& pair, std::uint32_t side, const Triangle& triangle, PairVertex v) {
  const PairVertex p{side, triangle[0]}, q{side, triangle[1]}, r{side, triangle[2]};
  const int turn = turn_from_above(pair, p, q, v);
  if (turn == 0 || turn_from_above(pair, q, r, v) != turn || turn_from_above(pair, r, p, v) != turn) return false;
  // Seen from above, the corners turn the way that the normal points up, and v is below unless it is on the normal's
  // side.
  return pair.side_of_plane(side, triangle, v.vertex) == -turn;
}

}  // namespace

std::vector<bool> components_around(PlacedPair& pair, PairVertex v) {
  const std::uint32_t side = 1 - v.side;
  const ClosedModel::Data& model = pair.model(side);
  std::vector<bool> around(model.components.size(), false);
  const Bvh::Data& tree = model.tree.data();
  const Vec3 at = pair.local(v);
  const double error = 2 * pair.error(v.side);  // and what is rounded here
  for (std::uint32_t block = 0; block < tree.block_count(); ++block) {
    pair.count_step();
    if (!may_be_above(pair.block_box(side, block), at, error)) continue;
    const auto [begin, end] = slots_below(tree, 0, block);
    for (std::uint32_t slot = begin; slot < end; ++slot) {
      const std::uint32_t t = tree.triangle_of_slot[slot];
      if (is_above(pair, side, model.triangles[t], v)) around[model.component_of[t]].flip();
    }
  }
  return around;
}

bool is_inside(PlacedPair& pair, PairVertex v) {
  const std::vector<bool> around = components_around(pair, v);
  return std::count(around.begin(), around.end(), true) % 2 != 0;
}

bool may_be_inside(const PlacedPair& pair, std::uint32_t side, std::uint32_t component) {
  const ClosedModel::Data &own = pair.model(side), &other = pair.model(1 - side);
  const Eigen::AlignedBox3d& box = other.tree.bounding_box();
  for (const std::uint32_t vertex : own.components[component].extremes)
    if (pair.is_beyond(side, own.positions[vertex], box)) return false;
  return true;
}

}  // namespace meshbound
