// SPDX-License-Identifier: MIT
#pragma once
#include "meshbound/error.h"

namespace meshbound {

/// A limit of time that an option gives, infinite for none. Throws `InvalidInput` for a negative one and for one that
/// is not a number: neither says when to end.
inline double checked_seconds(double seconds) {
  if (!(seconds >= 0)) throw InvalidInput("the time limit must be 0 seconds or more");
  return seconds;
}

}  // namespace meshbound
