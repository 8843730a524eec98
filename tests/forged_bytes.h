// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "verify/checksum.h"

namespace meshbound::test {

/// Puts a number of `size` bytes at an offset, lowest byte first.
inline void put(std::vector<std::uint8_t>& bytes, std::size_t at, std::uint64_t value, std::size_t size = 8) {
  for (std::size_t i = 0; i < size; ++i) bytes[at + i] = static_cast<std::uint8_t>(value >> (8 * i));
}

/// The bytes of a certificate with the checksum that they should have.
inline std::vector<std::uint8_t> sealed(std::vector<std::uint8_t> bytes) {
  verify::Checksum checksum;
  checksum.add(std::span(bytes).first(bytes.size() - 8));
  put(bytes, bytes.size() - 8, checksum.value());
  return bytes;
}

/// The bytes with another number of `size` bytes at an offset, sealed again.
inline std::vector<std::uint8_t> with(std::vector<std::uint8_t> bytes, std::size_t at, std::uint64_t value,
                                      std::size_t size = 8) {
  put(bytes, at, value, size);
  return sealed(bytes);
}

/// Where the proofs of both directions end, and what later versions of the format add begins.
inline std::size_t end_of_proofs(const std::vector<std::uint8_t>& bytes) {
  std::uint64_t forward = 0, backward = 0;
  for (std::size_t i = 8; i-- > 0;) {
    forward = forward << 8 | bytes[72 + i];
    backward = backward << 8 | bytes[88 + i];
  }
  return 104 + forward + backward;
}

}  // namespace meshbound::test
