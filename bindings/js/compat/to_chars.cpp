// SPDX-License-Identifier: MIT
// Decimal numbers as std::to_chars of other standard libraries writes them, which text files of meshes hold.
#include <emscripten.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "standard_library.h"

// The fewest digits that read back as `value`, as "1.25e-7": what JavaScript guarantees of a number's text.
EM_JS(int, write_shortest, (char* to, int size, double value), {
  const text = value.toExponential();
  for (let i = 0; i < text.length && i < size; ++i) HEAPU8[to + i] = text.charCodeAt(i);
  return text.length;
});

namespace {

/// The digits of a positive number, and the power of ten of the last one.
struct Decimal {
  char digits[32];
  int count = 0;
  int exponent = 0;
};

Decimal shortest(double value) {
  char text[40] = {};
  write_shortest(text, sizeof text - 1, value);
  const char* const e = std::strchr(text, 'e');
  Decimal decimal;
  for (const char* at = text; at != e; ++at)
    if (*at != '.') decimal.digits[decimal.count++] = *at;
  decimal.exponent = std::atoi(e + 1) - (decimal.count - 1);
  return decimal;
}

char* put(char* to, const char* from, int count) {
  std::memcpy(to, from, static_cast<std::size_t>(count));
  return to + count;
}

char* put_zeros(char* to, int count) {
  std::memset(to, '0', static_cast<std::size_t>(count));
  return to + count;
}

char* write_scientific(char* to, const Decimal& decimal) {
  *to++ = decimal.digits[0];
  if (decimal.count > 1) {
    *to++ = '.';
    to = put(to, decimal.digits + 1, decimal.count - 1);
  }
  return to + std::sprintf(to, "e%+03d", decimal.exponent + decimal.count - 1);
}

char* write_fixed(char* to, const Decimal& decimal, double value) {
  const int whole = decimal.count + decimal.exponent;  // digits before the point
  if (decimal.exponent >= 0) return to + std::sprintf(to, "%.0f", value);
  if (whole > 0) {
    to = put(to, decimal.digits, whole);
    *to++ = '.';
    return put(to, decimal.digits + whole, decimal.count - whole);
  }
  to = put_zeros(put(to, "0.", 2), -whole);
  return put(to, decimal.digits, decimal.count);
}

}  // namespace

/// Fixed where that takes no more characters than scientific notation. `value` is finite, and there is room for it.
std::to_chars_result std::to_chars(char* first, char*, double value) {
  if (std::signbit(value)) *first++ = '-';
  if (value == 0) return {put_zeros(first, 1), std::errc{}};
  const double magnitude = std::fabs(value);
  const Decimal decimal = shortest(magnitude);
  const bool one = decimal.count == 1;  // scientific notation then needs no point
  const bool is_fixed = decimal.exponent >= -(decimal.count + (one ? 2 : 3)) && decimal.exponent <= (one ? 4 : 5);
  return {is_fixed ? write_fixed(first, decimal, magnitude) : write_scientific(first, decimal), std::errc{}};
}
