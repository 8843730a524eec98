// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <span>

#include "simplify/proof_workers.h"
#include "simplify/regions.h"

namespace meshbound {

/// Proves changes one by one, right after they were made to a state that is proven but for them. One for each thread.
class ChangeProver {
 public:
  /// Uses the memory of one thread of `workers`. All must outlive this.
  ChangeProver(DecimationState& state, ProofWorkers& workers, std::size_t thread)
      : state_(state), workers_(workers), thread_(thread) {}
  /// Adds the last change, of these faces, to what is proven, or undoes it if it cannot be proven.
  bool prove_or_undo(const Split& split, Region& region, std::span<const std::uint32_t> changed) {
    if (!prove(split, region, changed)) return false;
    accept(region);
    return true;
  }
  /// Proves the last change. Until `accept`, `undo_last` may still undo it.
  bool prove(const Split& split, Region& region, std::span<const std::uint32_t> changed);
  /// Whether the last change failed, but might have been proven with the help of faces of other regions.
  [[nodiscard]] bool met_seam() const;
  /// Why the last change failed, if it left a point of the original too far from the faces: that point.
  [[nodiscard]] const std::optional<Vec3>& lost_point() const;
  void accept(Region& region);
  /// Proves all unproven changes of the region together, of these faces; they must lie around one place. False if that
  /// fails: they are then still unproven.
  [[nodiscard]] bool prove_group(const Split& split, Region& region, std::span<const std::uint32_t> changed);

  std::uint64_t proven = 0, unproven = 0, originals_tested = 0, faces_tested = 0;

 private:
  [[nodiscard]] bool is_near(std::uint32_t face);
  [[nodiscard]] bool are_near(std::span<const std::uint32_t> faces);

  DecimationState& state_;
  ProofWorkers& workers_;
  std::size_t thread_;
};

}  // namespace meshbound
