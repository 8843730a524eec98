// SPDX-License-Identifier: MIT
#include "mesh/text_cursor.h"

#include <fast_float/fast_float.h>

#include <limits>

namespace meshbound {

const char* TextCursor::parse_number(const char* from, const char* to, double& value) {
  if (from != to && *from == '+') {
    ++from;
    if (from == to || *from == '-') return nullptr;
  }
  const auto result = fast_float::from_chars(from, to, value);
  // A number too large for a double comes back as infinity, in some versions with an error code; within_range tells it
  // from text that says "inf".
  const bool overflowed = result.ec == std::errc::result_out_of_range;
  return result.ec == std::errc() || overflowed ? result.ptr : nullptr;
}

void TextCursor::refuse_overflow() const {
  const char* digit = at_ + (*at_ == '+' || *at_ == '-' ? 1 : 0);
  const bool says_so = *digit == 'i' || *digit == 'I' || *digit == 'n' || *digit == 'N';
  if (!says_so) fail(quote(peek_word()) + " is too large for a double; rescale the mesh");
}

std::int64_t TextCursor::leading_integer(const char* what) {
  const char* to = at_;
  const bool negative = to != end_ && *to == '-';
  if (to != end_ && (*to == '-' || *to == '+')) ++to;
  const char* const digits = to;
  std::int64_t value = 0;
  constexpr std::int64_t last_safe = (std::numeric_limits<std::int64_t>::max() - 9) / 10;
  for (; to != end_ && *to >= '0' && *to <= '9'; ++to) {
    if (value > last_safe) fail(quote(peek_word()) + " is too large for an integer");
    value = 10 * value + (*to - '0');
  }
  if (to == digits) fail_expected(what);
  at_ = to;
  return negative ? -value : value;
}

void TextCursor::fail_expected(const char* what) const {
  const std::string_view found = peek_word();
  const std::string where = at_ == end_ ? "the file ends" : found.empty() ? "the line ends" : "found " + quote(found);
  fail(std::string("expected ") + what + ", but " + where);
}

}  // namespace meshbound
