// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <limits>
#include <string>

#include "deviation/colour_map.h"
#include "meshbound/bounds.h"

namespace meshbound::tools {

/// Which deviation has which colour: from 0 to `end`, model units; more than 0.
struct DeviationScale {
  double end = 1;
  std::string meaning;  ///< of the end: "tolerance", "proven maximum" or "1e-9 of the diagonal"

  /// A deviation has the colour for what is beyond only where it is proven to be.
  [[nodiscard]] Colour colour(const Bounds& deviation) const {
    return colour_of(deviation.lower > end ? std::numeric_limits<double>::infinity()
                                           : std::min(1.0, deviation.upper / end));
  }
};

/// To the tolerance where there is one that is more than 0, else to the largest distance that is proven. Where that is
/// hardly more than a rounding, to a billionth of the original's diagonal.
[[nodiscard]] inline DeviationScale scale_for(double tolerance, const Bounds& distance, double diagonal) {
  if (tolerance > 0) return {tolerance, "tolerance"};
  const double largest = distance.upper < std::numeric_limits<double>::infinity() ? distance.upper : distance.lower;
  const double least = std::max(1e-9 * diagonal, std::numeric_limits<double>::min());
  if (largest < least) return {least, "1e-9 of the diagonal"};
  return {largest, "proven maximum"};
}

}  // namespace meshbound::tools
