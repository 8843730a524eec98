// SPDX-License-Identifier: MIT
#pragma once
#include <optional>

#include "meshbound/attributes.h"
#include "simplify/decimation.h"

namespace meshbound {

/// Makes the levels of one original, one after the other: by a decimation, or as copies of the original if the time ran
/// out before one could start. Not thread-safe.
class LevelRun {
 public:
  using Clock = StopToken::Clock;

  /// Prepares the decimation; `original` and `options` must outlive this. Throws as `simplify_with_bound`, `options`
  /// being checked already.
  LevelRun(const TriangleMesh& original, const SimplifyOptions& options);

  /// Continues to this tolerance, which must not be smaller than that of the call before, or until `target_faces` are
  /// left. The level is not measured.
  [[nodiscard]] SimplifiedLevel next(double tolerance, std::size_t target_faces);
  /// As `Decimation::set_texture_tolerance`, for the levels that follow.
  void set_texture_tolerance(double tolerance);
  /// Undoes what has led to refuted triangles of the last level, as `Decimation::take_back`; `next` then makes a level
  /// for the tolerance of the call before once more.
  [[nodiscard]] bool take_back(std::span<const Refuted> refuted);
  /// Edges of the original that are feature lines.
  [[nodiscard]] const std::vector<Edge>& lines() const { return lines_; }
  /// Fills everything in the result but its levels and the times of measurements.
  void describe(SimplifyResult& result) const;

 private:
  template <class Work>
  void until_stopped(const Work& work);
  [[nodiscard]] StopToken stop() const;
  void take_original(SimplifiedLevel& level) const;

  const TriangleMesh& original_;
  const SimplifyOptions& options_;
  double prepare_seconds_ = 0, simplify_seconds_ = 0;
  std::optional<Decimation> decimation_;
  std::vector<Edge> lines_;
  /// Set if the time ran out before the decimation began: the original then stands for every level.
  std::optional<EndedBy> stopped_;
};

/// All levels of a run by ascending tolerance, not measured. Parts that `attributes` mark as copies of each other stay
/// copies. Throws as `simplify_with_bound`.
[[nodiscard]] SimplifyResult decimate_levels(const TriangleMesh& original, const SimplifyOptions& options,
                                             const MeshAttributes& attributes = {});

}  // namespace meshbound
