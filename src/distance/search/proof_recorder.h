// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>

#include "bvh/bvh_data.h"
#include "distance/search/search_memory.h"
#include "proof/goal.h"

namespace meshbound {

/// Leaves the proofs of a search for later ones; without a memory that keeps proofs it does nothing. Threads may record
/// different triangles of A at the same time, except by `covers`.
class ProofRecorder {
 public:
  /// `memory` may be null; all must outlive this. `goal` gives the rounding, in the frame of B.
  ProofRecorder(SearchMemory* memory, const Bvh::Data& b, const Goal& goal);

  [[nodiscard]] bool is_on() const { return memory_ != nullptr; }

  /// A triangle of A is within the root of `squared` of triangle `face` of B.
  void triangle(std::uint32_t slot, double squared, std::uint32_t face) const {
    if (memory_ != nullptr) memory_->improve(slot, model_length(squared, 0), face);
  }

  /// A record for `cover` below: whether it is to name all triangles of B.
  [[nodiscard]] CoverRecord new_record() const;
  /// A triangle of A was covered as `record` says. A cover by one triangle of B is written down at once, one by several
  /// goes to `found` for `covers`.
  void cover(std::uint32_t slot, const CoverRecord& record, FoundCovers& found) const;
  /// By one thread.
  void covers(const FoundCovers& found) const;

 private:
  [[nodiscard]] double model_length(double squared, std::uint32_t cuts) const;

  SearchMemory* memory_;
  const Bvh::Data& b_;
  const Goal& goal_;
  double scale_to_model_;  ///< of lengths
};

}  // namespace meshbound
