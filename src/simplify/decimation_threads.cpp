// SPDX-License-Identifier: MIT
#include "simplify/decimation_threads.h"

namespace meshbound {

DecimationThreads::DecimationThreads(DecimationState& state, int threads) : workers(state, threads) {
  for (int i = 0; i < threads; ++i) {
    proposers.push_back(std::make_unique<Proposer>(state));
    provers.push_back(std::make_unique<ChangeProver>(state, workers, static_cast<std::size_t>(i)));
  }
}

CollapseCounts DecimationThreads::counts() const {
  CollapseCounts counts = together;
  for (const auto& proposer : proposers) {
    counts.tried += proposer->counts.tried;
    counts.refused += proposer->counts.refused;
  }
  for (const auto& prover : provers) {
    counts.proven_alone += prover->proven;
    counts.unproven += prover->unproven;
    counts.originals_tested += prover->originals_tested;
    counts.faces_tested += prover->faces_tested;
  }
  return counts;
}

}  // namespace meshbound
