// SPDX-License-Identifier: MIT
#include "distance/search/proof_recorder.h"

#include <cmath>
#include <span>

namespace meshbound {

ProofRecorder::ProofRecorder(SearchMemory* memory, const Bvh::Data& b, const Goal& goal)
    : memory_(memory != nullptr && !memory->rigid ? memory : nullptr),
      b_(b),
      goal_(goal),
      scale_to_model_(std::ldexp(1.0, b.frame.exponent)) {}

/// `Goal::proven_upper` in model units. The scale is a power of two: without `ldexp` where the product is a normal
/// number.
double ProofRecorder::model_length(double squared, std::uint32_t cuts) const {
  const double working = goal_.proven_upper(squared, cuts), model = working * scale_to_model_;
  return model > 0x1p-1000 && model < 0x1p1000 ? model : b_.frame.length_up(working);
}

CoverRecord ProofRecorder::new_record() const {
  CoverRecord record;
  record.names_all = is_on() && memory_->names_faces;
  return record;
}

void ProofRecorder::cover(std::uint32_t slot, const CoverRecord& record, FoundCovers& found) const {
  if (!is_on() || !record.proves()) return;
  if (record.slots.size() > 1) return found.add(slot, record);
  memory_->improve(slot, model_length(record.squared, deepest_cut), record.slots.front());
}

void ProofRecorder::covers(const FoundCovers& found) const {
  std::uint32_t begin = 0;
  for (const FoundCovers::Cover& cover : found.covers) {
    const std::span used(found.faces.data() + begin, cover.end - begin);
    memory_->improve(cover.slot, model_length(cover.squared, deepest_cut), used);
    begin = cover.end;
  }
}

}  // namespace meshbound
