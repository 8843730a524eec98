// SPDX-License-Identifier: MIT
#include "common/length.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "meshbound/error.h"

namespace meshbound::tools {

namespace {

/// A finite number that is not negative, and what stands behind it.
struct Quantity {
  bool is_valid = false;
  double value = 0;
  std::string unit;
};

Quantity parse_quantity(const std::string& text) {
  Quantity quantity;
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, quantity.value);
  quantity.is_valid = error == std::errc{} && std::isfinite(quantity.value) && quantity.value >= 0;
  quantity.unit.assign(rest, end);
  return quantity;
}

bool is_word(const std::string& text) {
  return !text.empty() &&
         std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isalpha(c) != 0 || c >= 0x80; });
}

}  // namespace

Length parse_length(const std::string& option, const std::string& text) {
  const Quantity quantity = parse_quantity(text);
  if (quantity.is_valid && (quantity.unit.empty() || quantity.unit == "%"))
    return {quantity.value, quantity.unit == "%"};
  const std::string reason = quantity.is_valid && is_word(quantity.unit)
                                 ? "mesh files carry no unit; give the number in the unit of the file ("
                                 : "give a number in model units (";
  throw InvalidInput(option + ": '" + text + "' is not a length; " + reason +
                     (quantity.is_valid ? exact_number(quantity.value) : "0.5") +
                     ") or a percentage of the bounding-box diagonal (0.1%)");
}

double parse_share(const std::string& option, const std::string& text) {
  const Quantity quantity = parse_quantity(text);
  const double share = quantity.unit == "%" ? quantity.value / 100 : quantity.value;
  if (!quantity.is_valid || !(quantity.unit.empty() || quantity.unit == "%") || share > 1)
    throw InvalidInput(option + ": '" + text + "' is no share; give a number from 0 to 1 or a percentage (50%)");
  return share;
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
  if (!(diagonal > 0) || !std::isfinite(absolute / diagonal * 100)) return exact_number(absolute);
  return exact_number(absolute) + " (" + short_number(absolute / diagonal * 100) + "% of the diagonal)";
}

}  // namespace meshbound::tools
