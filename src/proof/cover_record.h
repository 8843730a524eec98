// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <vector>

namespace meshbound {

/// The triangles of B that one covered triangle of A relies on. Filled by the walk, outside of its hot loops; not
/// inline, because the walk is compiled once per instruction set (numeric/isa.h).
struct CoverRecord {
  static constexpr std::uint32_t none_yet = 0xffffffff;

  bool names_all = true;  ///< false: one of them is enough
  double squared = 0;     ///< largest distance that was accepted
  bool complete = true;
  std::uint32_t last = none_yet;     ///< added
  std::vector<std::uint32_t> slots;  ///< each once

  void clear() {
    squared = 0;
    complete = true;
    last = none_yet;
    slots.clear();
  }
  /// `no_slot`: a piece whose triangle is not known, so the cover proves nothing for later.
  void add(std::uint32_t slot);
  [[nodiscard]] bool proves() const { return complete && !slots.empty(); }
};

}  // namespace meshbound
