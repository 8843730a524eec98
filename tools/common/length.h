// SPDX-License-Identifier: MIT
#pragma once
#include <string>

namespace meshbound::tools {

/// A length as typed: a bare number is in model units, "0.1%" is a percentage of the original's bounding-box diagonal.
struct Length {
  double value = 0;
  bool is_percentage = false;

  [[nodiscard]] double in_model_units(double diagonal) const { return is_percentage ? value / 100 * diagonal : value; }
};

/// Throws `InvalidInput`, naming `option`, unless `text` is a finite number that is not negative, "%" or " %" allowed
/// after it.
[[nodiscard]] Length parse_length(const std::string& option, const std::string& text);

/// A share from 0 to 1 as typed: "0.5", "50%" or "50 %". Throws `InvalidInput`, naming `option`, for anything else.
[[nodiscard]] double parse_share(const std::string& option, const std::string& text);

/// A length in both units: "0.0123 (0.1% of the diagonal)".
[[nodiscard]] std::string both_units(double absolute, double diagonal);

/// Six significant digits, for people.
[[nodiscard]] std::string short_number(double value);

/// The fewest digits that read back as the same double: "0.05" where 17 digits say 0.050000000000000003.
[[nodiscard]] std::string exact_number(double value);

}  // namespace meshbound::tools
