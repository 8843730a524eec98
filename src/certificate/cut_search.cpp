// SPDX-License-Identifier: MIT
#include "certificate/cut_search.h"

#include <algorithm>
#include <cmath>

#include "proof/cell_planes.h"

namespace meshbound {
namespace {

/// The limits of the engine's walk (distance/kernel/cell_walker.h).
constexpr std::uint32_t steps_between_queries = 8;
constexpr std::uint32_t halve_from_depth = 60, halve_from_rounds = 24;
constexpr std::uint32_t crowded_piece = Piece::capacity - 4;

/// Steps of a cover between two looks at the clock: one may ask for a nearest triangle among thousands.
constexpr std::uint64_t steps_between_looks = 16;

bool must_halve(const Piece& piece) {
  return piece.depth >= halve_from_depth || piece.rounds >= halve_from_rounds || piece.count > crowded_piece;
}

Vec3 middle_of(const Piece& piece) {
  Vec3 sum;
  for (std::uint32_t i = 0; i < piece.count; ++i) sum = sum + piece.corner(i);
  return (1.0 / piece.count) * sum;
}

/// Whether the first part is the one on the negative side.
bool first_is_inside(const Piece& piece, const CornerDistances& sides, const Chord& chord) {
  double first = 0;
  for (std::uint32_t i = chord.from.edge + 1; i <= chord.to.edge; ++i)
    if (std::fabs(sides.value[i]) > std::fabs(first)) first = sides.value[i];
  double second = 0;
  for (std::uint32_t i = 0; i < piece.count; ++i)
    if ((i <= chord.from.edge || i > chord.to.edge) && std::fabs(sides.value[i]) > std::fabs(second))
      second = sides.value[i];
  return first < second;
}

}  // namespace

CutSearch::CutSearch(const Bvh::Data& target, const std::vector<std::array<std::uint32_t, 3>>& neighbours,
                     const Goal& goal, double magnitude, std::size_t max_patch)
    : b_(target),
      stop_(goal.stop),
      tolerance_(goal.tolerance),
      parity_(target, neighbours, goal, magnitude, max_patch) {
  for (std::uint32_t depth = 0; depth <= deepest_cut; ++depth) {
    const double accepted = goal.tolerance - goal.slack - depth * goal.cut_slack;
    // A length is rounded four times on its way from the offset, relative to itself.
    accepted_squared_[depth] = accepted > 0 ? accepted * accepted * (1 - 8 * 0x1p-53) : -1;
  }
}

/// How far the ends of a cut may be moved so that few bits describe them. Deeper pieces, where coarse cuts have failed,
/// get finer ones.
double CutSearch::max_shift(const Piece& piece) const {
  const double share = piece.depth < 8 ? 0x1p-4 : piece.depth < 24 ? 0x1p-8 : piece.depth < 48 ? 0x1p-16 : 0x1p-32;
  return share * tolerance_;
}

void CutSearch::emit(std::uint32_t slot, ProofNode::Kind kind) {
  last_ = slot;
  ProofNode node;
  node.kind = kind;
  node.target = b_.triangle_of_slot[slot];
  nodes_->push_back(node);
}

bool CutSearch::try_near(const Piece& piece, std::uint32_t slot) {
  if (!(farthest_corner(piece, triangle_at(slot)).squared <= accepted_squared_[piece.depth])) return false;
  emit(slot);
  return true;
}

/// The triangle nearest to a point of a piece. Where even that is too far, no triangle will do, and further cuts only
/// add rounding: sets `too_far_`.
Nearest CutSearch::nearest(const Vec3& p, const Piece& piece, std::uint32_t hint) {
  Nearest best{closest_on_triangle(triangle_at(hint), p).squared_distance, hint};
  find_nearest(b_, p, 0, best, counters_);
  if (!(best.squared <= accepted_squared_[piece.depth])) too_far_ = true;
  return best;
}

/// Tries the triangles nearest to the middle and the corners of a piece, and their neighbours, for the whole piece: one
/// triangle saves bytes.
bool CutSearch::try_candidates(const Piece& piece) {
  std::array<std::uint32_t, 4> slots;
  slots[0] = nearest(middle_of(piece), piece, piece.slot).slot;
  if (piece.depth == 0) nearest_to_middle_ = slots[0];
  for (std::uint32_t k = 0; k < 3; ++k) slots[k + 1] = nearest(piece.corner(k), piece, slots[0]).slot;
  if (too_far_) return false;
  for (const std::uint32_t slot : slots)
    if (try_near(piece, slot)) return true;
  for (const std::uint32_t slot : slots)
    for (const Neighbour& across : b_.neighbours[slot])
      if (across.slot != no_slot && try_near(piece, across.slot)) return true;
  return false;
}

CutSearch::Outcome CutSearch::prove(const TriangleCorners& triangle, std::uint32_t& hint, std::vector<ProofNode>& nodes,
                                    std::uint64_t max_steps) {
  stop_.check();
  nodes_ = &nodes;
  steps_left_ = max_steps;
  too_far_ = false;
  const std::size_t before = nodes.size();
  Piece whole = whole_triangle(triangle[0], triangle[1], triangle[2], hint);
  triangle_ = triangle;
  bool proven = try_near(whole, hint) || try_candidates(whole);
  if (!proven && !too_far_) {
    whole.slot = nearest_to_middle_;
    proven =
        try_parity(whole) || (parity_.patch_was_too_large() ? halve_by_parity(whole) : cover_interior_by_parity(whole));
    if (!proven) {
      nodes.resize(before);
      too_far_ = false;  // perhaps only by the rounding of these cuts
      proven = cover(whole);
    }
  }
  hint = last_;
  if (proven) return Outcome::Proven;
  nodes.resize(before);
  return too_far_ ? Outcome::TooFar : Outcome::GaveUp;
}

bool CutSearch::try_parity(const Piece& piece) {
  const std::uint32_t seed = nearest(middle_of(piece), piece, piece.slot).slot;
  if (too_far_ || !parity_.proves(triangle_, piece, seed)) return false;
  emit(seed, ProofNode::Kind::Parity);
  return true;
}

/// A face that ends a little beside a crease sticks out there, by up to the tolerance, and has no parity proof. Without
/// strips along some of its sides it often has one, and only the strips need pieces.
bool CutSearch::cover_interior_by_parity(const Piece& piece) {
  constexpr std::array<unsigned, 7> subsets_of_sides = {1, 2, 4, 3, 5, 6, 7};  // few strips first
  for (const double width : {1.25, 4.0})
    for (const unsigned sides : subsets_of_sides) {
      const std::size_t before = nodes_->size();
      if (try_trimmed(piece, sides, width * tolerance_)) return true;
      nodes_->resize(before);
      if (too_far_) return false;
    }
  return false;
}

bool CutSearch::try_trimmed(const Piece& piece, unsigned sides, double width) {
  std::vector<Trim> trims;
  Piece rest = piece;
  const Vec3 normal = cross(triangle_[1] - triangle_[0], triangle_[2] - triangle_[0]);
  for (std::size_t side = 0; side < 3; ++side) {
    if ((sides >> side & 1) == 0) continue;
    const Vec3 from = triangle_[side], outward = cross(triangle_[(side + 1) % 3] - from, normal);
    const double norm = length(outward);
    if (!(norm > 0)) return false;
    const Vec3 unit = (1 / norm) * outward;
    const CornerDistances distances = distances_from_plane(rest, unit, dot(unit, from) - width);
    if (!(distances.min < 0 && distances.max > 0)) return false;
    auto cut = cut_by_chord(rest, distances, max_shift(rest));
    if (!cut) return false;
    trims.push_back({*cut, first_is_inside(rest, distances, cut->chord)});
    rest = trims.back().rest();
  }
  const std::uint32_t seed = nearest(middle_of(rest), rest, rest.slot).slot;
  return !too_far_ && parity_.proves(triangle_, rest, seed) && emit_trimmed(trims, 0, seed);
}

bool CutSearch::emit_trimmed(const std::vector<Trim>& trims, std::size_t from, std::uint32_t seed) {
  if (from == trims.size()) {
    emit(seed, ProofNode::Kind::Parity);
    return true;
  }
  const Trim& trim = trims[from];
  emit_cut(trim.cut.chord);
  if (trim.rest_is_first) return emit_trimmed(trims, from + 1, seed) && cover_part(trim.strip());
  return cover_part(trim.strip()) && emit_trimmed(trims, from + 1, seed);
}

/// Halves a piece whose patch has too many triangles, until the patches are small enough.
bool CutSearch::halve_by_parity(const Piece& piece) {
  const auto cut = halves_of(piece);
  if (!cut) return false;
  emit_cut(cut->chord);
  return cover_part(cut->first) && cover_part(cut->second);
}

bool CutSearch::cover_part(Piece part) {
  if (try_candidates(part)) return true;
  part.slot = nearest(middle_of(part), part, part.slot).slot;
  if (too_far_) return false;
  return try_parity(part) || (parity_.patch_was_too_large() ? halve_by_parity(part) : cover(part));
}

bool CutSearch::cover(Piece piece) {
  while (steps_left_ > 0) {
    if (--steps_left_ % steps_between_looks == 0) stop_.check();
    const Farthest farthest = farthest_corner(piece, triangle_at(piece.slot));
    if (farthest.squared <= accepted_squared_[piece.depth]) {
      emit(piece.slot);
      return true;
    }
    if (piece.depth >= deepest_cut) return false;
    const bool due = piece.age >= steps_between_queries;
    if (must_halve(piece) || due) {
      if (ask_near_worst(piece, farthest.corner)) return true;
      if (too_far_) return false;
      if (must_halve(piece)) return halve(piece);
    }
    const Walked walked = walk(piece);
    if (walked.cut) return walked.covered;
    if (walked.moved) continue;
    if (due) return resolve(piece, farthest.corner);
    piece.age = steps_between_queries;
  }
  return false;
}

void CutSearch::emit_cut(const Chord& chord) {
  ProofNode node;
  node.kind = ProofNode::Kind::Cut;
  node.chord = chord;
  nodes_->push_back(node);
}

bool CutSearch::cover_parts(const ChordCut& cut) {
  emit_cut(cut.chord);
  return cover(cut.first) && cover(cut.second);
}

/// Takes the triangle nearest to a point of the piece near its worst corner, off the ties at shared edges. True when
/// the whole piece is near that.
bool CutSearch::ask_near_worst(Piece& piece, std::uint32_t worst) {
  const Vec3 corner = piece.corner(worst);
  const Vec3 probe = must_halve(piece) ? corner : corner + 0.25 * (middle_of(piece) - corner);
  const Nearest found = nearest(probe, piece, piece.slot);
  ++piece.rounds;
  piece.age = 0;
  piece.slot = found.slot;
  return try_near(piece, found.slot);
}

/// Cuts the piece by the cell of its candidate, pushed outward first so that most parts inside are near enough.
CutSearch::Walked CutSearch::walk(Piece& piece) {
  const CornerTriangle<double> t = triangle_at(piece.slot);
  const double outward = outward_slack(b_, piece, t, accepted_squared_[piece.depth]);
  // Moved by more than there is room beside the triangle, the ends of a cut would leave parts that are not near enough.
  const double shift = outward > 0 ? std::min(max_shift(piece), outward / 4) : max_shift(piece);
  const double margin = std::max(plane_noise, 2 * shift);
  const CellPlanes planes = cell_planes(b_, piece.slot, t);
  for (const double push : {outward, 0.0}) {
    for (int edge = 0; edge < 3; ++edge) {
      const std::uint32_t across = b_.neighbours[piece.slot][static_cast<std::size_t>(edge)].slot;
      if (across == no_slot) continue;
      const CornerDistances sides = planes.distances(piece, edge, push);
      if (sides.max <= (push > 0 ? margin : plane_noise)) continue;
      if (sides.min >= -margin) {
        piece.slot = across;
        ++piece.age;
        return {.moved = true};
      }
      auto cut = cut_by_chord(piece, sides, shift);
      if (!cut) continue;
      const bool inside_first = first_is_inside(piece, sides, cut->chord);
      Piece& outside = inside_first ? cut->second : cut->first;
      outside.slot = across;
      ++outside.age;
      return {.cut = true, .covered = cover_parts(*cut)};
    }
    if (outward == 0) break;
  }
  return {};
}

/// The piece is inside the cell of its candidate, yet a corner is too far from it: splits it between that candidate and
/// the triangle that is nearest to a corner, of all corners the one furthest from here.
bool CutSearch::resolve(const Piece& piece, std::uint32_t worst) {
  const CornerTriangle<double> t = triangle_at(piece.slot);
  const Vec3 here = piece.corner(worst) - closest_on_triangle(t, piece.corner(worst)).offset;
  std::uint32_t other = piece.slot;
  Vec3 there;
  double apart = 0;
  for (std::uint32_t i = 0; i < piece.count; ++i) {
    const Vec3 corner = piece.corner(i);
    const Nearest found = nearest(corner, piece, piece.slot);
    if (too_far_) return false;
    if (found.slot == piece.slot) continue;
    if (try_near(piece, found.slot)) return true;
    const Vec3 point = corner - closest_on_triangle(triangle_at(found.slot), corner).offset;
    if (squared_length(point - here) > apart) {
      apart = squared_length(point - here);
      there = point;
      other = found.slot;
    }
  }
  if (other == piece.slot) return halve(piece);
  const Vec3 normal = there - here;
  const CornerDistances sides = distances_from_plane(piece, normal, dot(normal, 0.5 * (here + there)));
  auto cut = sides.min < 0 && sides.max > 0 ? cut_by_chord(piece, sides, max_shift(piece)) : std::nullopt;
  if (!cut) return halve(piece);
  const bool inside_first = first_is_inside(piece, sides, cut->chord);
  (inside_first ? cut->second : cut->first).slot = other;
  cut->first.age = cut->second.age = 1;
  return cover_parts(*cut);
}

/// Halves a piece for which nothing else helped.
bool CutSearch::halve(const Piece& piece) {
  const auto cut = halves_of(piece);
  return cut && cover_parts(*cut);
}

/// The halves of a piece, cut across its longest diagonal.
std::optional<ChordCut> CutSearch::halves_of(const Piece& piece) const {
  Vec3 from, to;
  double longest = -1;
  for (std::uint32_t i = 0; i < piece.count; ++i) {
    for (std::uint32_t j = i + 1; j < piece.count; ++j) {
      const double squared = squared_length(piece.corner(j) - piece.corner(i));
      if (squared <= longest) continue;
      longest = squared;
      from = piece.corner(i);
      to = piece.corner(j);
    }
  }
  const Vec3 normal = to - from;
  const CornerDistances sides = distances_from_plane(piece, normal, dot(normal, 0.5 * (from + to)));
  return cut_by_chord(piece, sides, max_shift(piece));
}

}  // namespace meshbound
