// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "numeric/no_index.h"
#include "simplify/mesh/array_mesh.h"

namespace meshbound {

/// Which collapses feature lines allow.
enum class OnLines : std::uint8_t {
  Free,         ///< no end lies on a line
  AtStart,      ///< only to where the start of the edge is
  AtEnd,        ///< only to where its end is
  AtEitherEnd,  ///< along a line, to either of its ends
  Refused       ///< it would leave a line, join two, or move an end of one
};

/// Lines on a mesh that a decimation keeps: borders and marked edges. Vertices of a line only ever stand where the
/// start mesh has vertices of that line.
///
/// A line vertex with two line edges is inside a line; any other one is an end, and stays. An edge of a line thus
/// stands for a chain of line edges of the start mesh between its ends. If all vertices of the chain lie within a
/// distance of the edge, chain and edge lie within it of each other, both ways: the distance to a segment is convex
/// along each edge of the chain; and the closest point on the segment moves continuously along the chain from one end
/// of the segment to the other, so that each point of the segment is the closest one of some point of the chain.
///
/// Which edges are lines is marked at their corners, and an edge that a collapse merges is a line if one of the two
/// was. What a collapse changes is small enough to be kept for its undoing (`Before`). Vertices of different regions
/// may be changed by different threads.
class FeatureLines {
 public:
  /// No lines at all, not even borders.
  FeatureLines() = default;
  /// `is_marked` says of each corner whether the edge that starts there is a line, beside borders. O(n).
  FeatureLines(const ArrayMesh& start, std::vector<std::uint8_t> is_marked);

  [[nodiscard]] bool empty() const { return at_.empty(); }
  [[nodiscard]] bool is_line(const ArrayMesh& mesh, Corner c) const {
    if (empty()) return false;
    const Corner twin = mesh.twin(c);
    return twin == no_index || is_marked_[c] != 0 || is_marked_[twin] != 0;
  }
  [[nodiscard]] bool is_on_line(std::uint32_t vertex) const { return !empty() && at_[vertex] != no_index; }
  /// The vertex of the start mesh where this vertex stands; `no_index` off the lines.
  [[nodiscard]] std::uint32_t at(std::uint32_t vertex) const { return empty() ? no_index : at_[vertex]; }

  [[nodiscard]] OnLines allowed(const ArrayMesh& mesh, Corner edge) const;
  /// How far the line edge that a collapse along `edge` makes, to the position of its start or of its end, and the
  /// chain it stands for are from each other, squared. Linear in the length of the chain.
  [[nodiscard]] double squared_deviation(const ArrayMesh& mesh, Corner edge, bool to_start) const;

  /// What a collapse changes here.
  struct Before {
    std::uint32_t at = no_index;  ///< of the vertex that is kept
    std::uint8_t marks = 0;       ///< of the corners outside the faces that go
  };
  [[nodiscard]] Before before(const ArrayMesh& mesh, Corner edge) const;
  /// Before the mesh makes the end of the edge its start, at `point`.
  void collapse(const ArrayMesh& mesh, Corner edge, Vec3 point);
  /// After the mesh took that back.
  void undo_collapse(const ArrayMesh& mesh, Corner edge, const Before& before);

 private:
  [[nodiscard]] bool is_inside_line(std::uint32_t vertex) const { return neighbours_[at_[vertex]][1] != no_index; }
  [[nodiscard]] std::uint32_t other_neighbour(const ArrayMesh& mesh, std::uint32_t vertex, Corner edge) const;
  template <class Visit>
  std::uint32_t walk(std::uint32_t from, std::size_t direction, std::uint32_t first, std::uint32_t second,
                     const Visit& visit) const;

  std::vector<std::uint8_t> is_marked_;  ///< by corner: the edge that starts there is a line
  std::vector<std::uint32_t> at_;        ///< by vertex
  std::vector<Vec3> position_;           ///< of the vertices of the start mesh
  /// By vertex of the start mesh: the two others of its line edges, if it is inside a line; else `no_index`.
  std::vector<std::array<std::uint32_t, 2>> neighbours_;
};

}  // namespace meshbound
