// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <vector>

#include "meshbound/attributes.h"

namespace meshbound {

/// Vertices for formats that keep attributes at vertices: corners of one vertex of the mesh become one only where they
/// also have one value of each attribute.
struct SplitVertices {
  std::vector<std::uint32_t> corners;  ///< by vertex: its first corner in the mesh, 3 t + k
  std::vector<Triangle> triangles;     ///< in the order they were given, by vertices of this

  /// The vertex of the mesh that a vertex stands for.
  [[nodiscard]] std::uint32_t source(const TriangleMesh& mesh, std::size_t vertex) const {
    return mesh.triangles[corners[vertex] / 3][corners[vertex] % 3];
  }
  /// The index of the value of an attribute at a vertex, or `CornerAttribute::none`; `index` is the attribute's by
  /// triangle.
  [[nodiscard]] std::uint32_t value(const std::vector<Triangle>& index, std::size_t vertex) const {
    return index.empty() ? CornerAttribute::none : index[corners[vertex] / 3][corners[vertex] % 3];
  }
};

/// Splits the vertices of the triangles that are given by number, and numbers the results in the order of first use.
/// `indices` are those of the attributes that the format keeps, none of them null; an empty one means that the mesh
/// lacks the attribute. Expected O(n).
[[nodiscard]] SplitVertices split_vertices(const TriangleMesh& mesh, const std::vector<std::uint32_t>& triangles,
                                           const std::vector<const std::vector<Triangle>*>& indices);

/// The colours among the attributes, with 3 or 4 numbers; null where there are none.
[[nodiscard]] const NamedAttribute* colours_of(const MeshAttributes& attributes);

/// Whether every number of a colour is a multiple of 1/255 from 0 to 1, as when the file had bytes.
[[nodiscard]] bool holds_bytes(const NamedAttribute& colours);

}  // namespace meshbound
