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

/// A finite number that is not negative, and what stands behind it, without blanks between: "0.1 %" is "0.1%".
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
  const char* const unit = std::find_if(rest, end, [](char c) { return c != ' '; });
  quantity.unit.assign(unit, end);
  return quantity;
}

bool is_word(const std::string& text) {
  return !text.empty() &&
         std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isalpha(c) != 0 || c >= 0x80; });
}

bool is_length(const Quantity& quantity) {
  return quantity.is_valid && (quantity.unit.empty() || quantity.unit == "%");
}

/// "1.5" for "1,5": the first comma as a decimal point.
std::string with_point(std::string text) {
  if (const std::size_t comma = text.find(','); comma != std::string::npos) text[comma] = '.';
  return text;
}

/// What to write in place of text that is no length.
std::string advice(const std::string& text) {
  const std::string corrected = with_point(text);
  const Quantity quantity = parse_quantity(corrected);
  if (is_length(quantity)) return "write " + corrected + ", with a decimal point";
  const bool has_unit = quantity.is_valid && is_word(quantity.unit);
  return (has_unit
              ? "mesh files carry no unit; give the number in the unit of the file (" + exact_number(quantity.value)
              : "give a number in model units (0.5") +
         ") or a percentage of the bounding-box diagonal (0.1%)";
}

}  // namespace

Length parse_length(const std::string& option, const std::string& text) {
  const Quantity quantity = parse_quantity(text);
  if (!is_length(quantity)) throw InvalidInput(option + ": '" + text + "' is not a length; " + advice(text));
  return {quantity.value, quantity.unit == "%"};
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
