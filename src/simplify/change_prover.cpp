// SPDX-License-Identifier: MIT
#include "simplify/change_prover.h"

#include <algorithm>

#include "simplify/proof_worker.h"
#include "simplify/repair.h"

namespace meshbound {

bool ChangeProver::is_near(std::uint32_t face) {
  if (state_.mesh.is_removed(face) || !state_.is_unproven(face)) return true;
  ++faces_tested;
  return workers_.of_thread(thread_).is_near(face, state_.nearest[face]);
}

bool ChangeProver::prove(const Split& split, Region& region) {
  ProofWorkers::Worker& worker = workers_.of_thread(thread_);
  const auto stamps = region.log.stamps_of(region.log.last_number());
  const bool is_covered = worker.cover_change(stamps, split, region.id);
  originals_tested += worker.affected();
  const auto is_near_original = [&](const EditLog::Stamp& stamp) { return is_near(stamp.face); };
  if (is_covered && std::all_of(stamps.begin(), stamps.end(), is_near_original)) return true;
  ++unproven;
  undo_last(state_, region);
  return false;
}

bool ChangeProver::met_seam() const { return workers_.of_thread(thread_).meets_seam(); }

const std::optional<Vec3>& ChangeProver::lost_point() const { return workers_.of_thread(thread_).lost_point(); }

void ChangeProver::accept(Region& region) {
  ++proven;
  workers_.of_thread(thread_).assign_covers(state_.cover);
  for (const EditLog::Stamp& stamp : region.log.stamps_of(region.log.last_number())) state_.stamp[stamp.face] = 0;
  if (state_.proven_changes) region.proven.append(region.log);
  region.log.clear();
}

bool ChangeProver::prove_group(const Split& split, Region& region) {
  ProofWorkers::Worker& worker = workers_.of_thread(thread_);
  changed_.clear();
  for (const EditLog::Stamp& stamp : region.log.stamps)
    if (stamp.before == 0) changed_.push_back(stamp.face);
  const bool is_covered = worker.cover_group(changed_, split, region.id);
  originals_tested += worker.affected();
  if (!is_covered || !std::all_of(changed_.begin(), changed_.end(), [&](std::uint32_t f) { return is_near(f); })) {
    ++unproven;
    return false;
  }
  ++proven;
  worker.assign_covers(state_.cover);
  for (const std::uint32_t face : changed_) state_.stamp[face] = 0;
  region.log.clear();
  return true;
}

}  // namespace meshbound
