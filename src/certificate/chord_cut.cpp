// SPDX-License-Identifier: MIT
#include "certificate/chord_cut.h"

#include <array>
#include <cmath>

namespace meshbound {
namespace {

constexpr std::array<int, 4> sizes_of_ends = {8, 16, 32, 48};  ///< bits, as the format has them

/// A point where the plane meets the outline of the piece.
struct Crossing {
  std::uint32_t edge = 0;
  double share = 0;
  double length = 0;  ///< of the edge, working units
};

/// The two points where the plane meets the outline, or nothing where there are not two.
std::optional<std::array<Crossing, 2>> crossings(const Piece& piece, const CornerDistances& sides) {
  std::array<Crossing, 2> found;
  std::size_t count = 0;
  for (std::uint32_t i = 0; i < piece.count; ++i) {
    const std::uint32_t j = i + 1 == piece.count ? 0 : i + 1;
    const double s = sides.value[i], e = sides.value[j];
    const bool crosses = (s < 0 && e > 0) || (s > 0 && e < 0);
    if (!crosses && s != 0) continue;
    if (count == 2) return std::nullopt;
    found[count++] = {i, crosses ? s / (s - e) : 0, length(piece.corner(j) - piece.corner(i))};
  }
  if (count < 2) return std::nullopt;
  return found;
}

ChordEnd snapped(const Crossing& crossing, int bits, std::uint32_t corners) {
  const double steps = std::round(std::ldexp(crossing.share, bits));
  if (steps >= std::ldexp(1.0, bits)) return {(crossing.edge + 1) % corners, 0};
  return {crossing.edge, static_cast<std::uint64_t>(steps)};
}

Vec3 point_on(const Piece& piece, const ChordEnd& end, int bits) {
  const Vec3 from = piece.corner(end.edge), to = piece.corner((end.edge + 1) % piece.count);
  return from + std::ldexp(static_cast<double>(end.numerator), -bits) * (to - from);
}

/// The parts of a chord; nothing when one of them has no area or does not fit.
std::optional<ChordCut> parts_of(const Piece& piece, const Chord& chord) {
  const std::uint32_t from = chord.from.edge, to = chord.to.edge;
  const bool starts_between = chord.from.numerator != 0, ends_between = chord.to.numerator != 0;
  const std::uint32_t first_count = to - from + 1 + (ends_between ? 1 : 0);
  const std::uint32_t second_count = 1 + (piece.count - 1 - to) + from + 1 + (starts_between ? 1 : 0);
  if (std::min(first_count, second_count) < 3 || std::max(first_count, second_count) > Piece::capacity)
    return std::nullopt;
  const Vec3 start = point_on(piece, chord.from, chord.bits), end = point_on(piece, chord.to, chord.bits);
  ChordCut cut;
  cut.chord = chord;
  cut.first.add(start);
  for (std::uint32_t i = from + 1; i <= to; ++i) cut.first.add(piece.corner(i));
  if (ends_between) cut.first.add(end);
  cut.second.add(end);
  for (std::uint32_t i = to + 1; i < piece.count; ++i) cut.second.add(piece.corner(i));
  for (std::uint32_t i = 0; i <= from; ++i) cut.second.add(piece.corner(i));
  if (starts_between) cut.second.add(start);
  for (Piece* part : {&cut.first, &cut.second}) {
    part->pad();
    part->slot = piece.slot;
    part->depth = piece.depth + 1;
    part->rounds = piece.rounds;
    part->age = piece.age;
  }
  return cut;
}

}  // namespace

std::optional<ChordCut> cut_by_chord(const Piece& piece, const CornerDistances& sides, double max_shift) {
  const auto ends = crossings(piece, sides);
  if (!ends) return std::nullopt;
  const double longest = std::max((*ends)[0].length, (*ends)[1].length);
  for (const int bits : sizes_of_ends) {
    if (bits < sizes_of_ends.back() && std::ldexp(longest, -bits - 1) > max_shift) continue;
    Chord chord{snapped((*ends)[0], bits, piece.count), snapped((*ends)[1], bits, piece.count), bits};
    if (chord.from.edge > chord.to.edge) std::swap(chord.from, chord.to);
    if (chord.from.edge == chord.to.edge) continue;
    if (auto cut = parts_of(piece, chord)) return cut;
  }
  return std::nullopt;
}

}  // namespace meshbound
