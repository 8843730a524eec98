// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>

#include "mesh/mesh_source.h"
#include "mesh/ply_header.h"
#include "mesh/text_cursor.h"
#include "numeric/byte_order.h"

namespace meshbound {

/// The values after the header of an ascii PLY, one element a line. It has the interface of `BinaryPlyValues`.
class AsciiPlyValues {
 public:
  static constexpr bool is_text = true;

  AsciiPlyValues(const MeshSource& source, std::size_t begin) : cursor_(source) { cursor_.seek(begin); }

  [[nodiscard]] std::size_t offset() const { return cursor_.offset(); }
  [[nodiscard]] std::size_t remaining() const { return cursor_.remaining(); }

  /// The fewest bytes a value takes: a digit and what separates it from the next.
  static std::size_t smallest(PlyType) { return 2; }

  double real(PlyType) {
    start_word();
    return cursor_.number("a value");
  }

  std::int64_t integer(PlyType type) {
    start_word();
    if (type != PlyType::Float32 && type != PlyType::Float64) return cursor_.integer("an integer");
    const double value = cursor_.number("an integer");
    if (!(std::abs(value) <= 0x1p53) || value != std::floor(value)) fail("a count or an index is not a whole number");
    return static_cast<std::int64_t>(value);
  }

  void skip(PlyType, std::uint64_t count) {
    for (; count > 0; --count) {
      start_word();
      cursor_.word();
    }
  }

  void end_element() {
    if (cursor_.find_word_in_line()) fail("the line holds more values than the header declares");
    cursor_.skip_line();
  }

  /// Whether only blank lines are left.
  [[nodiscard]] bool at_end() { return !cursor_.find_word(); }

  [[noreturn]] void fail(const std::string& defect) const { cursor_.fail(defect); }

 private:
  void start_word() {
    if (!cursor_.find_word()) fail("the file ends before the last element that its header declares");
  }

  TextCursor cursor_;
};

/// The values after the header of a binary PLY, in either byte order; checked against the end of the file.
class BinaryPlyValues {
 public:
  static constexpr bool is_text = false;

  BinaryPlyValues(const MeshSource& source, std::size_t begin, std::endian order) : source_(source), order_(order) {
    look_at(begin);
  }

  [[nodiscard]] std::size_t offset() const { return behind_ - static_cast<std::size_t>(end_ - at_); }
  [[nodiscard]] std::size_t remaining() const { return source_.size() - offset(); }
  static std::size_t smallest(PlyType type) { return size_of(type); }

  double real(PlyType type) {
    switch (type) {
      case PlyType::Float32:
        return load<float>();
      case PlyType::Float64:
        return load<double>();
      default:
        return static_cast<double>(integer(type));
    }
  }

  std::int64_t integer(PlyType type) {
    switch (type) {
      case PlyType::Int8:
        return load<std::int8_t>();
      case PlyType::UInt8:
        return load<std::uint8_t>();
      case PlyType::Int16:
        return load<std::int16_t>();
      case PlyType::UInt16:
        return load<std::uint16_t>();
      case PlyType::Int32:
        return load<std::int32_t>();
      case PlyType::UInt32:
        return load<std::uint32_t>();
      default:
        break;
    }
    const double value = real(type);
    if (!(std::abs(value) <= 0x1p53) || value != std::floor(value)) fail("a count or an index is not a whole number");
    return static_cast<std::int64_t>(value);
  }

  void skip(PlyType type, std::uint64_t count) {
    if (count > remaining() / size_of(type)) fail_truncated();
    const std::size_t size = count * size_of(type);
    if (size <= static_cast<std::size_t>(end_ - at_))
      at_ += size;
    else
      look_at(offset() + size);
  }

  void end_element() {}

  /// Goes on with the value at `offset`, which must not be before this one.
  void seek(std::size_t offset) { look_at(offset); }

  /// Whether the data ends here; line ends after it, which text tools add, are allowed.
  [[nodiscard]] bool at_end() {
    for (; remaining() > 0; look_at(behind_))
      if (!std::all_of(at_, end_, [](char c) { return c == '\n' || c == '\r'; })) return false;
    return true;
  }

  [[noreturn]] void fail(const std::string& defect) const { source_.fail_at_byte(offset(), defect); }

 private:
  template <class T>
  T load() {
    if (static_cast<std::size_t>(end_ - at_) < sizeof(T)) {
      if (remaining() < sizeof(T)) fail_truncated();
      look_at(offset());
    }
    const T value = load_number<T>(at_, order_);
    at_ += sizeof(T);
    return value;
  }

  /// Goes on with the bytes from `offset` on; enough of them for a value, if there are.
  void look_at(std::size_t offset) {
    const std::string_view bytes = source_.at(offset, sizeof(double));
    at_ = bytes.data();
    end_ = at_ + bytes.size();
    behind_ = offset + bytes.size();
  }

  [[noreturn]] void fail_truncated() const { fail("the file ends before the last element that its header declares"); }

  const MeshSource& source_;
  const char* at_ = nullptr;
  const char* end_ = nullptr;
  std::size_t behind_ = 0;  ///< offset of `end_` in the file
  std::endian order_;
};

}  // namespace meshbound
