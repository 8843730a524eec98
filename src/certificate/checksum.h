// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <span>

namespace meshbound {

/// CRC-64/XZ. The verifier has its own: it shares no code with what makes certificates.
class Crc64 {
 public:
  void add(std::uint8_t byte) { state_ = table[(state_ ^ byte) & 0xff] ^ (state_ >> 8); }
  [[nodiscard]] std::uint64_t value() const { return ~state_; }

 private:
  static constexpr std::array<std::uint64_t, 256> table = [] {
    std::array<std::uint64_t, 256> entries{};
    for (std::uint64_t i = 0; i < 256; ++i) {
      std::uint64_t entry = i;
      for (int bit = 0; bit < 8; ++bit) entry = entry >> 1 ^ (entry % 2 == 1 ? 0xC96C5795D7870F42U : 0U);
      entries[i] = entry;
    }
    return entries;
  }();
  std::uint64_t state_ = ~std::uint64_t{0};
};

[[nodiscard]] inline std::uint64_t crc64_of(std::span<const std::uint8_t> bytes) {
  Crc64 crc;
  for (const std::uint8_t byte : bytes) crc.add(byte);
  return crc.value();
}

}  // namespace meshbound
