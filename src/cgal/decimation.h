// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <chrono>
#include <optional>

#include "cgal/collapse_policies.h"
#include "cgal/refinement.h"
#include "cgal/spatial_order.h"
#include "cgal/working_frame.h"
#include "meshbound/cgal/deviation_monitor.h"
#include "meshbound/cgal/simplify_with_bound.h"

namespace meshbound::cgal {

/// One decimation under growing tolerances: the working copy in its frame, the monitor, and the passes over it.
class Decimation {
 public:
  using Monitor = DeviationMonitor<SurfaceMesh>;

  /// `options` must outlive this.
  Decimation(const TriangleMesh& original, const SimplifyOptions& options);

  /// Collapses edges until nothing fits, `target_faces` are left or `seconds` have passed. `tolerance` in model units,
  /// not smaller than in the call before.
  EndedBy run(double tolerance, std::size_t target_faces, double seconds);

  /// The mesh as it is now, in model coordinates, the triangles that are kept as they are included. What is left of the
  /// original comes in its order.
  [[nodiscard]] TriangleMesh current_mesh() const;
  [[nodiscard]] const Monitor& monitor() const { return *monitor_; }
  void describe(SimplifyResult& result) const;

 private:
  /// `edge_collapse` filter: the monitor's, and for OnExceed::Stop the end of the run where a refusal is confirmed.
  class Filter;

  [[nodiscard]] bool must_stop(std::size_t faces);
  [[nodiscard]] bool truly_exceeds();
  [[nodiscard]] TriangleMesh after_refused_collapse() const;
  [[nodiscard]] Eigen::Vector3d in_model(const Kernel::Point_3& p) const;
  void lock_vertices();
  void limit_faces();
  [[nodiscard]] double room() const;
  [[nodiscard]] std::vector<bool> locked_copies() const;
  [[nodiscard]] KeptParts kept_parts() const;
  void prune();
  void pass();
  void passes_until_nothing_fits();
  void refine(std::uint64_t work_of_passes);
  /// Proofs of original triangles so far: what most of the time goes with.
  [[nodiscard]] std::uint64_t work() const { return monitor_->tracker().stats().originals_tested; }
  void show_progress(std::size_t faces);

  std::size_t input_vertices_;
  SpatialOrder order_;
  const TriangleMesh& original_;  ///< `order_.mesh`: all indices here are its
  const SimplifyOptions& options_;
  WorkingFrame frame_;
  TriangleMesh framed_original_;
  ManifoldCopy copy_;
  std::vector<Kernel::Point_3> start_points_;              ///< by vertex index, in the frame
  std::vector<SurfaceMesh::Vertex_index> by_start_point_;  ///< sorted by these
  std::optional<Monitor> monitor_;
  std::optional<CollapsePolicies> policies_;
  std::optional<Refinement> refinement_;

  using Clock = std::chrono::steady_clock;
  double frame_tolerance_ = 0;
  std::size_t target_faces_ = 0;
  Clock::time_point began_;
  double seconds_ = 0;
  std::uint64_t stop_checks_ = 0;
  std::optional<EndedBy> ended_by_;
  bool below_rounding_ = false;
  bool has_locks_ = false;
  Monitor::Dropped pruned_;
};

}  // namespace meshbound::cgal
