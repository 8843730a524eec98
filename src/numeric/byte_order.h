// SPDX-License-Identifier: MIT
/// Numbers in files: bytes in an order that the format fixes, at addresses of any alignment.
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace meshbound {

/// The number whose bytes are stored from `from` on in this order.
template <class Number>
[[nodiscard]] Number load_number(const char* from, std::endian order) {
  std::array<char, sizeof(Number)> bytes;
  std::memcpy(bytes.data(), from, sizeof(Number));
  if (order != std::endian::native) std::reverse(bytes.begin(), bytes.end());
  return std::bit_cast<Number>(bytes);
}

/// Stores the bytes of a number from `to` on in this order.
template <class Number>
void store_number(Number value, char* to, std::endian order) {
  std::memcpy(to, &value, sizeof(Number));
  if (order != std::endian::native) std::reverse(to, to + sizeof(Number));
}

}  // namespace meshbound
