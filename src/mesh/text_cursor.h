// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "mesh/mesh_source.h"

namespace meshbound {

/// Reads numbers and words from a text file, never past its end. Lines end with LF, CR LF or CR alone; a word that
/// starts with '#' starts a comment ("1.#IND" does not); a backslash at the end of a line joins it with the next (OBJ
/// uses this, no other format has backslashes). Numbers are the double nearest to the decimal text, denormals included.
class TextCursor {
 public:
  explicit TextCursor(const MeshSource& source)
      : source_(source), begin_(source.bytes.data()), at_(begin_ + source.begin), end_(begin_ + source.bytes.size()) {}

  [[nodiscard]] std::size_t offset() const { return static_cast<std::size_t>(at_ - begin_); }
  [[nodiscard]] std::size_t remaining() const { return static_cast<std::size_t>(end_ - at_); }
  void seek(std::size_t offset) { at_ = begin_ + offset; }

  /// Goes to the next word of this line; false when the line, or a comment, or the file ends first.
  bool find_word_in_line() { return find_part_of_name() && *at_ != '#'; }

  /// Goes to the next word of this line, which may start with '#' as words of names do; false when the line or the file
  /// ends first.
  bool find_part_of_name() {
    skip_blanks();
    return at_ != end_ && *at_ != '\n' && *at_ != '\r';
  }

  /// Goes to the next word on this line or a later one, over comments; false at the end of the file.
  /// Throws `Interrupted` or `Stopped` as the source says.
  bool find_word() {
    look_at_stop();
    while (!find_word_in_line()) {
      if (at_ == end_) return false;
      skip_line();
      look_at_stop();
    }
    return true;
  }

  /// Goes to the start of the next line, whatever this one holds; joined lines are not followed.
  void skip_line() {
    while (at_ != end_ && *at_ != '\n' && *at_ != '\r') ++at_;
    if (at_ != end_ && *at_++ == '\r' && at_ != end_ && *at_ == '\n') ++at_;
  }

  /// The word at the cursor; empty at the end of a line.
  [[nodiscard]] std::string_view peek_word() const {
    const char* to = at_;
    while (!ends_word(to)) ++to;
    return {at_, static_cast<std::size_t>(to - at_)};
  }

  std::string_view word() {
    const std::string_view result = peek_word();
    at_ += result.size();
    return result;
  }

  /// Reads the number at the cursor (nan and inf included). For messages, `what` says what was expected.
  double number(const char* what) {
    double value;
    const char* const to = parse_number(at_, end_, value);
    if (to == nullptr || !ends_word(to)) fail_expected(what);
    if (!within_range(value)) refuse_overflow();
    at_ = to;
    return value;
  }

  std::int64_t integer(const char* what) {
    const std::int64_t value = leading_integer(what);
    if (!ends_word(at_)) fail_expected(what);
    return value;
  }

  /// Reads the integer that the word at the cursor starts with; the rest of the word is left unread.
  std::int64_t leading_integer(const char* what);

  [[nodiscard]] bool starts_with(char c) const { return at_ != end_ && *at_ == c; }
  void advance() { ++at_; }
  [[nodiscard]] bool at_word_end() const { return ends_word(at_); }

  [[noreturn]] void fail(const std::string& defect) const { source_.fail_at_line(offset(), defect); }
  [[noreturn]] void fail_expected(const char* what) const;

 private:
  /// First character after the number, or null. Accepts the leading '+' that `std::from_chars` refuses.
  static const char* parse_number(const char* from, const char* to, double& value);
  static bool within_range(double value) { return value - value == 0; }
  void refuse_overflow() const;

  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
  [[nodiscard]] bool ends_word(const char* at) const {
    return at == end_ || is_blank(*at) || *at == '\n' || *at == '\r' || joins_lines(at);
  }
  [[nodiscard]] bool joins_lines(const char* at) const {
    return *at == '\\' && (at + 1 == end_ || at[1] == '\n' || at[1] == '\r');
  }
  void skip_blanks() {
    while (at_ != end_) {
      if (is_blank(*at_)) {
        ++at_;
      } else if (joins_lines(at_)) {
        skip_line();
      } else {
        return;
      }
    }
  }

  void look_at_stop() {
    constexpr std::size_t interval = 1 << 16;  // words or lines: read in some milliseconds
    if (++looks_ % interval == 0) source_.end_if_stopped();
  }

  const MeshSource& source_;
  const char* begin_;
  const char* at_;
  const char* end_;
  std::size_t looks_ = 0;  ///< calls of `look_at_stop`
};

}  // namespace meshbound
