// SPDX-License-Identifier: MIT
#include "proof/cover_record.h"

#include <algorithm>

#include "bvh/bvh_data.h"

namespace meshbound {

void CoverRecord::add(std::uint32_t slot) {
  last = slot;
  if (slot == no_slot) complete = false;
  if (!names_all && !slots.empty()) return;
  // Pieces of one triangle lie on a few triangles of B, mostly on the one met last.
  if (std::find(slots.rbegin(), slots.rend(), slot) == slots.rend()) slots.push_back(slot);
}

void CoverRecord::add(std::span<const std::uint32_t> together) {
  if (!names_all) return add(together.front());
  slots.insert(slots.end(), together.begin(), together.end());
}

}  // namespace meshbound
