// SPDX-License-Identifier: MIT
#include "penetration/triangulate.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace meshbound {
namespace {

using Ring = std::vector<PieceCorner>;

double squared_distance(const PiecePlane& plane, PieceCorner p, PieceCorner q) {
  return squared_length(plane.position(p) - plane.position(q));
}

/// Whether the interiors of segments (p, q) and (r, s) cross.
bool segments_cross(const PiecePlane& plane, PieceCorner p, PieceCorner q, PieceCorner r, PieceCorner s) {
  if (p == r || p == s || q == r || q == s) return false;
  return plane.turn(p, q, r) * plane.turn(p, q, s) < 0 && plane.turn(r, s, p) * plane.turn(r, s, q) < 0;
}

bool crosses_ring(const PiecePlane& plane, PieceCorner p, PieceCorner q, std::span<const PieceCorner> ring) {
  for (std::size_t i = 0; i < ring.size(); ++i)
    if (segments_cross(plane, p, q, ring[i], ring[i + 1 < ring.size() ? i + 1 : 0])) return true;
  return false;
}

std::size_t rightmost(const PiecePlane& plane, std::span<const PieceCorner> cycle) {
  const auto found = std::max_element(cycle.begin(), cycle.end(),
                                      [&](PieceCorner a, PieceCorner b) { return plane.x(a) < plane.x(b); });
  return static_cast<std::size_t>(found - cycle.begin());
}

/// Joins a hole to the ring by a bridge from its rightmost corner to the nearest corner of the ring visible from there.
void join_hole(const PiecePlane& plane, Ring& ring, std::span<const PieceCorner> hole) {
  const std::size_t from = rightmost(plane, hole);
  std::vector<std::size_t> order(ring.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
    const double a = squared_distance(plane, ring[i], hole[from]), b = squared_distance(plane, ring[j], hole[from]);
    return a != b ? a < b : i < j;
  });
  const auto sees = [&](std::size_t i) {
    return !crosses_ring(plane, hole[from], ring[i], ring) && !crosses_ring(plane, hole[from], ring[i], hole);
  };
  const auto found = std::find_if(order.begin(), order.end(), sees);
  const std::size_t to = found != order.end() ? *found : order.front();
  Ring bridge;
  for (std::size_t i = 0; i <= hole.size(); ++i) bridge.push_back(hole[(from + i) % hole.size()]);
  bridge.push_back(ring[to]);
  ring.insert(ring.begin() + static_cast<std::ptrdiff_t>(to) + 1, bridge.begin(), bridge.end());
}

/// Quality of an ear, best first: an ear is cut only if there is none of a better kind.
enum class EarQuality {
  Clear,    ///< turns left and no other corner is in it or on its border
  Flat,     ///< its corners lie in one line
  Touched,  ///< turns left and no other corner is within it
  Left,     ///< turns left
  Any
};

/// Memory that a thread keeps from polygon to polygon.
struct EarMemory {
  Ring ring;
  std::vector<std::size_t> next, previous;
  std::vector<int> turns;
};

class EarCutter {
 public:
  /// Cuts the ring of `memory`.
  EarCutter(const PiecePlane& plane, EarMemory& memory)
      : plane_(plane),
        ring_(memory.ring),
        next_(memory.next),
        previous_(memory.previous),
        turns_(memory.turns),
        left_(memory.ring.size()) {
    const std::size_t n = left_;
    next_.resize(n);
    previous_.resize(n);
    turns_.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      next_[i] = i + 1 < n ? i + 1 : 0;
      previous_[i] = i > 0 ? i - 1 : n - 1;
    }
    for (std::size_t i = 0; i < n; ++i) turns_[i] = turn_at(i);
  }

  double cut(std::vector<CornerTriple>& triangles) {
    std::size_t at = 0;
    while (left_ > 3) at = cut_ear(best_ear(at), triangles);
    add(at, triangles);
    return excess_;
  }

 private:
  [[nodiscard]] int turn_at(std::size_t i) const { return plane_.turn(ring_[previous_[i]], ring_[i], ring_[next_[i]]); }

  [[nodiscard]] std::size_t best_ear(std::size_t from) const {
    for (const EarQuality quality : {EarQuality::Clear, EarQuality::Flat, EarQuality::Touched, EarQuality::Left}) {
      std::size_t i = from;
      do {
        if (is_ear(i, quality)) return i;
        i = next_[i];
      } while (i != from);
    }
    return from;
  }

  [[nodiscard]] bool is_ear(std::size_t i, EarQuality quality) const {
    if (quality == EarQuality::Flat) return turns_[i] == 0;
    if (turns_[i] <= 0) return false;
    if (quality == EarQuality::Left) return true;
    const PieceCorner p = ring_[previous_[i]], q = ring_[i], r = ring_[next_[i]];
    const int beyond = quality == EarQuality::Clear ? 0 : 1;
    for (std::size_t j = next_[next_[i]]; j != previous_[i]; j = next_[j]) {
      const PieceCorner c = ring_[j];
      // A corner that turns left cannot be the first one to enter the ear. Where the ring comes to q again, the ear may
      // lie on its other side.
      if (turns_[j] > 0 || c == p || c == r) continue;
      if (plane_.turn(r, p, c) >= beyond && plane_.turn(p, q, c) >= beyond && plane_.turn(q, r, c) >= beyond)
        return false;
    }
    return true;
  }

  std::size_t cut_ear(std::size_t i, std::vector<CornerTriple>& triangles) {
    add(i, triangles);
    const std::size_t before = previous_[i], after = next_[i];
    next_[before] = after;
    previous_[after] = before;
    --left_;
    turns_[before] = turn_at(before);
    turns_[after] = turn_at(after);
    return after;
  }

  void add(std::size_t i, std::vector<CornerTriple>& triangles) {
    const PieceCorner p = ring_[previous_[i]], q = ring_[i], r = ring_[next_[i]];
    triangles.push_back({p, q, r});
    if (turns_[i] >= 0) return;
    const double longest =
        std::max({squared_distance(plane_, p, q), squared_distance(plane_, q, r), squared_distance(plane_, r, p)});
    excess_ =
        std::max(excess_, (1 + 0x1p-40) * std::sqrt(longest) + plane_.error(p) + plane_.error(q) + plane_.error(r));
  }

  const PiecePlane& plane_;
  const Ring& ring_;
  std::vector<std::size_t>&next_, &previous_;
  std::vector<int>& turns_;
  std::size_t left_;
  double excess_ = 0;
};

}  // namespace

double triangulate(const PiecePlane& plane, std::span<const PieceCorner> outer,
                   const std::vector<std::span<const PieceCorner>>& holes, std::vector<CornerTriple>& triangles) {
  if (outer.size() == 3 && holes.empty()) {
    triangles.push_back({outer[0], outer[1], outer[2]});
    return 0;
  }
  thread_local EarMemory memory;
  memory.ring.assign(outer.begin(), outer.end());
  std::vector<std::span<const PieceCorner>> from_right = holes;
  if (!holes.empty()) {
    std::stable_sort(from_right.begin(), from_right.end(), [&](const auto& a, const auto& b) {
      return plane.x(a[rightmost(plane, a)]) > plane.x(b[rightmost(plane, b)]);
    });
  }
  for (const std::span<const PieceCorner>& hole : from_right) join_hole(plane, memory.ring, hole);
  return EarCutter(plane, memory).cut(triangles);
}

}  // namespace meshbound
