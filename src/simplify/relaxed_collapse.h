// SPDX-License-Identifier: MIT
#pragma once
#include <vector>

#include "simplify/change_prover.h"
#include "simplify/local_edit.h"
#include "simplify/lower_deviation.h"
#include "simplify/prove.h"

namespace meshbound {

/// Collapses edges for which no placement of the vertex that is left keeps the bound: vertices around it move and edges
/// around it flip to where the sampled deviation is lower, and all this together is proven, or taken back. Worth its
/// time where nothing else fits any more.
class RelaxedCollapse {
 public:
  /// All must outlive this.
  RelaxedCollapse(DecimationState& state, LocalEdit& edit, ChangeProver& prover)
      : state_(state), edit_(edit), prover_(prover) {}

  /// Whether the edge was collapsed. Changes are made in the region that the edit has entered.
  bool run(const Split& split, Region& region, Corner edge);

 private:
  [[nodiscard]] bool place_collapse(Corner edge);
  [[nodiscard]] bool make_room(std::uint32_t kept);
  [[nodiscard]] bool make_more_room(std::uint32_t kept);
  void flip_around(std::uint32_t kept);
  double relax(std::uint32_t vertex, const DeviationSearch& search);
  double relax_around(std::uint32_t kept);

  DecimationState& state_;
  LocalEdit& edit_;
  ChangeProver& prover_;
  std::vector<Corner> edges_;
  std::vector<std::uint32_t> ring_;
};

}  // namespace meshbound
