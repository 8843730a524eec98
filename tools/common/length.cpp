// SPDX-License-Identifier: MIT
#include "common/length.h"

#include <charconv>
#include <cmath>
#include <cstdio>

#include "meshbound/error.h"

namespace meshbound::tools {

Length parse_length(const std::string& option, const std::string& text) {
  Length length;
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, length.value);
  length.is_percentage = rest != end && *rest == '%';
  const bool consumed = rest + (length.is_percentage ? 1 : 0) == end;
  if (error != std::errc{} || !consumed || !std::isfinite(length.value) || length.value < 0)
    throw InvalidInput(option + ": '" + text +
                       "' is not a length; give a number in model units (0.5) or a percentage "
                       "of the bounding-box diagonal (0.1%)");
  return length;
}

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

std::string exact_number(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::string both_units(double absolute, double diagonal) {
  if (!(diagonal > 0) || !std::isfinite(absolute / diagonal * 100)) return short_number(absolute);
  return short_number(absolute) + " (" + short_number(absolute / diagonal * 100) + "% of the diagonal)";
}

}  // namespace meshbound::tools
