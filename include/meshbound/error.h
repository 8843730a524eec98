// SPDX-License-Identifier: MIT
#pragma once
#include <stdexcept>

namespace meshbound {

/// Base of every exception this library throws. `what()` is one line that says what is wrong, where, and what to do.
class Error : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The data is not a mesh that a bound can be given for: non-finite coordinates, indices out of range, no faces,
/// malformed files, options that contradict each other.
class InvalidInput : public Error {
  using Error::Error;
};

/// The work was cancelled through the flag in its options; nothing was changed.
class Interrupted : public Error {
  using Error::Error;
};

/// A file or folder cannot be opened, mapped, read, written or renamed.
class IoError : public Error {
  using Error::Error;
};

}  // namespace meshbound
