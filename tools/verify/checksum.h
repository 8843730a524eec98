// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace meshbound::verify {

/// CRC-64/XZ (ECMA-182 polynomial, reflected): every change within 64 neighbouring bits changes it.
class Checksum {
 public:
  void add(std::span<const std::uint8_t> bytes) {
    for (const std::uint8_t byte : bytes) add_byte(byte);
  }
  /// The `size` lowest bytes of `word`, lowest first.
  void add_little_endian(std::uint64_t word, int size) {
    for (int i = 0; i < size; ++i) add_byte(static_cast<std::uint8_t>(word >> (8 * i)));
  }
  [[nodiscard]] std::uint64_t value() const { return ~state_; }

 private:
  static constexpr std::array<std::uint64_t, 256> make_table() {
    std::array<std::uint64_t, 256> table{};
    for (std::uint64_t i = 0; i < 256; ++i) {
      std::uint64_t word = i;
      for (int bit = 0; bit < 8; ++bit) word = (word >> 1) ^ ((word & 1) != 0 ? 0xC96C5795D7870F42U : 0U);
      table[i] = word;
    }
    return table;
  }
  void add_byte(std::uint8_t byte) {
    static constexpr std::array<std::uint64_t, 256> table = make_table();
    state_ = (state_ >> 8) ^ table[(state_ ^ byte) & 0xff];
  }

  std::uint64_t state_ = ~std::uint64_t{0};
};

}  // namespace meshbound::verify
