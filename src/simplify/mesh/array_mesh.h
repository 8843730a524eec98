// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "geometry/triangle_corners.h"
#include "geometry/vec3.h"
#include "meshbound/triangle_mesh.h"
#include "numeric/no_index.h"

namespace meshbound {

/// Corner 3 f + k is corner k of face f. It stands for the edge of the face that starts there as well.
using Corner = std::uint32_t;

inline Corner next_corner(Corner c) { return c % 3 == 2 ? c - 2 : c + 1; }
inline Corner previous_corner(Corner c) { return c % 3 == 0 ? c + 2 : c - 1; }

/// A number for each corner, made of rows for the faces.
class CornerTable {
 public:
  CornerTable() = default;
  explicit CornerTable(std::vector<std::array<std::uint32_t, 3>> rows) : rows_(std::move(rows)) {}

  [[nodiscard]] std::uint32_t operator[](Corner c) const {
    return reinterpret_cast<const std::uint32_t*>(rows_.data())[c];
  }
  [[nodiscard]] std::uint32_t& operator[](Corner c) { return reinterpret_cast<std::uint32_t*>(rows_.data())[c]; }

 private:
  std::vector<std::array<std::uint32_t, 3>> rows_;
};

/// An oriented 2-manifold with borders in plain arrays, under edge collapses, flips and moved vertices that can be
/// undone in reverse order.
///
/// Vertices, faces and corners keep their numbers for good. What a collapse removes stays in the arrays as it was,
/// which is all that its undoing needs.
class ArrayMesh {
 public:
  ArrayMesh() = default;
  /// Corners of faces are indices of `positions`; `twins` are the corners across the edges, or `no_index` at borders.
  /// The faces around a vertex must be one fan or ring.
  ArrayMesh(std::vector<Vec3> positions, std::vector<Triangle> faces, std::vector<std::array<std::uint32_t, 3>> twins);

  [[nodiscard]] std::size_t vertex_count() const { return positions_.size(); }  ///< removed ones too
  [[nodiscard]] std::size_t face_count() const { return removed_.size(); }      ///< removed ones too
  [[nodiscard]] bool is_removed(std::uint32_t face) const { return removed_[face] != 0; }
  [[nodiscard]] bool is_vertex(std::uint32_t v) const { return corner_of_[v] != no_index; }
  [[nodiscard]] Vec3 position(std::uint32_t v) const { return positions_[v]; }
  [[nodiscard]] std::uint32_t vertex(Corner c) const { return vertices_[c]; }
  [[nodiscard]] Corner twin(Corner c) const { return twins_[c]; }
  [[nodiscard]] Corner corner_of(std::uint32_t v) const { return corner_of_[v]; }
  [[nodiscard]] std::uint32_t start(Corner c) const { return vertices_[c]; }
  [[nodiscard]] std::uint32_t end(Corner c) const { return vertices_[next_corner(c)]; }
  [[nodiscard]] std::uint32_t apex(Corner c) const { return vertices_[previous_corner(c)]; }
  [[nodiscard]] Triangle corners(std::uint32_t face) const {
    return {vertices_[3 * face], vertices_[3 * face + 1], vertices_[3 * face + 2]};
  }
  [[nodiscard]] TriangleCorners triangle(std::uint32_t face) const {
    return {positions_[vertices_[3 * face]], positions_[vertices_[3 * face + 1]], positions_[vertices_[3 * face + 2]]};
  }
  /// The number of an edge: one of its corners, the same from both sides.
  [[nodiscard]] Corner edge(Corner c) const { return twins_[c] < c ? twins_[c] : c; }

  /// Calls `visit(corner)` for the corner of each face around a vertex until one call returns false. A fan at a border
  /// is visited in two runs. Returns whether all were visited.
  template <class Visit>
  bool for_each_corner(std::uint32_t v, const Visit& visit) const {
    const Corner first = corner_of_[v];
    for (Corner c = first;;) {
      if (!visit(c)) return false;
      c = twins_[previous_corner(c)];
      if (c == first) return true;
      if (c == no_index) break;
    }
    for (Corner c = twins_[first]; c != no_index; c = twins_[c]) {
      c = next_corner(c);
      if (!visit(c)) return false;
    }
    return true;
  }
  /// Whether a vertex has more faces than `count`. O(count).
  [[nodiscard]] bool has_more_faces(std::uint32_t v, std::size_t count) const {
    std::size_t faces = 0;
    return !for_each_corner(v, [&](Corner) { return ++faces <= count; });
  }
  [[nodiscard]] bool is_border(std::uint32_t v) const;
  /// Calls `visit(edge)` once for each edge at a vertex.
  template <class Visit>
  void for_each_edge(std::uint32_t v, const Visit& visit) const {
    for_each_corner(v, [&](Corner c) {
      visit(edge(c));
      const Corner entering = previous_corner(c);
      if (twins_[entering] == no_index) visit(entering);
      return true;
    });
  }

  void move(std::uint32_t v, Vec3 to) { positions_[v] = to; }
  /// The end of the edge becomes its start. The edge must satisfy the link condition (`EdgeStar`).
  void collapse(Corner edge);
  /// Takes back the last collapse that changed what is around this edge. Positions stay.
  void undo_collapse(Corner edge);
  /// Turns the edge between two faces to their apexes; `edge` is the turned edge afterwards. `undo_flip` takes it back.
  void flip(Corner edge);
  void undo_flip(Corner edge);
  /// Removes all faces of a component with their vertices, and puts them back.
  void remove_component(std::span<const std::uint32_t> faces);
  void restore_component(std::span<const std::uint32_t> faces);

 private:
  void remove_face(Corner edge, std::uint32_t kept);
  void restore_face(Corner edge);
  void glue(Corner c, Corner d);
  void turn(Corner edge, bool back);

  std::vector<Vec3> positions_;
  std::vector<Corner> corner_of_;      ///< by vertex: one of its corners; none for removed ones
  std::vector<std::uint8_t> removed_;  ///< by face
  CornerTable vertices_, twins_;
};

}  // namespace meshbound
