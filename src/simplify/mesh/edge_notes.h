// SPDX-License-Identifier: MIT
#pragma once
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "simplify/mesh/array_mesh.h"

namespace meshbound {

/// One word for each edge: its index in an `EdgeQueue`, or, while it is in none, the deviation with which it was
/// refused last. An edge that leaves a queue has none until it is refused.
class EdgeNotes {
 public:
  explicit EdgeNotes(std::size_t edges) : words_(edges, 0) {}

  [[nodiscard]] bool is_queued(Corner edge) const { return (words_[edge] & queued) != 0; }
  /// The index of a queued edge, below 2^31.
  [[nodiscard]] std::uint32_t index(Corner edge) const { return words_[edge] & ~queued; }
  void set_index(Corner edge, std::uint32_t index) { words_[edge] = queued | index; }
  void leave_queue(Corner edge) { words_[edge] = 0; }

  /// 0 where there is none.
  [[nodiscard]] float deviation(Corner edge) const { return is_queued(edge) ? 0 : std::bit_cast<float>(words_[edge]); }
  /// Notes the deviation with which an edge was refused. It must not be in a queue.
  void set_deviation(Corner edge, float deviation) {
    words_[edge] = deviation > 0 ? std::bit_cast<std::uint32_t>(deviation) : 0;  // not even the sign of a NaN
  }

 private:
  static constexpr std::uint32_t queued = 0x80000000;  ///< the sign of a float
  std::vector<std::uint32_t> words_;
};

}  // namespace meshbound
