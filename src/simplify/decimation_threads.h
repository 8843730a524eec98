// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <vector>

#include "meshbound/simplify.h"
#include "simplify/change_prover.h"
#include "simplify/propose.h"

namespace meshbound {

/// Scratch memory of the threads of a decimation, kept from level to level.
class DecimationThreads {
 public:
  /// `state` must outlive this.
  DecimationThreads(DecimationState& state, int threads);

  [[nodiscard]] int count() const { return static_cast<int>(proposers.size()); }
  [[nodiscard]] CollapseCounts counts() const;

  ProofWorkers workers;
  std::vector<std::unique_ptr<Proposer>> proposers;    ///< by thread
  std::vector<std::unique_ptr<ChangeProver>> provers;  ///< by thread
  CollapseCounts together;                             ///< counts of what was proven together
};

}  // namespace meshbound
