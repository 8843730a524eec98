// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <vector>

#include "simplify/proof_workers.h"
#include "simplify/regions.h"

namespace meshbound {

/// Proves changes one by one, right after they were made to a state that is proven but for them. One for each thread.
class ChangeProver {
 public:
  /// Uses the memory of one thread of `workers`. All must outlive this.
  ChangeProver(DecimationState& state, ProofWorkers& workers, std::size_t thread)
      : state_(state), workers_(workers), thread_(thread) {}
  /// Makes the last change part of what is proven, or takes it back where that fails.
  bool prove_or_undo(const Split& split, Region& region) {
    if (!prove(split, region)) return false;
    accept(region);
    return true;
  }
  /// In two steps: until `accept`, `undo_last` may still take back a change that holds.
  bool prove(const Split& split, Region& region);
  /// Whether the last change failed, but might have been proven with the help of faces of other regions.
  [[nodiscard]] bool met_seam() const;
  void accept(Region& region);
  /// Makes all changes of the region that are not proven yet, many around one place, part of what is proven. False
  /// where that fails; they are as they were then.
  [[nodiscard]] bool prove_group(const Split& split, Region& region);

  std::uint64_t proven = 0, unproven = 0, originals_tested = 0, faces_tested = 0;

 private:
  [[nodiscard]] bool is_near(std::uint32_t face);

  DecimationState& state_;
  ProofWorkers& workers_;
  std::size_t thread_;
  std::vector<std::uint32_t> changed_;  ///< by a group
};

}  // namespace meshbound
