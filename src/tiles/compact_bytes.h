// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "meshbound/error.h"

namespace meshbound {

/// What to add to one number for the next, modulo 2^32, with its sign in the lowest bit: small steps are small numbers,
/// up or down.
[[nodiscard]] inline std::uint32_t folded_step(std::uint32_t from, std::uint32_t to) {
  const auto difference = static_cast<std::int32_t>(to - from);
  return (static_cast<std::uint32_t>(difference) << 1) ^ static_cast<std::uint32_t>(difference >> 31);
}
/// The number that such a step leads to.
[[nodiscard]] inline std::uint32_t after_step(std::uint32_t from, std::uint32_t folded) {
  return from + ((folded >> 1) ^ (~(folded & 1) + 1));
}

/// Puts numbers behind one another: integers in 7 bits a byte, so that small ones take one.
class CompactWriter {
 public:
  void number(std::uint64_t value) {
    for (; value >= 0x80; value >>= 7) bytes_.push_back(static_cast<char>(value | 0x80));
    bytes_.push_back(static_cast<char>(value));
  }
  /// The step from one number to the next: near numbers take one byte.
  void step(std::uint32_t from, std::uint32_t to) { number(folded_step(from, to)); }
  /// The bits of a value as they stand in memory.
  template <class T>
  void raw(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    const std::size_t at = bytes_.size();
    bytes_.resize(at + sizeof(T));
    std::memcpy(bytes_.data() + at, &value, sizeof(T));
  }
  template <class T>
  void raw(const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    number(values.size());
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  }
  void text(std::string_view value) {
    number(value.size());
    bytes_.append(value);
  }
  [[nodiscard]] std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

/// Reads what `CompactWriter` wrote, in its order. Every member throws `InvalidInput` where the bytes end too early.
class CompactReader {
 public:
  /// `bytes` must outlive this.
  explicit CompactReader(std::string_view bytes) : bytes_(bytes) {}

  [[nodiscard]] std::uint64_t number() {
    std::uint64_t value = 0;
    for (int shift = 0;; shift += 7) {
      const auto byte = static_cast<unsigned char>(some(1)[0]);
      if (shift > 63) fail();
      value |= static_cast<std::uint64_t>(byte & 0x7f) << shift;
      if (byte < 0x80) return value;
    }
  }
  /// A number of things of which each takes at least a byte, or is of `limit` things that the caller has.
  [[nodiscard]] std::size_t count(std::size_t limit) {
    const std::uint64_t value = number();
    if (value > limit) fail();
    return static_cast<std::size_t>(value);
  }
  [[nodiscard]] std::uint32_t step(std::uint32_t from) {
    return after_step(from, static_cast<std::uint32_t>(number()));
  }
  template <class T>
  void raw(T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    std::memcpy(&value, some(sizeof(T)).data(), sizeof(T));
  }
  template <class T>
  void raw(std::vector<T>& values) {
    const std::size_t size = count(bytes_.size() / sizeof(T));
    values.resize(size);
    std::memcpy(values.data(), some(size * sizeof(T)).data(), size * sizeof(T));
  }
  [[nodiscard]] std::string_view text() { return some(count(bytes_.size())); }
  [[nodiscard]] bool at_end() const { return bytes_.empty(); }
  /// For bytes that say what cannot be.
  [[noreturn]] static void fail() { throw InvalidInput("the bytes of a tile are damaged"); }

 private:
  std::string_view some(std::size_t size) {
    if (size > bytes_.size()) fail();
    const std::string_view taken = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
    return taken;
  }

  std::string_view bytes_;
};

}  // namespace meshbound
