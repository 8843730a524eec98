// SPDX-License-Identifier: MIT
#include "simplify/change_prover.h"

#include <algorithm>

#include "simplify/proof_worker.h"
#include "simplify/repair.h"

namespace meshbound {

bool ChangeProver::is_near(std::uint32_t face) {
  if (state_.mesh.is_removed(face) || state_.is_fixed[face] != 0) return true;
  ++faces_tested;
  return workers_.of_thread(thread_).is_near(face, state_.nearest[face]);
}

bool ChangeProver::are_near(std::span<const std::uint32_t> faces) {
  return std::all_of(faces.begin(), faces.end(), [&](std::uint32_t f) { return is_near(f); });
}

bool ChangeProver::prove(const Split& split, Region& region, std::span<const std::uint32_t> changed) {
  ProofWorkers::Worker& worker = workers_.of_thread(thread_);
  const bool is_covered = worker.cover_change(changed, split, region.id);
  originals_tested += worker.affected();
  if (is_covered && are_near(changed)) return true;
  ++unproven;
  undo_last(state_, region);
  return false;
}

bool ChangeProver::met_seam() const { return workers_.of_thread(thread_).meets_seam(); }

const std::optional<Vec3>& ChangeProver::lost_point() const { return workers_.of_thread(thread_).lost_point(); }

void ChangeProver::accept(Region& region) {
  ++proven;
  workers_.of_thread(thread_).assign_covers(state_.cover);
  // All else was proven before, so vertices that these changes have left alone have no number either.
  for (const Edit& edit : region.log.edits)
    for (const std::uint32_t v : {state_.mesh.start(edit.edge), state_.mesh.end(edit.edge)})
      state_.last_changes.set(v, 0);
  if (state_.proven_changes) region.proven.append(region.log);
  region.log.clear();
}

bool ChangeProver::prove_group(const Split& split, Region& region, std::span<const std::uint32_t> changed) {
  ProofWorkers::Worker& worker = workers_.of_thread(thread_);
  const bool is_covered = worker.cover_group(changed, split, region.id);
  originals_tested += worker.affected();
  if (!is_covered || !are_near(changed)) {
    ++unproven;
    return false;
  }
  accept(region);
  return true;
}

}  // namespace meshbound
