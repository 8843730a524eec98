// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "attributes/seams.h"
#include "geometry/position_table.h"
#include "meshbound/bvh.h"

namespace meshbound {

/// A point of a triangle by its barycentric coordinates.
struct WeightedPoint {
  std::uint32_t triangle = 0;
  Eigen::Vector3d weights = {1, 0, 0};

  /// A corner 3 t + k.
  [[nodiscard]] static WeightedPoint at_corner(std::uint32_t corner) {
    return {corner / 3, Eigen::Vector3d::Unit(static_cast<Eigen::Index>(corner % 3))};
  }
  /// The corner with the largest weight; the first one among equals.
  [[nodiscard]] std::size_t nearest_corner() const;
};

/// A mesh with its charts, for closest points on one chart at a time. Not thread-safe: trees are built when first used.
class ChartSurface {
 public:
  /// `mesh` must outlive this. Throws as `charts`.
  ChartSurface(const TriangleMesh& mesh, const MeshAttributes& attributes,
               NormalSeams normal_seams = NormalSeams::Ignored);

  [[nodiscard]] std::uint32_t chart_of(std::uint32_t triangle) const { return charts_.chart_of[triangle]; }
  /// Corners 3 t + k of triangles at exactly this position.
  [[nodiscard]] const std::vector<std::uint32_t>& corners_at(const Eigen::Vector3d& p) const;
  [[nodiscard]] std::array<Eigen::Vector3d, 3> corners(std::uint32_t triangle) const;
  /// The closest point of a chart.
  [[nodiscard]] WeightedPoint closest(std::uint32_t chart, const Eigen::Vector3d& p);

 private:
  [[nodiscard]] TriangleMesh mesh_of(const std::vector<std::uint32_t>& triangles) const;

  const TriangleMesh& mesh_;
  ChartPartition charts_;
  std::vector<Vec3> positions_;
  std::optional<PositionTable> at_position_;
  std::vector<std::vector<std::uint32_t>> corners_at_;    ///< by first vertex at a position
  std::vector<std::vector<std::uint32_t>> triangles_of_;  ///< by chart
  std::vector<std::unique_ptr<Bvh>> trees_;               ///< by chart, built when first used
};

}  // namespace meshbound
