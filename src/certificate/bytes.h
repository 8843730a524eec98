// SPDX-License-Identifier: MIT
/// How numbers are stored in certificates.
#pragma once
#include <cstdint>
#include <vector>

namespace meshbound {

using Bytes = std::vector<std::uint8_t>;

/// Appends the low `size` bytes of a number, the lowest first.
inline void put(Bytes& bytes, std::uint64_t value, int size) {
  for (int i = 0; i < size; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

/// Appends an unsigned number as LEB128.
inline void put_variable(Bytes& bytes, std::uint64_t value) {
  for (; value >= 0x80; value >>= 7) bytes.push_back(static_cast<std::uint8_t>(0x80 | (value & 0x7f)));
  bytes.push_back(static_cast<std::uint8_t>(value));
}

/// Zigzag: 0, -1, 1, -2, 2, ... become 0, 1, 2, 3, 4, ...
[[nodiscard]] inline std::uint64_t zigzag(std::int64_t value) {
  return value < 0 ? static_cast<std::uint64_t>(-(value + 1)) * 2 + 1 : static_cast<std::uint64_t>(value) * 2;
}

}  // namespace meshbound
