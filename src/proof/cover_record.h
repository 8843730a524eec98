// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "numeric/no_index.h"

namespace meshbound {

/// The triangles of B that one covered triangle of A relies on. Filled by the walk, outside of its hot loops; not
/// inline, because the walk is compiled once per instruction set (numeric/isa.h).
struct CoverRecord {
  bool names_all = true;  ///< false: one triangle of B is enough
  double squared = 0;     ///< largest distance that was accepted
  bool complete = true;
  std::uint32_t last = no_index;     ///< slot added last
  std::vector<std::uint32_t> slots;  ///< each once, but for those that bound several pieces together

  void clear() {
    squared = 0;
    complete = true;
    last = no_index;
    slots.clear();
  }
  /// `no_slot`: a piece whose triangle is not known, so the cover proves nothing for later.
  void add(std::uint32_t slot);
  /// Those that bound a piece together.
  void add(std::span<const std::uint32_t> together);
  [[nodiscard]] bool proves() const { return complete && !slots.empty(); }
};

}  // namespace meshbound
