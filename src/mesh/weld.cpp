// SPDX-License-Identifier: MIT
#include "mesh/weld.h"

#include "numeric/no_index.h"

namespace meshbound {
Welder::Welder() : slots_(1024, no_index) {}

std::size_t Welder::slot_of(const PositionKey& key) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = position_hash(key) & mask;
  while (slots_[slot] != no_index && keys_[slots_[slot]] != key) slot = (slot + 1) & mask;
  return slot;
}

void Welder::grow() {
  std::vector<std::uint32_t>(2 * slots_.size(), no_index).swap(slots_);
  for (std::uint32_t i = 0; i < keys_.size(); ++i) slots_[slot_of(keys_[i])] = i;
}

std::uint32_t Welder::index_of(const Eigen::Vector3d& p) {
  const PositionKey key = position_key({p.x(), p.y(), p.z()});
  const std::size_t slot = slot_of(key);
  if (slots_[slot] != no_index) return slots_[slot];
  const auto index = static_cast<std::uint32_t>(keys_.size());
  slots_[slot] = index;
  keys_.push_back(key);
  if (2 * keys_.size() > slots_.size()) grow();
  return index;
}

}  // namespace meshbound
