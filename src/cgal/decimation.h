// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <vector>

#include "cgal/collapse_run.h"
#include "cgal/joined_parts.h"
#include "meshbound/cgal/simplify_with_bound.h"
#include "simplify/spatial_order.h"
#include "simplify/working_frame.h"

namespace meshbound::cgal {

/// One decimation under growing tolerances: the working copy in its frame, and the way there and back.
class Decimation {
 public:
  /// `options` must outlive this. Throws `Stopped`.
  Decimation(const TriangleMesh& original, const SimplifyOptions& options, const StopToken& stop);

  /// Collapses edges until nothing fits, `target_faces` are left or `stop` says so. `tolerance` in model units, not
  /// smaller than in the call before. Throws `Stopped` where nothing was proven by then; nothing else may be called
  /// after that.
  EndedBy run(double tolerance, std::size_t target_faces, const StopToken& stop);

  /// The mesh as it is now, in model coordinates, the triangles that are kept as they are included. What is left of the
  /// original comes in its order.
  [[nodiscard]] TriangleMesh current_mesh() const;
  [[nodiscard]] CollapseRun::Monitor::Counts counts() const { return run_->counts(); }
  void describe(SimplifyResult& result) const;

 private:
  [[nodiscard]] Eigen::Vector3d in_model(const Kernel::Point_3& p) const;
  void sort_start_points();
  [[nodiscard]] std::optional<std::uint32_t> first_at(const Eigen::Vector3d& p) const;
  void start_whole();
  /// Decimates the parts and joins them in `run_`, which goes on from there.
  EndedBy run_parts(const CollapseGoal& goal);
  /// The same with the first collapses estimated over the seams of a first cut, and a second one where they end. None
  /// where what was estimated could not be proven.
  std::optional<EndedBy> run_estimated_parts(const CollapseGoal& goal, const Cutting& cutting);
  [[nodiscard]] double room() const;
  [[nodiscard]] std::vector<bool> locked_copies() const;
  [[nodiscard]] std::vector<double> limits_in_frame() const;

  std::size_t input_vertices_;
  SpatialOrder order_;
  const TriangleMesh& original_;  ///< `order_.mesh`: all indices here are its
  const SimplifyOptions& options_;
  WorkingFrame frame_;
  TriangleMesh framed_original_;
  std::vector<std::uint32_t> by_start_point_;  ///< its vertices sorted by place
  std::optional<ManifoldPolygons> polygons_;   ///< until the first run
  std::size_t dropped_triangles_ = 0;
  bool split_ = false;
  std::vector<bool> locked_;    ///< by vertex of the polygons, or empty
  std::vector<double> limits_;  ///< by triangle, or empty
  std::optional<CollapseRun> run_;
  bool below_rounding_ = false;
};

}  // namespace meshbound::cgal
