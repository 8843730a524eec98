// SPDX-License-Identifier: MIT
#include "distance/search_memory.h"

#include <algorithm>

namespace meshbound {

void CoverRecord::add(std::uint32_t slot) {
  last = slot;
  if (slot == no_slot) complete = false;
  if (!names_all && !slots.empty()) return;
  // Pieces of one triangle lie on a few triangles of B, mostly on the one met last.
  if (std::find(slots.rbegin(), slots.rend(), slot) == slots.rend()) slots.push_back(slot);
}

void SearchMemory::reset(const Bvh::Data& a) {
  proofs.assign(a.triangle_count(), {});
  faces.clear();
  hints.assign(a.vertices.size(), no_slot);
  start.reset();
}

void SearchMemory::improve(std::uint32_t slot, double bound, std::uint32_t used) {
  if (bound < proofs[slot].bound) proofs[slot] = {bound, 1, used};
}

void SearchMemory::improve(std::uint32_t slot, double bound, std::span<const std::uint32_t> used) {
  if (!(bound < proofs[slot].bound)) return;
  if (used.size() == 1) return improve(slot, bound, used.front());
  proofs[slot] = {bound, static_cast<std::uint32_t>(used.size()), static_cast<std::uint32_t>(faces.size())};
  faces.insert(faces.end(), used.begin(), used.end());
}

}  // namespace meshbound
