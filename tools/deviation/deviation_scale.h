// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <limits>
#include <string>

#include "deviation/colour_map.h"
#include "meshbound/bounds.h"

namespace meshbound::tools {

/// The scale of colours: from 0 to `end`, model units, more than 0.
struct DeviationScale {
  double end = 1;
  std::string meaning;  ///< of the end: "tolerance", "proven maximum" or "1e-9 of the diagonal"

  /// The colour of a deviation. Only a deviation that is proven to be beyond the scale gets the colour for that.
  [[nodiscard]] Colour colour(const Bounds& deviation) const {
    return colour_of(deviation.lower > end ? std::numeric_limits<double>::infinity()
                                           : std::min(1.0, deviation.upper / end));
  }
};

/// A scale up to the tolerance, if there is one above 0, else up to the largest distance proven. If that is hardly more
/// than a rounding, the scale ends at a billionth of the original's diagonal.
[[nodiscard]] inline DeviationScale scale_for(double tolerance, const Bounds& distance, double diagonal) {
  if (tolerance > 0) return {tolerance, "tolerance"};
  const double largest = distance.upper < std::numeric_limits<double>::infinity() ? distance.upper : distance.lower;
  const double least = std::max(1e-9 * diagonal, std::numeric_limits<double>::min());
  if (largest < least) return {least, "1e-9 of the diagonal"};
  return {largest, "proven maximum"};
}

}  // namespace meshbound::tools
