// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "cgal/collapse_policies.h"
#include "cgal/estimated_phase.h"
#include "cgal/parts.h"
#include "cgal/refinement.h"
#include "meshbound/cgal/deviation_monitor.h"
#include "meshbound/cgal/simplify_with_bound.h"
#include "meshbound/stop_token.h"

namespace meshbound::cgal {

/// When a `CollapseRun` ends, beside where nothing fits. Lengths as in its mesh.
struct CollapseGoal {
  double tolerance = 0;
  double room = 0;  ///< taken off the tolerance before anything is proven
  std::size_t target_faces = 0;
  StopToken stop;        ///< of collapses
  StopToken stop_proof;  ///< of the proof of those made by an estimate: later
};

/// What the run of a part left, to be joined with the others.
struct FinishedPart {
  static constexpr std::uint32_t none = DeviationMonitor<SurfaceMesh>::Part::none;
  struct Vertex {
    Kernel::Point_3 point;
    std::uint32_t on_seam = none;  ///< the vertex of the polygons that were cut; none where it is not on a seam
    std::uint32_t soup_vertex = 0;
    bool locked = false;
    Quadric quadric;
    Heights heights;  ///< of an estimate only
  };
  std::vector<Vertex> vertices;
  std::vector<Polygon> polygons;                      ///< of places in `vertices`
  std::vector<std::uint32_t> triangle_of_face;        ///< of the soup, by polygon
  std::vector<std::array<std::uint32_t, 2>> settled;  ///< edges that need not be tried again
  DeviationMonitor<SurfaceMesh>::Part proof;          ///< its `face_of` are places in `polygons`
  DeviationMonitor<SurfaceMesh>::Counts counts;
  TrackerStats stats;
  EstimatedCollapses estimated;
  std::uint64_t work = 0;
  EndedBy ended_by = EndedBy::NothingFits;
};

struct JoinedParts {
  ManifoldCopy copy;
  std::vector<bool> locked;
  std::vector<Quadric> quadrics;                      ///< by vertex
  std::vector<Heights> heights;                       ///< by vertex; of an estimate only
  std::vector<bool> on_seam;                          ///< by vertex
  std::vector<std::array<std::uint32_t, 2>> settled;  ///< vertices
  std::vector<DeviationMonitor<SurfaceMesh>::Part> proofs;
  DeviationMonitor<SurfaceMesh>::Counts counts;
  TrackerStats stats;
  EstimatedCollapses estimated;
  std::uint64_t work = 0;
};

/// A mesh that was proven to stand for an original, and what is known of it.
struct ProvenMesh {
  ManifoldPolygons polygons;
  std::vector<bool> locked;       ///< by vertex
  std::vector<Quadric> quadrics;  ///< by vertex
  TrackedProof proof;             ///< its faces are places in `polygons`
};

/// A part of such a mesh. Its original has all triangles that its faces stand for, some of them together with faces of
/// other parts: these stay.
struct ProvenPart {
  Part part;
  std::vector<Quadric> quadrics;  ///< by vertex
  TrackedProof proof;             ///< its faces are places in the polygons of `part`
};

/// A mesh under collapses: the monitor that proves them, their cost and placement, and the passes over the edges.
class CollapseRun {
 public:
  using Monitor = DeviationMonitor<SurfaceMesh>;

  /// `copy` was made from `original`, and `locked` tells by vertex of the copy, or is empty, which of them stay where
  /// they are. `original` and `options` must outlive this.
  CollapseRun(ManifoldCopy copy, const TriangleMesh& original, const SimplifyOptions& options,
              const std::vector<bool>& locked);
  /// Of a part, whose vertices on seams stay where they are as well.
  CollapseRun(Part part, const Seams& seams, const SimplifyOptions& options, const std::vector<bool>& locked);
  /// Goes on with a part of a mesh that is proven already.
  CollapseRun(ProvenPart part, const Seams& seams, const SimplifyOptions& options, const std::vector<bool>& locked);
  [[nodiscard]] FinishedPart finished();
  /// In place of a run: only its first collapses, by an estimate. Where nothing keeps from estimating.
  [[nodiscard]] FinishedPart estimated_part(const CollapseGoal& goal);
  /// Goes on where the runs of parts ended: with a mesh joined from theirs. `original` is the whole, and `tree` its
  /// own.
  CollapseRun(JoinedParts joined, const TriangleMesh& original, Bvh tree, const SimplifyOptions& options,
              double tolerance);
  /// The same of estimated parts: the collapses at their seams are estimated as well, and all is proven. False where
  /// that failed; nothing else may be called then.
  CollapseRun(JoinedParts joined, const TriangleMesh& original, const SimplifyOptions& options);
  [[nodiscard]] bool prove_estimated(const CollapseGoal& goal);
  /// Before any other collapse.
  [[nodiscard]] ProvenMesh proven_mesh() const;
  /// Of the original; nothing else may be called then.
  [[nodiscard]] Bvh take_tree() { return monitor_->take_original_bvh(); }
  CollapseRun(const CollapseRun&) = delete;
  CollapseRun& operator=(const CollapseRun&) = delete;

  /// Collapses edges until nothing fits or the goal is reached. The tolerance, less the room, must be above 0 and not
  /// smaller than in the call before. Throws `Stopped` where the time ends before anything was proven, but not for a
  /// part, which stays as it was then.
  EndedBy run(const CollapseGoal& goal);

  /// True until the first run has a proof of what it collapsed by an estimate.
  [[nodiscard]] bool is_unproven() const { return !monitor_; }
  [[nodiscard]] const ManifoldCopy& copy() const { return copy_; }
  /// By triangle of the original, before the first run: see `DeviationTracker::limit_triangles`.
  void limit_triangles(std::span<const double> tolerances) { monitor_->limit_triangles(tolerances); }
  /// Triangles of the original that the mesh has no face for and near: kept as they are.
  [[nodiscard]] std::vector<std::uint32_t> uncovered() const;
  [[nodiscard]] Monitor::Counts counts() const;
  [[nodiscard]] TrackerStats stats() const;
  [[nodiscard]] const EstimatedCollapses& estimated() const { return estimated_; }
  [[nodiscard]] const Monitor::Dropped& pruned() const { return pruned_; }
  /// Of the last run; nothing where no more collapses fit.
  [[nodiscard]] std::optional<EndedBy> ended_by() const { return ended_by_; }
  /// All that was done in this run, as a share of it counts in `JoinedParts::work`.
  [[nodiscard]] std::uint64_t work_of_estimate() const { return estimated_work_ + work(); }

 private:
  /// `edge_collapse` filter: the monitor's, and for OnExceed::Stop the end of the run where a refusal is confirmed.
  class Filter;

  [[nodiscard]] bool must_stop(std::size_t faces);
  void note_stop();
  [[nodiscard]] bool truly_exceeds();
  [[nodiscard]] TriangleMesh after_refused_collapse() const;
  [[nodiscard]] bool may_estimate() const;
  void estimate();
  [[nodiscard]] bool try_estimates(const SurfaceMesh& start);
  [[nodiscard]] bool estimate_without(const std::vector<bool>& frozen);
  void run_phase(std::vector<bool> frozen, const KeptParts& kept);
  [[nodiscard]] StopToken stop_of_proof() const;
  [[nodiscard]] bool prove_phase();
  [[nodiscard]] std::vector<std::uint32_t> take_mesh(FinishedPart& result) const;
  [[nodiscard]] std::vector<bool> around_unproven(const SurfaceMesh& start) const;
  void start_exactly();
  void set_up_monitor();
  [[nodiscard]] std::vector<std::array<std::uint32_t, 2>> settled_edges(const std::vector<std::uint32_t>& place) const;
  [[nodiscard]] bool is_locked(SurfaceMesh::Vertex_index v) const;
  [[nodiscard]] KeptParts kept_parts() const;
  void prune();
  void pass();
  void passes_until_nothing_fits();
  void refine(std::uint64_t work_of_passes);
  /// Proofs of original triangles so far: what most of the time goes with.
  [[nodiscard]] std::uint64_t work() const { return stats().originals_tested; }
  void show_progress(std::size_t faces);

  std::optional<Part> part_;
  std::vector<Heights> heights_;  ///< of parts that were estimated, until the estimate goes on
  std::vector<bool> beside_seam_;
  std::optional<PartSeam> seam_;
  const TriangleMesh& original_;
  const SimplifyOptions& options_;
  ManifoldCopy copy_;
  std::vector<bool> locked_;
  std::optional<EstimatedPhase> phase_;  ///< while there is no monitor
  std::optional<Monitor> monitor_;
  std::optional<CollapsePolicies> policies_;
  std::optional<Refinement> refinement_;
  Monitor::Counts counts_of_parts_;  ///< that were joined
  TrackerStats stats_of_parts_;
  std::uint64_t work_of_parts_ = 0;  ///< until the first run

  CollapseGoal goal_;
  std::uint64_t stop_checks_ = 0;
  std::optional<EndedBy> ended_by_;
  Monitor::Dropped pruned_;
  EstimatedCollapses estimated_;
  std::uint64_t estimated_work_ = 0;  ///< of this run, as `work`
  std::uint64_t work_of_run_ = 0;     ///< with it, before any refinement
};

}  // namespace meshbound::cgal
