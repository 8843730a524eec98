// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "penetration/pieces.h"

namespace meshbound {

/// The borders of faces. A face is a set of pieces of one plane that are connected across edges: a polygon with far
/// fewer corners than its pieces have together, as edges within it are left out, and corners where its border goes
/// straight on. Both follow from which planes meet where, without arithmetic: two stretches of border in a row that
/// lie in the same second plane lie in one line.
class FaceBorders {
 public:
  void begin(const PlacedPair& pair, const CrossingCurves& curves, Pieces& pieces);

  /// Traces the border of a face: closed lines with the face on their left, seen against its normal. Lines that enclose
  /// nothing are left out. Valid until the next call.
  std::span<const std::span<const PieceCorner>> trace(std::span<const std::uint32_t> face);

 private:
  /// A stretch of border: a segment of the curves or, if that is `no_index`, edge `k` of a triangle from its first
  /// corner on.
  struct Stretch {
    std::uint32_t segment = no_index, triangle = no_index;
    std::size_t k = 0;
    friend bool operator==(const Stretch&, const Stretch&) = default;
  };

  void trace_from(std::span<const PieceCorner> cycle, std::uint32_t triangle);
  void trace_line(const Stretch& first);
  [[nodiscard]] bool is_traced(const Stretch& stretch) const;
  Stretch follow(const Stretch& stretch);
  [[nodiscard]] Stretch along_edge(std::uint32_t triangle, std::size_t k, std::uint32_t after) const;
  [[nodiscard]] std::size_t index_of(std::uint32_t edge, std::uint32_t triangle) const;
  [[nodiscard]] const ModelEdge& edge(std::uint32_t triangle, std::size_t k) const;
  void add(PieceCorner corner, std::uint32_t side, std::uint32_t triangle);
  void end_line(std::size_t begin);

  const PlacedPair* pair_ = nullptr;
  const CrossingCurves* curves_ = nullptr;
  Pieces* pieces_ = nullptr;
  std::uint32_t side_ = 0;
  const ClosedModel::Data* model_ = nullptr;                      ///< of that side
  std::array<std::vector<std::uint8_t>, 2> traced_segments_;      ///< by side and segment
  std::array<SparseArray<std::array<bool, 3>>, 2> traced_edges_;  ///< by side and triangle: its edges
  std::vector<PieceCorner> corners_;
  std::vector<std::array<std::uint32_t, 2>> planes_;  ///< by corner: the second plane of the stretch after it
  std::vector<std::size_t> ends_;                     ///< by line: where its corners end
  std::vector<std::span<const PieceCorner>> lines_;
};

}  // namespace meshbound
