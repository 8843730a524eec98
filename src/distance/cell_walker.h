// SPDX-License-Identifier: MIT
/// Voronoi subdivision taken to its end: a piece of A is cut along the cells of the triangles of B it crosses, each
/// part walks on to the neighbour across the cut, and is bounded by that triangle alone. Compiled once per instruction
/// set.
///
///     while a piece is left                               d(., t) is convex: the corners bound the piece
///       if every corner is within the target of its candidate t: done
///       cut it by the cell of t, pushed outward by a slack; what is outside goes to the neighbour, without a query
///       every few steps query near the worst corner: raises the lower bound, finds a better candidate
///       inside the cell and still too far: split by the bisector of two closest points
///
/// Sound for any soup: adjacency, cells and candidates choose the parts, the bound needs only that the parts cover the
/// piece (`cut`) and the convexity. Paper, section 5.2, generalised.
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "distance/piece.h"
#include "distance/proven_bounds.h"

namespace meshbound {

/// Steps without a query: long enough to cross a fan, short enough not to get lost where adjacency misleads.
inline constexpr std::uint32_t steps_between_queries = 8;
/// Steps of a walk that has no queries: across a triangle of A that lies on a thousand of B.
inline constexpr std::uint32_t steps_of_sweep = 32;
/// Corners more than so many targets off the first point that is tried on a triangle are rarely near another one of it.
inline constexpr double hopeless_targets = 3;
/// Cuts, and queries, after which a piece is only halved: it walks in circles. What is left to `deepest_cut` halves its
/// diameter thirty times.
inline constexpr std::uint32_t halve_from_depth = 60;
inline constexpr std::uint32_t halve_from_rounds = 24;
/// Corners from which a piece is halved, so that three cuts by a cell still fit.
inline constexpr std::uint32_t crowded_piece = Piece::capacity - 4;

inline namespace MESHBOUND_ISA {

class CellWalker : public ProvenBounds {
 public:
  using ProvenBounds::ProvenBounds;

  /// Covers one triangle of A, starting at triangle `slot` of B.
  void cover(const Vec3& a, const Vec3& b, const Vec3& c, std::uint32_t from_slot, std::uint32_t slot,
             std::uint64_t max_cuts) {
    set_from(from_slot);
    cuts_left_ = max_cuts;
    stack_.clear();
    stack_.push_back(whole_triangle(a, b, c, slot));
    while (!stack_.empty()) {
      const Piece piece = stack_.back();
      stack_.pop_back();
      step(piece);
    }
  }

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
      const bool lost = pieces >= max_pieces || piece.age >= steps_of_sweep || must_halve(piece);
      if (lost || cuts_left_ == 0 || !walk(piece)) return 0;
    }
    return pieces;
  }

 private:
  void step(const Piece& piece) {
    // A look at the clock costs as much as a piece; a thousand pieces take well under a millisecond.
    if ((++counters_.pieces & 1023) == 0 && goal_.out_of_time()) cuts_left_ = 0;
    counters_.deepest = std::max(counters_.deepest, piece.depth);
    const CornerTriangle<double> t = triangle_at(b_, piece.slot);
    if (done_with(quick_bound(piece, t), piece.slot)) return;
    const Farthest farthest = farthest_corner(piece, t);
    if (done_with(farthest.squared, piece.slot)) return;
    if (cuts_left_ == 0 || decided()) return give_up(farthest.squared);
    const bool due = piece.age >= steps_between_queries || must_halve(piece);
    if (due)
      query_and_walk(piece, farthest);
    else if (!walk(piece))
      push(piece, piece.slot, steps_between_queries);
  }

  static bool must_halve(const Piece& piece) {
    return piece.depth >= halve_from_depth || piece.rounds >= halve_from_rounds || piece.count > crowded_piece;
  }

  void push(const Piece& piece, std::uint32_t slot, std::uint32_t age, bool trimmed = false) {
    stack_.push_back(piece);
    stack_.back().slot = slot;
    stack_.back().age = age;
    stack_.back().trimmed = trimmed;
  }

  bool cut_and_count(const Piece& piece, const PlaneSides& sides, Piece& inside, Piece& outside) {
    if (!cut(piece, sides, inside, outside)) return false;
    ++counters_.cuts;
    if (cuts_left_ > 0) --cuts_left_;
    return true;
  }

  /// The planes of a cell: lane k runs through the edge from corner k to k + 1, along the bisector of the normals on
  /// both sides, with its unit normal pointing outward (0 where the edge has no direction). Lane 3 is unused.
  struct CellPlanes {
    Vec<Double4> normal;
    Double4 offset;
  };

  [[nodiscard]] CellPlanes planes_of(std::uint32_t slot, const CornerTriangle<double>& t) const {
    const auto& own = b_.normals[slot];
    Vec<Double4> bisector{broadcast4(own[0]), broadcast4(own[1]), broadcast4(own[2])};
    for (int edge = 0; edge < 3; ++edge) {
      const Neighbour neighbour = b_.neighbours[slot][edge];
      if (neighbour.slot == no_slot) continue;
      const auto& other = b_.normals[neighbour.slot];
      const double sign = neighbour.flipped != 0 ? -1 : 1;
      const Vec3 sum{own[0] + sign * other[0], own[1] + sign * other[1], own[2] + sign * other[2]};
      // Nearly folded back: the sum is rounding noise, and the plane across the triangle's own edge serves.
      if (squared_length(sum) < 1e-3) continue;
      bisector.x[edge] = sum.x;
      bisector.y[edge] = sum.y;
      bisector.z[edge] = sum.z;
    }
    const Vec3 bc = t.ac - t.ab, b = t.a + t.ab, c = t.a + t.ac;
    const Vec<Double4> along{{t.ab.x, bc.x, -t.ac.x, 0}, {t.ab.y, bc.y, -t.ac.y, 0}, {t.ab.z, bc.z, -t.ac.z, 0}};
    const Vec<Double4> from{{t.a.x, b.x, c.x, 0}, {t.a.y, b.y, c.y, 0}, {t.a.z, b.z, c.z, 0}};
    CellPlanes planes;
    planes.normal = cross(along, bisector);
    const Double4 norm = square_root(squared_length(planes.normal));
    planes.normal = select(norm > 0.0, 1.0 / norm, Double4{}) * planes.normal;
    planes.offset = dot(planes.normal, from);
    return planes;
  }

  /// How far the cell may be pushed outward so that most parts inside are still within the target. A part at height h
  /// over the plane of t may lie sqrt(target^2 - h^2) sideways of t; where two edges meet at 30 degrees, pushing both
  /// by s moves the corner of the cell by 4 s, hence one quarter: of 0.1 to 0.85 the fastest on eight pairs. What still
  /// fails is cut by the cell itself, where only the height counts.
  [[nodiscard]] double outward_slack(const Piece& piece, const CornerTriangle<double>& t) const {
    const auto& n = b_.normals[piece.slot];
    const PlaneSides heights = sides_of(piece, {n[0], n[1], n[2]}, n[0] * t.a.x + n[1] * t.a.y + n[2] * t.a.z);
    const double highest = std::max(heights.most, -heights.least), room = accepted_squared_ - highest * highest;
    return room > 0 ? 0.25 * std::sqrt(room) : 0;
  }

  /// Cuts the piece by the cell of its candidate and sends the parts on: by the cell pushed outward where that cuts
  /// anything, else by the cell itself. False when the piece lies inside the cell.
  bool walk(const Piece& piece) {
    const CornerTriangle<double> t = triangle_at(b_, piece.slot);
    const CellPlanes planes = planes_of(piece.slot, t);
    const double outward = piece.trimmed ? 0 : outward_slack(piece, t);
    return (outward > 0 && cut_by_cell(piece, planes, outward)) || cut_by_cell(piece, planes, 0);
  }

  bool cut_by_cell(const Piece& piece, const CellPlanes& planes, double outward) {
    constexpr double noise = 1e-13;  // corners this near to a plane lie on it: cutting there would give empty parts
    Piece rest = piece;
    bool changed = false;
    for (int edge = 0; edge < 3; ++edge) {
      const std::uint32_t across = b_.neighbours[piece.slot][static_cast<std::size_t>(edge)].slot;
      if (across == no_slot) continue;
      const Vec3 normal{planes.normal.x[edge], planes.normal.y[edge], planes.normal.z[edge]};
      const PlaneSides sides = sides_of(rest, normal, planes.offset[edge] + outward);
      if (sides.most <= noise) continue;
      if (sides.least >= -noise) {
        push(rest, across, piece.age + 1);
        return true;
      }
      Piece inside, outside;
      if (!cut_and_count(rest, sides, inside, outside)) continue;
      push(outside, across, piece.age + 1);
      rest = inside;
      changed = true;
    }
    if (changed) push(rest, piece.slot, outward > 0 ? piece.age : steps_between_queries, outward > 0);
    return changed;
  }

  /// A point of the piece near its worst corner, a quarter of the way to the centroid: off the ties at shared edges. Of
  /// a piece that is only halved, the corner itself: there the lower bound is what is wanted.
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
    Nearest nearest{closest_on_triangle(triangle_at(b_, piece.slot), probe).squared_distance, piece.slot};
    find_nearest(b_, probe, 0, nearest, counters_.queries);
    offer(probe, nearest, piece.depth + 1);
    const double lipschitz = std::sqrt(nearest.squared) + std::sqrt(squared_radius(piece, probe));
    if (done_with(farthest.squared, piece.slot) || done_with(lipschitz * lipschitz, nearest.slot)) return;
    Piece next = piece;
    ++next.rounds;
    next.age = 0;
    next.trimmed = false;
    double bound = std::min(farthest.squared, lipschitz * lipschitz);
    if (nearest.slot != piece.slot) {
      const double other = farthest_corner(piece, triangle_at(b_, nearest.slot)).squared;
      if (done_with(other, nearest.slot)) return;
      bound = std::min(bound, other);
      next.slot = nearest.slot;
    }
    if (piece.depth >= deepest_cut) return give_up(bound);
    if (must_halve(piece)) return halve(next, piece.slot, next.slot, bound);
    if (!walk(next)) resolve(next, farthest.corner, bound);
  }

  /// The piece is inside the cell of its candidate, yet a corner is too far from it: another sheet of B, or a vertex
  /// where cells by edges are not the Voronoi cells, is nearer. Ask at every corner, and split between the two answers.
  void resolve(const Piece& piece, std::uint32_t worst, double bound) {
    ++counters_.resolved;
    const CornerTriangle<double> t = triangle_at(b_, piece.slot);
    const Vec3 here = piece.corner(worst) - closest_on_triangle(t, piece.corner(worst)).offset;
    std::uint32_t other = piece.slot;
    Vec3 there;
    double apart = 0;
    for (std::uint32_t i = 0; i < piece.count; ++i) {
      const Vec3 corner = piece.corner(i);
      Nearest nearest{closest_on_triangle(t, corner).squared_distance, piece.slot};
      find_nearest(b_, corner, 0, nearest, counters_.queries);
      offer(corner, nearest, piece.depth);
      if (nearest.slot == piece.slot) continue;
      const CornerTriangle<double> candidate = triangle_at(b_, nearest.slot);
      const double squared = farthest_corner(piece, candidate).squared;
      if (done_with(squared, nearest.slot)) return;
      bound = std::min(bound, squared);
      const Vec3 point = corner - closest_on_triangle(candidate, corner).offset;
      if (squared_length(point - here) > apart) {
        apart = squared_length(point - here);
        there = point;
        other = nearest.slot;
      }
    }
    if (done_with(bound)) return;
    if (!split_between(piece, here, there, other)) halve(piece, piece.slot, other, bound);
  }

  bool split_between(const Piece& piece, const Vec3& here, const Vec3& there, std::uint32_t other) {
    if (other == piece.slot) return false;
    const Vec3 normal = there - here;
    const PlaneSides sides = sides_of(piece, normal, dot(normal, 0.5 * (here + there)));
    if (!(sides.least < 0 && sides.most > 0)) return false;
    Piece near, far;
    if (!cut_and_count(piece, sides, near, far)) return false;
    push(near, piece.slot, 1);
    push(far, other, 1);
    return true;
  }

  /// Last resort: cut across the longest diagonal; the parts shrink, so the Lipschitz bound ends it.
  void halve(const Piece& piece, std::uint32_t near_slot, std::uint32_t far_slot, double bound) {
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
    const PlaneSides sides = sides_of(piece, normal, dot(normal, 0.5 * (from + to)));
    Piece near, far;
    if (!(sides.least < 0 && sides.most > 0) || !cut_and_count(piece, sides, near, far)) return give_up(bound);
    push(near, near_slot, steps_between_queries);
    push(far, far_slot, steps_between_queries);
  }

  std::uint64_t cuts_left_ = 0;
  std::vector<Piece> stack_;
};

}  // namespace MESHBOUND_ISA
}  // namespace meshbound
