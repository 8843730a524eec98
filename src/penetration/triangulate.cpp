// SPDX-License-Identifier: MIT
#include "penetration/triangulate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <utility>

namespace meshbound {
namespace {

using Seen = PiecePlane::Seen;
using Ring = std::vector<Seen>;

/// Tests of boxes or points that take as long as a step of `count_steps`.
constexpr std::size_t tests_per_step = 16;

void append(const PiecePlane& plane, std::span<const PieceCorner> cycle, Ring& ring) {
  for (const PieceCorner& corner : cycle) ring.push_back(plane.see(corner));
}

double squared_distance(const PiecePlane& plane, const Seen& p, const Seen& q) {
  return squared_length(plane.position(p.corner) - plane.position(q.corner));
}

/// Whether the boxes of two segments are surely apart: most of those that are compared are.
bool are_apart(const Seen& p, const Seen& q, const Seen& r, const Seen& s) {
  const double error = p.error + q.error + r.error + s.error;
  const auto is_below = [error](double a, double b, double c, double d) {
    return std::min(c, d) - std::max(a, b) > error;
  };
  return is_below(p.x, q.x, r.x, s.x) || is_below(r.x, s.x, p.x, q.x) || is_below(p.y, q.y, r.y, s.y) ||
         is_below(r.y, s.y, p.y, q.y);
}

/// Whether segment (r, s), with its ends, meets segment (p, q) between p and q; not if it runs along it.
bool segments_cross(const PiecePlane& plane, const Seen& p, const Seen& q, const Seen& r, const Seen& s) {
  if (are_apart(p, q, r, s)) return false;
  if (p.corner == r.corner || p.corner == s.corner || q.corner == r.corner || q.corner == s.corner) return false;
  return plane.turn(p, q, r) * plane.turn(p, q, s) <= 0 && plane.turn(r, s, p) * plane.turn(r, s, q) < 0;
}

bool crosses_ring(const PiecePlane& plane, const Seen& p, const Seen& q, const Ring& ring) {
  plane.count_steps(1 + ring.size() / tests_per_step);
  for (std::size_t i = 0; i < ring.size(); ++i)
    if (segments_cross(plane, p, q, ring[i], ring[i + 1 < ring.size() ? i + 1 : 0])) return true;
  return false;
}

/// Whether a segment has points within a triangle that turns left: no line along it or along a side separates the two.
bool enters(const PiecePlane& plane, const Seen& r, const Seen& s, const std::array<Seen, 3>& triangle) {
  int least = 1, largest = -1;
  for (std::size_t k = 0; k < 3; ++k) {
    const Seen &p = triangle[k], &q = triangle[k < 2 ? k + 1 : 0];
    if (plane.turn(p, q, r) <= 0 && plane.turn(p, q, s) <= 0) return false;
    const int turn = plane.turn(r, s, p);
    least = std::min(least, turn), largest = std::max(largest, turn);
  }
  return least < 0 && largest > 0;
}

/// Whether the way from corner `i` of the ring to p begins on the left of the ring or, if `least` is 0 and not 1, along
/// it. Where the ring turns back there is nothing on its left.
bool is_inside_at(const PiecePlane& plane, const Ring& ring, std::size_t i, const Seen& p, int least) {
  const Seen &before = ring[i > 0 ? i - 1 : ring.size() - 1], &at = ring[i],
             &after = ring[i + 1 < ring.size() ? i + 1 : 0];
  const bool left_of_first = plane.turn(before, at, p) >= least, left_of_second = plane.turn(at, after, p) >= least;
  return plane.turn(before, at, after) >= 0 ? left_of_first && left_of_second : left_of_first || left_of_second;
}

std::size_t rightmost(const Ring& ring) {
  const auto found = std::max_element(ring.begin(), ring.end(), [](const Seen& a, const Seen& b) { return a.x < b.x; });
  return static_cast<std::size_t>(found - ring.begin());
}

/// Joins the first of the holes to the ring by a bridge from its rightmost corner to the nearest corner of the ring
/// visible from there, past the other holes.
void join_hole(const PiecePlane& plane, Ring& ring, std::span<const Ring> holes) {
  const Ring& hole = holes[0];
  const std::size_t from = rightmost(hole);
  const auto is_visible = [&](std::size_t i, int least) {
    const auto crosses = [&](const Ring& other) { return crosses_ring(plane, hole[from], ring[i], other); };
    return is_inside_at(plane, ring, i, hole[from], least) && !crosses(ring) &&
           std::none_of(holes.begin(), holes.end(), crosses);
  };
  // A heap that has the nearest corner first; those taken from it stand behind it, the nearest one last. Mostly one of
  // the first corners is visible.
  using Corner = std::pair<double, std::size_t>;  // squared distance, index in the ring
  std::vector<Corner> corners;
  for (std::size_t i = 0; i < ring.size(); ++i) corners.emplace_back(squared_distance(plane, ring[i], hole[from]), i);
  std::make_heap(corners.begin(), corners.end(), std::greater<>());
  std::optional<std::size_t> to;
  for (auto end = corners.end(); end != corners.begin() && !to; --end) {
    std::pop_heap(corners.begin(), end, std::greater<>());
    if (const std::size_t i = (end - 1)->second; is_visible(i, 1)) to = i;
  }
  // Along the ring, a bridge fits several of the corners in one place: the last choice.
  for (auto corner = corners.rbegin(); corner != corners.rend() && !to; ++corner)
    if (is_visible(corner->second, 0)) to = corner->second;
  if (!to) to = corners.back().second;
  Ring bridge;
  for (std::size_t i = 0; i <= hole.size(); ++i) bridge.push_back(hole[(from + i) % hole.size()]);
  bridge.push_back(ring[*to]);
  ring.insert(ring.begin() + static_cast<std::ptrdiff_t>(*to) + 1, bridge.begin(), bridge.end());
}

/// Joins all lines to one ring: the one that reaches furthest to the right is around the others, which are holes.
void join(const PiecePlane& plane, std::span<const std::span<const PieceCorner>> lines, Ring& ring) {
  std::vector<Ring> from_right(lines.size());
  for (std::size_t i = 0; i < lines.size(); ++i) append(plane, lines[i], from_right[i]);
  std::stable_sort(from_right.begin(), from_right.end(),
                   [](const Ring& a, const Ring& b) { return a[rightmost(a)].x > b[rightmost(b)].x; });
  ring = from_right[0];
  for (std::size_t i = 1; i < from_right.size(); ++i) join_hole(plane, ring, std::span(from_right).subspan(i));
}

/// Quality of an ear, best first: an ear is cut only if there is none of a better kind.
enum class EarQuality {
  Clear,    ///< turns left and no other corner is in it or on its border
  Flat,     ///< its corners lie in one line
  Touched,  ///< turns left and no edge of the ring enters it
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
        plane_.count_steps(1);
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
    return quality == EarQuality::Clear ? is_clear(i) : is_entered_by_no_edge(i);
  }

  [[nodiscard]] bool is_clear(std::size_t i) const {
    plane_.count_steps(left_ / tests_per_step);
    const Seen &p = ring_[previous_[i]], &q = ring_[i], &r = ring_[next_[i]];
    const double error = 2 * (p.error + q.error + r.error);
    const double left = std::min({p.x, q.x, r.x}) - error, right = std::max({p.x, q.x, r.x}) + error,
                 low = std::min({p.y, q.y, r.y}) - error, high = std::max({p.y, q.y, r.y}) + error;
    for (std::size_t j = next_[next_[i]]; j != previous_[i]; j = next_[j]) {
      const Seen& c = ring_[j];
      if (left - c.x > c.error || c.x - right > c.error || low - c.y > c.error || c.y - high > c.error) continue;
      // A corner that turns left cannot be the first one to enter the ear. Where the ring comes to q again, the ear may
      // lie on its other side.
      if (turns_[j] > 0 || c.corner == p.corner || c.corner == r.corner) continue;
      if (plane_.turn(r, p, c) >= 0 && plane_.turn(p, q, c) >= 0 && plane_.turn(q, r, c) >= 0) return false;
    }
    return true;
  }

  [[nodiscard]] bool is_entered_by_no_edge(std::size_t i) const {
    plane_.count_steps(left_);
    const std::array<Seen, 3> ear{ring_[previous_[i]], ring_[i], ring_[next_[i]]};
    for (std::size_t j = next_[i]; j != previous_[i]; j = next_[j])
      if (enters(plane_, ring_[j], ring_[next_[j]], ear)) return false;
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
    const Seen &p = ring_[previous_[i]], &q = ring_[i], &r = ring_[next_[i]];
    triangles.push_back({p.corner, q.corner, r.corner});
    if (turns_[i] >= 0) return;
    const double longest =
        std::max({squared_distance(plane_, p, q), squared_distance(plane_, q, r), squared_distance(plane_, r, p)});
    excess_ = std::max(excess_, (1 + 0x1p-40) * std::sqrt(longest) + p.error + q.error + r.error);
  }

  const PiecePlane& plane_;
  const Ring& ring_;
  std::vector<std::size_t>&next_, &previous_;
  std::vector<int>& turns_;
  std::size_t left_;
  double excess_ = 0;
};

}  // namespace

double triangulate(const PiecePlane& plane, std::span<const std::span<const PieceCorner>> border,
                   std::vector<CornerTriple>& triangles) {
  if (border.size() == 1 && border[0].size() == 3) {
    triangles.push_back({border[0][0], border[0][1], border[0][2]});
    return 0;
  }
  thread_local EarMemory memory;
  memory.ring.clear();
  if (border.size() == 1)
    append(plane, border[0], memory.ring);
  else
    join(plane, border, memory.ring);
  return EarCutter(plane, memory).cut(triangles);
}

}  // namespace meshbound
