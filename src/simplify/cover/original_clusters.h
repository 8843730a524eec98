// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "meshbound/triangle_mesh.h"

namespace meshbound {

/// The triangles of an original in clusters of those that follow one another. Along a curve these lie near each other,
/// so where faces are large, most clusters are near one face alone: what it holds of all vertices of a cluster, it
/// holds of its triangles at once.
class OriginalClusters {
 public:
  /// Triangles of a cluster. Larger ones lie across the edges of faces more often, smaller ones have more vertices for
  /// each triangle.
  static constexpr std::uint32_t size = 16;
  /// Bit k stands for the k-th triangle of a cluster.
  using Members = std::uint16_t;
  /// The corners of a triangle as indices of `vertices` of its cluster.
  using Corners = std::array<std::uint8_t, 3>;

  /// O(n).
  OriginalClusters(const std::vector<Triangle>& triangles, std::size_t vertex_count);

  [[nodiscard]] std::size_t count() const { return first_vertex_.size() - 1; }
  [[nodiscard]] static std::uint32_t cluster_of(std::uint32_t triangle) { return triangle / size; }
  [[nodiscard]] static Members member(std::uint32_t triangle) {
    return static_cast<Members>(Members{1} << (triangle % size));
  }
  /// The vertices of its triangles, each once.
  [[nodiscard]] std::span<const std::uint32_t> vertices(std::uint32_t cluster) const {
    return std::span(vertices_).subspan(first_vertex_[cluster], first_vertex_[cluster + 1] - first_vertex_[cluster]);
  }
  static constexpr std::size_t max_vertices = std::size_t{3} * size;  ///< of one cluster
  /// Its triangles; the first one is original `size` times `cluster`.
  [[nodiscard]] std::span<const Corners> triangles(std::uint32_t cluster) const {
    const std::size_t first = std::size_t{cluster} * size;
    return std::span(corners_).subspan(first, std::min<std::size_t>(size, corners_.size() - first));
  }

 private:
  std::vector<std::uint32_t> vertices_, first_vertex_{0};
  std::vector<Corners> corners_;  ///< by triangle
};

}  // namespace meshbound
