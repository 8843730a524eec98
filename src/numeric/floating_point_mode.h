// SPDX-License-Identifier: MIT
/// Bounds are proven for the floating-point mode that `check_floating_point_model` asks for, and it asks the calling
/// thread. The other threads of a team may have another mode: those of libgomp keep that of the region in which they
/// were started, whoever started it. So they take over the mode of the calling thread while they work for it.
#pragma once

#if defined(__SSE2_MATH__)
#include <xmmintrin.h>
#else
#include <cfenv>
#endif

namespace meshbound {

/// How a thread rounds, and whether it flushes denormal numbers to zero.
class FloatingPointMode {
 public:
#if defined(__SSE2_MATH__)
  /// That of the calling thread: the control register of SSE alone, which takes a twentieth of the time of <cfenv> or
  /// less.
  FloatingPointMode() : control_(_mm_getcsr()) {}
  /// Gives it to the calling thread.
  void set() const { _mm_setcsr(control_); }

 private:
  unsigned control_;
#else
  FloatingPointMode() { std::fegetenv(&environment_); }
  void set() const { std::fesetenv(&environment_); }

 private:
  std::fenv_t environment_;
#endif
};

/// While one lives, the thread that made it has the mode of another one; then its own again.
class BorrowedFloatingPointMode {
 public:
  explicit BorrowedFloatingPointMode(const FloatingPointMode& mode) { mode.set(); }
  ~BorrowedFloatingPointMode() { own_.set(); }
  BorrowedFloatingPointMode(const BorrowedFloatingPointMode&) = delete;
  BorrowedFloatingPointMode& operator=(const BorrowedFloatingPointMode&) = delete;

 private:
  FloatingPointMode own_;
};

}  // namespace meshbound
