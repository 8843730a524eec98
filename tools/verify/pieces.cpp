// SPDX-License-Identifier: MIT
#include "verify/pieces.h"

#include <cmath>

namespace meshbound::verify {

void PieceCorners::start(const Corners& triangle) {
  triangle_ = triangle;
  corners_.assign(3, {});
  for (std::size_t k = 0; k < 3; ++k) {
    corners_[k].rough = to_vec<Interval>(triangle[k]);
    corners_[k].way = corners_[k].rough - corners_[0].rough;
  }
}

/// Parents lie on strictly smaller places and on the path of cuts to the piece, so the recursion is as deep as the
/// tree.
const Vec<Exact>& PieceCorners::exact(std::uint32_t i) {
  Corner& corner = corners_[i];
  if (corner.exact) return *corner.exact;
  if (i < 3) {
    corner.exact = to_vec<Exact>(triangle_[i]);
  } else {
    Exact share = std::ldexp(static_cast<double>(corner.numerator), -corner.bits);
    const Vec<Exact>& from = exact(corner.from);
    corner.exact = from + share * (exact(corner.to) - from);
  }
  return *corner.exact;
}

/// A numerator of 0 is the corner itself.
std::uint32_t PieceCorners::point_on(const Piece& piece, const Token::End& end, int bits) {
  const std::uint32_t from = piece[end.edge], to = piece[(end.edge + 1) % piece.size()];
  if (end.numerator == 0) return from;
  const double share = std::ldexp(static_cast<double>(end.numerator), -bits);  // at most 48 bits: exact
  const auto between = [share](const Vec<Interval>& p, const Vec<Interval>& q) {
    return p + Interval(share) * (q - p);
  };
  corners_.push_back({between(rough(from), rough(to)), between(way(from), way(to)), from, to, end.numerator, bits, {}});
  return size() - 1;
}

std::pair<Piece, Piece> PieceCorners::cut(const Piece& piece, const Token& chord) {
  if (chord.to.edge >= piece.size()) throw Rejected("a chord ends on an edge that its piece does not have");
  const std::uint32_t from = point_on(piece, chord.from, chord.bits), to = point_on(piece, chord.to, chord.bits);
  Piece first{from}, second{to};
  for (std::uint32_t i = chord.from.edge + 1; i <= chord.to.edge; ++i) first.push_back(piece[i]);
  if (chord.to.numerator != 0) first.push_back(to);
  for (std::size_t i = chord.to.edge + 1; i < piece.size(); ++i) second.push_back(piece[i]);
  for (std::uint32_t i = 0; i <= chord.from.edge; ++i) second.push_back(piece[i]);
  if (chord.from.numerator != 0) second.push_back(from);
  if (first.size() > max_corners || second.size() > max_corners) throw Rejected("a piece has too many corners");
  return {std::move(first), std::move(second)};
}

}  // namespace meshbound::verify
