// SPDX-License-Identifier: MIT
#pragma once
#include <optional>

#include "meshbound/attributes.h"
#include "simplify/decimation.h"

namespace meshbound {

/// The levels of one original, one after the other: a decimation, and what replaces it where the time ended
/// before there was one. Not thread-safe.
class LevelRun {
 public:
  using Clock = StopToken::Clock;

  /// Prepares the decimation; `original` and `options` must outlive this. Throws as `simplify_with_bound`, `options`
  /// being checked already.
  LevelRun(const TriangleMesh& original, const SimplifyOptions& options);

  /// Goes on to this tolerance, not smaller than the one before, and to at least `target_faces`. Not measured.
  [[nodiscard]] SimplifiedLevel next(double tolerance, std::size_t target_faces);
  /// Edges of the original that are lines.
  [[nodiscard]] const std::vector<Edge>& lines() const { return lines_; }
  /// Everything of the result but for its levels and times of measurements.
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
  std::optional<EndedBy> stopped_;  ///< before anything was decimated: the original itself stands for every level
};

/// The levels of a run, ascending, not measured. Where `attributes` say that parts are copies of each other, they stay
/// so. Throws as `simplify_with_bound`.
[[nodiscard]] SimplifyResult decimate_levels(const TriangleMesh& original, const SimplifyOptions& options,
                                             const MeshAttributes& attributes = {});

}  // namespace meshbound
