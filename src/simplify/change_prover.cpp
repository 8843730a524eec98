// SPDX-License-Identifier: MIT
#include "simplify/change_prover.h"

#include "simplify/proof_worker.h"
#include "simplify/repair.h"

namespace meshbound {

bool ChangeProver::prove(const Split& split, Region& region) {
  ProofWorkers::Worker& worker = workers_.of_thread(thread_);
  const auto stamps = region.log.stamps_of(region.log.last_number());
  bool holds = worker.cover_change(stamps, split, region.id);
  met_seam_ = !holds && worker.meets_seam();
  originals_tested += worker.affected();
  for (const EditLog::Stamp& stamp : stamps) {
    if (!holds) break;
    if (state_.mesh.is_removed(stamp.face)) continue;
    holds = worker.is_near(stamp.face, state_.nearest[stamp.face]);
    ++faces_tested;
  }
  if (!holds) {
    ++unproven;
    undo_last(state_, region);
    return false;
  }
  return true;
}

void ChangeProver::accept(Region& region) {
  ++proven;
  workers_.of_thread(thread_).assign_covers(state_.cover);
  for (const EditLog::Stamp& stamp : region.log.stamps_of(region.log.last_number())) state_.stamp[stamp.face] = 0;
  region.log.edits.clear();
  region.log.stamps.clear();
}

bool ChangeProver::prove_group(const Split& split, Region& region) {
  ProofWorkers::Worker& worker = workers_.of_thread(thread_);
  changed_.clear();
  for (const EditLog::Stamp& stamp : region.log.stamps)
    if (stamp.before == 0) changed_.push_back(stamp.face);
  bool holds = worker.cover_group(changed_, split, region.id);
  originals_tested += worker.affected();
  for (const std::uint32_t face : changed_) {
    if (!holds) break;
    if (state_.mesh.is_removed(face)) continue;
    holds = worker.is_near(face, state_.nearest[face]);
    ++faces_tested;
  }
  if (!holds) {
    ++unproven;
    return false;
  }
  ++proven;
  worker.assign_group(state_.cover);
  for (const std::uint32_t face : changed_) state_.stamp[face] = 0;
  region.log.edits.clear();
  region.log.stamps.clear();
  return true;
}

}  // namespace meshbound
