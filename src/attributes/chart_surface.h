// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "attributes/seams.h"
#include "geometry/position_table.h"
#include "mesh/first_use.h"
#include "meshbound/bvh.h"
#include "numeric/buckets.h"

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

/// A mesh with its charts, for closest points on one chart at a time. Triangles that repeat others are left out. Not
/// thread-safe: what is asked for is built then.
class ChartSurface {
 public:
  /// `mesh` must outlive this; `charts` are its own.
  ChartSurface(const TriangleMesh& mesh, ChartPartition charts);

  [[nodiscard]] const ChartPartition& charts() const { return charts_; }
  [[nodiscard]] std::uint32_t chart_of(std::uint32_t triangle) const { return charts_.chart_of[triangle]; }
  /// Corners 3 t + k of triangles at exactly this position.
  [[nodiscard]] std::span<const std::uint32_t> corners_at(const Eigen::Vector3d& p);
  [[nodiscard]] std::array<Eigen::Vector3d, 3> corners(std::uint32_t triangle) const;
  /// The closest point of a chart.
  [[nodiscard]] WeightedPoint closest(std::uint32_t chart, const Eigen::Vector3d& p);

 private:
  /// Tells which corners are at a position.
  struct CornersAt {
    CornersAt(const TriangleMesh& mesh, const ChartPartition& charts);

    std::vector<Vec3> positions;
    PositionTable table;
    Buckets<std::uint32_t> corners;  ///< by first vertex at a position
  };

  [[nodiscard]] TriangleMesh mesh_of(std::uint32_t chart);

  const TriangleMesh& mesh_;
  ChartPartition charts_;
  Buckets<std::uint32_t> triangles_of_;      ///< by chart
  std::optional<CornersAt> corners_at_;      ///< once asked for
  std::vector<std::unique_ptr<Bvh>> trees_;  ///< by chart, once asked for
  FirstUse number_in_chart_;                 ///< of vertices, while a tree is built
};

}  // namespace meshbound
