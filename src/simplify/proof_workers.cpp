// SPDX-License-Identifier: MIT
#include "simplify/proof_workers.h"

#include "numeric/tasks.h"
#include "simplify/proof_worker.h"

namespace meshbound {

ProofWorkers::ProofWorkers(const DecimationState& state, int threads) : workers_(static_cast<std::size_t>(threads)) {
  with_team(threads, [&] {
    for_each_task(workers_.size(), [&](std::size_t i) { workers_[i] = std::make_unique<Worker>(state); });
  });
}
ProofWorkers::~ProofWorkers() = default;

bool ProofWorkers::cover_anywhere(std::span<const std::uint32_t> originals, const FaceBoxes& boxes,
                                  std::vector<IdList>& covers) {
  covers.resize(originals.size());
  workers_.front()->forget_faces();
  for (std::size_t i = 0; i < originals.size(); ++i) {
    covers[i].assign(workers_.front()->cover_anywhere(originals[i], boxes));
    if (covers[i].empty()) return false;
  }
  return true;
}

}  // namespace meshbound
