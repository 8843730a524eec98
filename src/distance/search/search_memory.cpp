// SPDX-License-Identifier: MIT
#include "distance/search/search_memory.h"

namespace meshbound {

void SearchMemory::reset(const Bvh::Data& a) {
  proofs.assign(rigid ? 0 : a.triangle_count(), {});
  front = {};
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
