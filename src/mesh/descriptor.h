// SPDX-License-Identifier: MIT
#pragma once
#include <unistd.h>

#include <utility>

namespace meshbound {

/// A file descriptor of this process, which is closed at the end; or none.
class Descriptor {
 public:
  Descriptor() = default;
  /// Takes over what `open` and its like return, below 0 for none.
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(other.release()) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }

  [[nodiscard]] bool is_open() const { return number_ >= 0; }
  [[nodiscard]] int number() const { return number_; }  ///< below 0: none
  /// Leaves it to the caller to close it.
  [[nodiscard]] int release() { return std::exchange(number_, -1); }

 private:
  int number_ = -1;
};

}  // namespace meshbound
