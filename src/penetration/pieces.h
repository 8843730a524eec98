// SPDX-License-Identifier: MIT
/// The surface of each of two models inside the other: whole triangles, found by flooding from the curves, and the
/// pieces that the curves cut out of the triangles they cross.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "numeric/disjoint_sets.h"
#include "penetration/curves.h"
#include "penetration/piece_plane.h"
#include "penetration/placed_pair.h"

namespace meshbound {

/// A closed line in a triangle with a piece on its left, seen against the normal.
struct PieceCycle {
  std::uint32_t begin = 0, end = 0;  ///< in `Pieces::corners`
  std::uint32_t piece = no_index;
  std::uint32_t next_hole = no_index;  ///< the next hole of the piece
  bool on_border = false;              ///< part of it runs along an edge of the triangle
};

/// A connected piece of a triangle.
struct Piece {
  std::uint32_t side = 0, triangle = 0;
  std::uint32_t outer = no_index;  ///< the cycle around it; `no_index`: the whole triangle, perhaps with holes
  std::uint32_t holes = no_index;  ///< the first of the cycles around its holes

  [[nodiscard]] bool is_whole_triangle() const { return outer == no_index && holes == no_index; }
};

class Pieces {
 public:
  /// Finds all pieces of both sides and the shells that they form: the closed surfaces that bound the intersection.
  /// Fills `cycle` of the nodes.
  void find(PlacedPair& pair, CrossingCurves& curves);

  std::vector<Piece> pieces;
  std::vector<PieceCycle> cycles;
  std::vector<PieceCorner> corners;
  DisjointSets shells;  ///< sets of pieces
  DisjointSets faces;   ///< sets of pieces of one plane that are connected across edges

  /// The corners of the border of a piece: the cycle around it and those of its holes. Valid until the next call.
  [[nodiscard]] std::span<const std::span<const PieceCorner>> border_of(const Piece& piece);
  /// The corners of a cycle.
  [[nodiscard]] std::span<const PieceCorner> corners_of(const PieceCycle& cycle) const {
    return std::span(corners).subspan(cycle.begin, cycle.end - cycle.begin);
  }

 private:
  using EdgePieces = std::array<std::uint32_t, 3>;

  void trace(std::uint32_t side, std::uint32_t triangle);
  void trace_cycle(std::uint32_t side, std::uint32_t triangle, std::uint32_t segment);
  std::uint32_t walk_border(std::uint32_t side, std::uint32_t triangle, std::uint32_t node, std::uint32_t cycle);
  std::uint32_t add_piece(std::uint32_t side, std::uint32_t triangle, std::uint32_t outer);
  void settle_loops(std::uint32_t side, std::uint32_t triangle);
  std::uint32_t piece_around(std::uint32_t hole, std::uint32_t side, std::uint32_t triangle);
  void flood(std::uint32_t side);
  void flood_across(std::uint32_t side, std::uint32_t piece, std::size_t k);
  std::uint32_t whole_piece(std::uint32_t side, std::uint32_t triangle);
  void flood_uncut_components(std::uint32_t side);
  void unite(std::uint32_t piece, std::uint32_t next, const ModelEdge& edge);
  void join_along_curves();

  PlacedPair* pair_ = nullptr;
  CrossingCurves* curves_ = nullptr;
  std::array<std::vector<std::uint8_t>, 2> traced_;  ///< by side and segment
  std::array<SparseArray<EdgePieces>, 2> at_edges_;  ///< of crossed triangles: the piece along each edge without nodes
  std::array<SparseArray<std::uint32_t>, 2> whole_;  ///< by triangle: the piece with the whole triangle as its outside
  std::vector<std::uint32_t> open_;                  ///< pieces to flood from
  CornerTriple whole_triangle_;                      ///< the border of the piece asked for last, if it is one
  std::vector<std::span<const PieceCorner>> border_;
  std::vector<std::uint32_t> loops_;  ///< cycles off the border, of the triangle being traced
};

}  // namespace meshbound
