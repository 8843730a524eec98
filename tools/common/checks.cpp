// SPDX-License-Identifier: MIT
#include "common/checks.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdint>

namespace meshbound::tools {
namespace {

/// NaN, which no comparison accepts, for a text that is no number.
double number(const std::string& text) {
  double value = 0;
  return CLI::detail::lexical_cast(text, value) ? value : std::nan("");
}

std::string unless(bool is_valid, const std::string& text, const std::string& wanted) {
  return is_valid ? "" : "'" + text + "' is not a number of " + wanted;
}

}  // namespace

std::string number_of_seconds(const std::string& text) { return unless(number(text) >= 0, text, "seconds, 0 or more"); }

std::string number_of_degrees(const std::string& text) {
  const double value = number(text);
  return unless(value >= 0 && value <= 180, text, "degrees from 0 to 180");
}

std::string number_of_faces(const std::string& text) {
  std::int64_t value = -1;
  return unless(CLI::detail::lexical_cast(text, value) && value >= 0, text, "faces, 0 or more");
}

std::string number_of_texels(const std::string& text) {
  const double value = number(text);
  return unless(value > 0 && std::isfinite(value), text, "texels, more than 0");
}

}  // namespace meshbound::tools
