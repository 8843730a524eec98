// SPDX-License-Identifier: MIT
#include <limits>

#include "meshbound/error.h"
#include "numeric/rounding.h"

#if defined(__FAST_MATH__)
#error "meshbound proves its bounds for IEEE arithmetic; build it without -ffast-math"
#endif

namespace meshbound {

void check_floating_point_model() {
  static_assert(std::numeric_limits<double>::is_iec559 && std::numeric_limits<double>::digits == 53);
  // volatile: computed by the process, not by the compiler.
  volatile double one = 1, tiny = std::numeric_limits<double>::min(), half = 0.5, ulp = 0x1p-52, large = 0x1p53,
                  three = 3;
  if (tiny * half == 0)
    throw Error(
        "denormal numbers are flushed to zero in this process; no bound would hold; unset FTZ/DAZ or make a "
        "FloatingPointScope");
  if (one + ulp * half != one || -one - ulp * half != -one || large + one != large || large + three != 0x1p53 + 4)
    throw Error("the rounding mode of this process is not to nearest; call fesetround(FE_TONEAREST)");
  volatile double a = 1 + 0x1p-30, b = 1 - 0x1p-30;
  if (a * b - one != 0) throw Error("multiply-adds are fused in this build; compile with -ffp-contract=off");
}

}  // namespace meshbound
