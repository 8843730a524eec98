// SPDX-License-Identifier: MIT
/// Voronoi subdivision taken to its end: a piece of A is cut along the cells of the triangles of B that it crosses.
/// Each part walks on to the neighbour across the cut, and is bounded by that triangle alone. Compiled once per
/// instruction set.
///
///     a triangle of A that lies on many triangles of B is covered by them together (distance/kernel/parity_cover.h);
///     where B ends below it, its halves are; what neither covers are the first pieces
///     while a piece is left                               d(., t) is convex: the corners bound the piece
///       if every corner is within the target of its candidate t: done
///       cut it by the cell of t, pushed outward by a slack; what is outside goes to the neighbour, without a query
///       every few steps query near the worst corner: raises the lower bound, finds a better candidate
///       inside the cell and still too far: split it by a chord, where another triangle begins to serve it better;
///                                          where three are equally near, by a line through that point
///     what so many cuts have not bounded is left to the method of the paper (subdivision.h)
///
/// Sound for any soup: adjacency, cells and candidates choose the parts, the bound needs only that the parts cover the
/// piece (`cut`) and the convexity. Paper, section 5.2, generalised.
#pragma once
#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <vector>

#include "distance/kernel/choice.h"
#include "distance/kernel/parity_cover.h"
#include "geometry/triangle_corners.h"
#include "proof/cell_planes.h"
#include "proof/piece.h"
#include "proof/proven_bounds.h"

namespace meshbound {

/// Steps without a query: long enough to cross a fan, short enough not to get lost where adjacency misleads.
inline constexpr std::uint32_t steps_between_queries = 8;
/// Steps of a walk that has no queries: across a triangle of A that lies on a thousand of B.
inline constexpr std::uint32_t steps_of_sweep = 32;
/// A corner that is more than so many targets away from the first point that is tried on a triangle is rarely within
/// the target of another point of that triangle.
inline constexpr double hopeless_targets = 3;
/// Queries after which a piece is halved, as it walks in circles; and queries after which it is split between its
/// candidate and the triangle that a query finds, as around an axis of B the cells cut off a sliver at each step.
inline constexpr std::uint32_t halve_from_rounds = 24;
inline constexpr std::uint32_t split_from_rounds = 4;
/// Splits between two triangles, and cuts, after which a piece walks no more: around a vertex of B the cells by edges
/// may lead it back to where it came from. Then splits after which it is halved, which makes bisectors straighter.
inline constexpr std::uint32_t splits_before_resolving = 3;
inline constexpr std::uint32_t cuts_before_resolving = 60;
inline constexpr std::uint32_t splits_before_halving = 8;
/// Cuts after which the walk leaves a piece to subdivision, which may cut it until `deepest_cut`.
inline constexpr std::uint32_t deepest_walk = 90;
/// Halvings after which a triangle of A is not halved again for a cover by parity: an edge of it is then a few
/// thousandths of what it was.
inline constexpr std::uint32_t halved_for_parity = 16;

inline namespace MESHBOUND_ISA {

class CellWalker : public ProvenBounds {
 public:
  CellWalker(const Bvh::Data& target, const Goal& goal) : ProvenBounds(target, goal), parity_(target, goal.magnitude) {
    constexpr std::size_t usual_depth = 8;
    stack_.reserve(usual_depth);
  }

  /// Covers one triangle of A, starting at triangle `slot` of B, except for the pieces that it leaves `unfinished`.
  void cover(const Vec3& a, const Vec3& b, const Vec3& c, std::uint32_t from_slot, std::uint32_t slot,
             std::uint64_t max_cuts) {
    set_from(from_slot);
    cuts_left_ = max_cuts;
    stack_.clear();
    unfinished_.clear();
    parity_.begin();
    cover_by_parity({a, b, c}, slot, 0);
    while (!stack_.empty()) {
      const Piece piece = stack_.back();
      stack_.pop_back();
      step(piece);
    }
  }

  /// A piece that the walk has given up after too many cuts. It is within the root of `upper_squared` of B.
  struct Unfinished {
    Piece piece;
    double upper_squared;
  };
  [[nodiscard]] const std::vector<Unfinished>& unfinished() const { return unfinished_; }
  [[nodiscard]] std::uint64_t cuts_left() const { return cuts_left_; }

  /// Covers one triangle of A by at most `max_pieces` pieces, walking from triangle `slot` of B without any query, with
  /// at most `max_cuts` cuts (0: one piece only). Returns the number of pieces; 0 when that is not enough: nothing is
  /// proven then.
  std::uint32_t cover_without_queries(const Vec3& a, const Vec3& b, const Vec3& c, std::uint32_t slot,
                                      std::uint32_t max_pieces, std::uint64_t max_cuts) {
    cuts_left_ = max_cuts;
    stack_.clear();
    stack_.push_back(whole_triangle(a, b, c, slot));
    std::uint32_t pieces = 0;
    while (!stack_.empty()) {
      const Piece piece = stack_.back();
      stack_.pop_back();
      ++pieces;
      ++counters_.pieces;
      counters_.deepest = std::max(counters_.deepest, piece.depth);
      const CornerTriangle<double> t = triangle_at(b_, piece.slot);
      const double quick = quick_bound(piece, t);
      if (done_with(quick, piece.slot)) continue;
      const bool hopeful = quick <= hopeless_targets * hopeless_targets * accepted_squared_;
      if (hopeful && done_with(largest_squared_distance(piece, t), piece.slot)) continue;
      const bool lost = pieces >= max_pieces || piece.age >= steps_of_sweep || piece.depth >= cuts_before_resolving;
      if (lost || cuts_left_ == 0) return 0;
      if (piece.count > Piece::crowded)
        push_halves_by_diagonal(piece);
      else if (piece.in_cell || !walk(piece))
        return 0;
    }
    return pieces;
  }

 private:
  /// Covers a triangle behind so many cuts by many triangles of B together, as far as that proves it; the rest becomes
  /// pieces.
  void cover_by_parity(const TriangleCorners& triangle, std::uint32_t slot, std::uint32_t cuts) {
    Piece piece = whole_triangle(triangle[0], triangle[1], triangle[2], slot);
    piece.depth = cuts;
    counters_.deepest = std::max(counters_.deepest, cuts);
    // Less by the roundings of a sum of lengths and of its square.
    const double limit = std::sqrt(accepted_squared_) * (1 - 0x1p-48);
    if (!parity_.spans_many(triangle, limit, slot)) return stack_.push_back(piece);
    if (const std::optional<double> distance = parity_.distance(triangle, limit, slot)) {
      accept(*distance * *distance, parity_.patch());
      for (const std::uint32_t too_high : parity_.too_high()) push_what_is_over(piece, too_high);
    } else if (parity_.is_worth_halving() && cuts < halved_for_parity && cuts_left_ > 0) {
      halve_for_parity(triangle, slot, cuts);
    } else {
      stack_.push_back(piece);
    }
  }

  void halve_for_parity(const TriangleCorners& triangle, std::uint32_t slot, std::uint32_t cuts) {
    count_cut();
    for (const TriangleCorners& half : halves(triangle))
      cover_by_parity(half, nearest_within_target(centroid(half), slot).slot, cuts + 1);
  }

  /// Pushes what of a piece is over or under a triangle of B that is too high.
  void push_what_is_over(const Piece& whole, std::uint32_t slot) {
    Piece rest = whole, inside, outside;
    for (const HalfSpace& space : parity_.half_spaces_over(slot)) {
      const CornerDistances sides = distances_from_plane(rest, space.normal, space.offset);
      if (sides.min > 0) return;
      if (sides.max <= 0 || !cut_and_count(rest, sides, inside, outside)) continue;
      rest = inside;
    }
    push(rest, slot, 1);
  }

  /// The triangle of B that is nearest to a point, or one within the target; starts with `slot`.
  Nearest nearest_within_target(const Vec3& p, std::uint32_t slot) {
    Nearest nearest{closest_on_triangle(triangle_at(b_, slot), p).squared_distance, slot};
    descend(b_, p, accepted_squared_, nearest, counters_.queries);
    find_nearest(b_, p, accepted_squared_, nearest, counters_.queries);
    return nearest;
  }

  void step(const Piece& piece) {
    // A look at the clock costs as much as a piece; a thousand pieces take well under a millisecond.
    if ((++counters_.pieces & 1023) == 0 && goal_.out_of_time()) cuts_left_ = 0;
    counters_.deepest = std::max(counters_.deepest, piece.depth);
    const CornerTriangle<double> t = triangle_at(b_, piece.slot);
    if (done_with(quick_bound(piece, t), piece.slot)) return;
    const Farthest farthest = farthest_corner(piece, t);
    if (done_with(farthest.squared, piece.slot)) return;
    if (cuts_left_ == 0 || decided()) return give_up(farthest.squared);
    if (piece.depth >= deepest_walk) return unfinished_.push_back({piece, farthest.squared});
    if (piece.count > Piece::crowded) return push_halves_by_diagonal(piece);
    const bool walks = !piece.in_cell && piece.splits < splits_before_resolving && piece.depth < cuts_before_resolving;
    if (must_halve(piece) || (walks && piece.age >= steps_between_queries))
      query_and_walk(piece, farthest);
    else if (!walks || !walk(piece))
      resolve(piece, farthest);
  }

  static bool must_halve(const Piece& piece) { return piece.rounds >= halve_from_rounds; }

  /// Makes room for the corners of three cuts by a cell.
  void push_halves_by_diagonal(const Piece& piece) {
    Piece first, second;
    split_by_diagonal(piece, first, second);
    stack_.push_back(first);
    stack_.push_back(second);
  }

  void push(const Piece& piece, std::uint32_t slot, std::uint32_t age, bool trimmed = false) {
    stack_.push_back(piece);
    stack_.back().slot = slot;
    stack_.back().age = age;
    stack_.back().trimmed = trimmed;
    stack_.back().in_cell = false;
    stack_.back().rival = no_slot;
  }

  void push_in_cell(const Piece& piece, std::uint32_t slot, std::uint32_t rival = no_slot) {
    push(piece, slot, 1);
    stack_.back().in_cell = true;
    stack_.back().rival = rival;
  }

  /// Pushes the parts of a piece on both sides of a line: `near` goes on with the candidate, `far` with `other`.
  void push_split(Piece& near, Piece& far, const Piece& piece, std::uint32_t other) {
    near.splits = far.splits = piece.splits + 1;
    push_in_cell(near, piece.slot, other);
    push(far, other, 1);
  }

  bool cut_and_count(const Piece& piece, const CornerDistances& sides, Piece& inside, Piece& outside) {
    if (!cut(piece, sides, inside, outside)) return false;
    count_cut();
    return true;
  }

  void count_cut() {
    ++counters_.cuts;
    if (cuts_left_ > 0) --cuts_left_;
  }

  /// Cuts the piece by the cell of its candidate and sends the parts on: by the cell pushed outward where that cuts
  /// anything, else by the cell itself. False when the piece lies inside the cell.
  bool walk(const Piece& piece) {
    const CornerTriangle<double> t = triangle_at(b_, piece.slot);
    const CellPlanes planes = cell_planes(b_, piece.slot, t);
    const double outward = piece.trimmed ? 0 : outward_slack(b_, piece, t, accepted_squared_);
    return (outward > 0 && cut_by_cell(piece, planes, outward)) || cut_by_cell(piece, planes, 0);
  }

  bool cut_by_cell(const Piece& piece, const CellPlanes& planes, double outward) {
    Piece rest = piece;
    bool changed = false;
    for (int edge = 0; edge < 3; ++edge) {
      const std::uint32_t across = b_.neighbours[piece.slot][static_cast<std::size_t>(edge)].slot;
      if (across == no_slot) continue;
      const CornerDistances sides = planes.distances(rest, edge, outward);
      if (sides.max <= plane_noise) continue;
      if (sides.min >= -plane_noise) {
        push(rest, across, piece.age + 1);
        return true;
      }
      Piece inside, outside;
      if (!cut_and_count(rest, sides, inside, outside)) continue;
      push(outside, across, piece.age + 1);
      rest = inside;
      changed = true;
    }
    if (!changed) return false;
    if (outward > 0)
      push(rest, piece.slot, piece.age, true);
    else
      push_in_cell(rest, piece.slot);
    return true;
  }

  /// A point of the piece near its worst corner, a quarter of the way to the centroid: off the ties at shared edges.
  /// For a piece that will be halved, the corner itself, which raises the lower bound most.
  static Vec3 probe_point(const Piece& piece, std::uint32_t worst) {
    const Vec3 corner = piece.corner(worst);
    if (must_halve(piece)) return corner;
    Vec3 sum;
    for (std::uint32_t i = 0; i < piece.count; ++i) sum = sum + piece.corner(i);
    return corner + 0.25 * ((1.0 / piece.count) * sum - corner);
  }

  static double squared_radius(const Piece& piece, const Vec3& from) {
    double radius = 0;
    for (std::uint32_t i = 0; i < piece.count; ++i) radius = std::max(radius, squared_length(piece.corner(i) - from));
    return radius;
  }

  void query_and_walk(const Piece& piece, const Farthest& farthest) {
    const Vec3 probe = probe_point(piece, farthest.corner);
    const Nearest nearest = nearest_within_target(probe, piece.slot);
    if (!accepts(nearest.squared)) offer(probe, nearest, piece.depth + 1);
    const double lipschitz = std::sqrt(nearest.squared) + std::sqrt(squared_radius(piece, probe));
    if (done_with(farthest.squared, piece.slot) || done_with(lipschitz * lipschitz, nearest.slot)) return;
    Piece next = piece;
    ++next.rounds;
    next.age = 0;
    next.trimmed = false;
    double bound = std::min(farthest.squared, lipschitz * lipschitz);
    Farthest worst = farthest;
    if (nearest.slot != piece.slot) {
      worst = farthest_corner(piece, triangle_at(b_, nearest.slot));
      if (done_with(worst.squared, nearest.slot)) return;
      bound = std::min(bound, worst.squared);
      next.slot = nearest.slot;
    }
    if (must_halve(piece)) return halve(next, piece.slot, next.slot, bound);
    if (next.rounds >= split_from_rounds && next.slot != piece.slot) {
      Piece undecided = next;
      undecided.slot = piece.slot;
      if (split_between(undecided, next.slot)) return;
    }
    if (!walk(next)) resolve_at_corners(next, worst.corner, bound);
  }

  /// The piece is inside the cell of its candidate t, yet a corner is too far from it: another sheet of B, or a vertex
  /// where cells by edges are not the Voronoi cells, is nearer. Asks near the worst corner, then at the corners beyond
  /// the target, and splits the piece between t and the first triangle that serves one of them better.
  void resolve(const Piece& piece, const Farthest& farthest) {
    Piece next = piece;
    ++next.rounds;
    double bound = farthest.squared;
    if (piece.splits >= splits_before_halving)
      halve_in_cell(next, bound);
    else if (!split_by_query(next, probe_point(piece, farthest.corner), bound))
      resolve_at_corners(next, farthest.corner, bound);
  }

  void resolve_at_corners(const Piece& piece, std::uint32_t worst, double bound) {
    ++counters_.resolved;
    const CornerTriangle<double> t = triangle_at(b_, piece.slot);
    for (std::uint32_t k = 0; k < piece.count; ++k) {
      const Vec3 corner = piece.corner((worst + k) % piece.count);
      if (accepts(closest_on_triangle(t, corner).squared_distance)) continue;
      if (split_by_query(piece, corner, bound)) return;
    }
    if (!done_with(bound)) halve_in_cell(piece, bound);
  }

  /// Asks for a triangle near a point of the piece, the first one within the target, and lowers `bound` by it: where
  /// many are equally near, looking for the nearest means looking at all of them. True when the piece has been bounded
  /// by that triangle, or split between it and the candidate.
  bool split_by_query(const Piece& piece, const Vec3& p, double& bound) {
    const Nearest nearest = nearest_within_target(p, piece.slot);
    if (!accepts(nearest.squared)) offer(p, nearest, piece.depth + 1);
    if (nearest.slot == piece.slot) return false;
    const double squared = farthest_corner(piece, triangle_at(b_, nearest.slot)).squared;
    bound = std::min(bound, squared);
    return done_with(squared, nearest.slot) || split_at_triple(piece, p, nearest.slot) ||
           split_between(piece, nearest.slot);
  }

  /// Splits a piece by a chord between the points of its boundary where its candidate t stops to serve: where t is
  /// neither within the target nor as near as `other`. On the near side every corner is then bounded by t, on the far
  /// side by `other`, as well as by both: a tie costs one cut, whatever the precision. False where the piece cannot be
  /// split so.
  bool split_between(const Piece& piece, std::uint32_t other) {
    const Choice choice{triangle_at(b_, piece.slot), triangle_at(b_, other),
                        std::sqrt(accepted_squared_) * (1 - 0x1p-50)};
    double excess[Piece::capacity] = {};
    for (std::uint32_t i = 0; i < piece.count; i += 2)  // the lane behind an odd count is one of those that `pad` fills
      std::tie(excess[i], excess[i + 1]) = choice.excess(piece.corner(i), piece.corner(i + 1));
    std::uint32_t changes = 0, leaves = 0, returns = 0;
    for (std::uint32_t i = 0; i < piece.count; ++i) {
      const std::uint32_t j = i + 1 == piece.count ? 0 : i + 1;
      if ((excess[i] > 0) == (excess[j] > 0)) continue;
      ++changes;
      (excess[j] > 0 ? leaves : returns) = i;
    }
    if (changes == 0 && excess[0] > 0) {  // `other` is nearer all over
      push(piece, other, 1);
      ++stack_.back().splits;
      return true;
    }
    if (changes != 2) return false;
    const auto after = [&](std::uint32_t i) { return i + 1 == piece.count ? 0 : i + 1; };
    const auto search = [&](std::uint32_t served, std::uint32_t unserved) {
      return LastServed(piece.corner(served), excess[served], piece.corner(unserved), excess[unserved]);
    };
    LastServed leaving = search(leaves, after(leaves)), returning = search(after(returns), returns);
    run_both(choice, leaving, returning);
    const BoundaryPoint leave{leaves, leaving.share()}, back{returns, 1 - returning.share()};
    Piece near, far;
    if (!cut_by_chord(piece, back, leave, near, far)) return false;
    count_cut();
    push_split(near, far, piece, other);
    return true;
  }

  /// Splits a piece from which something has been cut off, and where now a third triangle is nearest at p: by a line
  /// through the point that is equally far from all three. Chords alone would close in on that point step by step.
  bool split_at_triple(const Piece& piece, const Vec3& p, std::uint32_t third) {
    if (piece.rival == no_slot || piece.rival == third) return false;
    const CornerTriangle<double> t = triangle_at(b_, piece.slot), u = triangle_at(b_, third);
    const std::optional<Vec3> point = equidistant_point(piece, p, t, triangle_at(b_, piece.rival), u);
    if (!point) return false;
    const Vec3 normal = lead(t, u, *point).gradient;
    const CornerDistances sides = distances_from_plane(piece, normal, dot(normal, *point));
    Piece near, far;
    if (!(sides.min < 0 && sides.max > 0) || !cut_and_count(piece, sides, near, far)) return false;
    push_split(near, far, piece, third);
    return true;
  }

  /// Cuts across the longest diagonal: the parts shrink, so the Lipschitz bound ends it at last.
  bool halves_of(const Piece& piece, Piece& near, Piece& far) {
    Vec3 from, to;
    double longest = -1;
    for (std::uint32_t i = 0; i < piece.count; ++i) {
      for (std::uint32_t j = i + 1; j < piece.count; ++j) {
        const double squared = squared_length(piece.corner(j) - piece.corner(i));
        if (squared > longest) {
          longest = squared;
          from = piece.corner(i);
          to = piece.corner(j);
        }
      }
    }
    const Vec3 normal = to - from;
    const CornerDistances sides = distances_from_plane(piece, normal, dot(normal, 0.5 * (from + to)));
    if (!(sides.min < 0 && sides.max > 0) || !cut_and_count(piece, sides, near, far)) return false;
    near.rounds = far.rounds = near.splits = far.splits = 0;
    return true;
  }

  void halve(const Piece& piece, std::uint32_t near_slot, std::uint32_t far_slot, double bound) {
    Piece near, far;
    if (!halves_of(piece, near, far)) return unfinished_.push_back({piece, bound});
    push(near, near_slot, steps_between_queries);
    push(far, far_slot, steps_between_queries);
  }

  void halve_in_cell(const Piece& piece, double bound) {
    Piece near, far;
    if (!halves_of(piece, near, far)) return unfinished_.push_back({piece, bound});
    push_in_cell(near, piece.slot);
    push_in_cell(far, piece.slot);
  }

  std::uint64_t cuts_left_ = 0;
  ParityCover parity_;
  std::vector<Piece> stack_;
  std::vector<Unfinished> unfinished_;
};

}  // namespace MESHBOUND_ISA
}  // namespace meshbound
