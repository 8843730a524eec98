// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace meshbound::tools {

/// SHA-256 (FIPS 180-4) of bytes that come one after the other.
class Sha256 {
 public:
  Sha256();
  void add(std::string_view bytes);
  /// The checksum of all bytes so far, in 64 hexadecimal digits.
  [[nodiscard]] std::string digits() const;

 private:
  std::array<std::uint32_t, 8> hash_;
  std::string rest_;  ///< bytes after the last whole block
  std::uint64_t size_ = 0;
};

/// SHA-256 (FIPS 180-4) in 64 hexadecimal digits, as `sha256sum` prints it. `look` is called every few milliseconds and
/// ends it by throwing; may be empty. O(n); safe to call from several threads.
[[nodiscard]] std::string sha256(std::string_view bytes, const std::function<void()>& look = {});

}  // namespace meshbound::tools
