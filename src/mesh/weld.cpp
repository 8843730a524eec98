// SPDX-License-Identifier: MIT
#include "mesh/weld.h"

#include <bit>

namespace meshbound {
namespace {

constexpr std::uint32_t vacant = ~std::uint32_t{0};

/// Adding +0.0 turns -0.0 into it and changes nothing else.
std::uint64_t bits_of(double x) { return std::bit_cast<std::uint64_t>(x + 0.0); }

/// Multiplication by odd constants (fractions of the golden ratio and of pi) with the high bits folded back: float
/// coordinates have nothing but zeros in the low bits of a double.
std::uint64_t hash_of(const std::array<std::uint64_t, 3>& key) {
  std::uint64_t h = 0;
  for (const std::uint64_t bits : key) {
    h = (h ^ bits) * 0x9E3779B97F4A7C15u;
    h ^= h >> 32;
  }
  h *= 0x243F6A8885A308D3u;
  return h ^ (h >> 29);
}

}  // namespace

Welder::Welder() : slots_(1024, vacant) {}

std::size_t Welder::slot_of(const Key& key) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = hash_of(key) & mask;
  while (slots_[slot] != vacant && keys_[slots_[slot]] != key) slot = (slot + 1) & mask;
  return slot;
}

void Welder::grow() {
  std::vector<std::uint32_t>(2 * slots_.size(), vacant).swap(slots_);
  for (std::uint32_t i = 0; i < keys_.size(); ++i) slots_[slot_of(keys_[i])] = i;
}

std::uint32_t Welder::index_of(const Eigen::Vector3d& p) {
  const Key key = {bits_of(p.x()), bits_of(p.y()), bits_of(p.z())};
  const std::size_t slot = slot_of(key);
  if (slots_[slot] != vacant) return slots_[slot];
  const auto index = static_cast<std::uint32_t>(keys_.size());
  slots_[slot] = index;
  keys_.push_back(key);
  if (2 * keys_.size() > slots_.size()) grow();
  return index;
}

}  // namespace meshbound
