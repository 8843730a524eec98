// SPDX-License-Identifier: MIT
#pragma once

namespace meshbound {

/// The float nearest to `x`. The volatile stops the SLP vectoriser of GCC 12 (on at -O2), which would turn double ->
/// float -> double of two neighbours into a plain copy; the bound would then be that of another mesh than the one
/// written.
[[nodiscard]] inline double rounded_to_float(double x) {
  const volatile float rounded = static_cast<float>(x);
  return static_cast<double>(rounded);
}

}  // namespace meshbound
