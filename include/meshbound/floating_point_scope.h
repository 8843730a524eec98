// SPDX-License-Identifier: MIT
#pragma once
#include <cfenv>
#include <vector>

namespace meshbound {

/// Bounds need denormal numbers and rounding to nearest; where an engine has switched on flush-to-zero or another
/// rounding mode, the library throws `Error`. The mode of the calling thread is what counts. While one of these lives,
/// the thread that made it, and the threads of OpenMP that work for it, have the default mode of the machine; then they
/// have their own again. To be made, used and destroyed by one thread, outside of parallel regions. Does not help code
/// compiled with -ffast-math.
class FloatingPointScope {
 public:
  /// For calls that are asked for `threads`, where that is more than OpenMP has by itself.
  explicit FloatingPointScope(int threads = 0);
  ~FloatingPointScope();
  FloatingPointScope(const FloatingPointScope&) = delete;
  FloatingPointScope& operator=(const FloatingPointScope&) = delete;

 private:
  std::vector<std::fenv_t> before_;  ///< by thread of OpenMP
};

}  // namespace meshbound
