// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <vector>

#include "meshbound/normal_deviation.h"
#include "normals/stand_ins.h"

namespace meshbound {

/// Compares the normals of one mesh with those of others, each of which differs little from the one before: what stands
/// for a face is looked for again only where something near it has changed.
class NormalComparison {
 public:
  /// As `normal_deviation`, with equal results. A must be the same mesh in all calls.
  [[nodiscard]] NormalDeviation measure(const MeshView& a, const MeshView& b, const NormalDeviationOptions& options);

 private:
  void forget_changed(const MeshView& a, const StandIns& now, int threads);

  std::unique_ptr<const StandIns> before_;  ///< of the last call; null before it
  std::vector<NearStandIns> near_;          ///< by face of A
};

}  // namespace meshbound
