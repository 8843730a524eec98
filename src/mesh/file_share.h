// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>

namespace meshbound {

/// One of `count` equal shares of what a file holds, each of which another process reads or writes: of n items it has
/// those from `begin(n)` up to `end(n)`.
struct FileShare {
  std::size_t index = 0, count = 1;

  [[nodiscard]] std::size_t begin(std::size_t n) const { return n / count * index + n % count * index / count; }
  [[nodiscard]] std::size_t end(std::size_t n) const { return FileShare{index + 1, count}.begin(n); }
  [[nodiscard]] std::size_t size(std::size_t n) const { return end(n) - begin(n); }
};

}  // namespace meshbound
