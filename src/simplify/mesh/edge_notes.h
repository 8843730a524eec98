// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "simplify/mesh/array_mesh.h"

namespace meshbound {

/// Whether an edge that was refused with this deviation, in tolerances, needs other ends: beyond hardly any is accepted
/// after a change around it.
inline constexpr float far_beyond = 1.25F;
inline bool is_far_beyond(float deviation) { return deviation > far_beyond; }

/// One word for each edge: its index in an `EdgeQueue`, the deviation with which it was refused, or nothing. An edge
/// that is not refused is open, as all are at first.
class EdgeNotes {
 public:
  explicit EdgeNotes(std::size_t edges) : words_(edges, 0) {}

  [[nodiscard]] bool is_queued(Corner edge) const { return (words_[edge] & queued) != 0; }
  /// The index of a queued edge, below 2^31.
  [[nodiscard]] std::uint32_t index(Corner edge) const { return words_[edge] & ~queued; }
  void set_index(Corner edge, std::uint32_t index) { words_[edge] = queued | index; }
  void leave_queue(Corner edge) { words_[edge] = 0; }

  [[nodiscard]] bool is_refused(Corner edge) const { return words_[edge] != 0 && !is_queued(edge); }
  /// What a refused edge was refused with; 0 for another one.
  [[nodiscard]] float deviation(Corner edge) const { return is_queued(edge) ? 0 : std::bit_cast<float>(words_[edge]); }
  /// Refuses an edge that is in no queue. A deviation of 0, or one that is not a number, becomes the least there is.
  void refuse(Corner edge, float deviation) {
    constexpr float least = std::numeric_limits<float>::denorm_min();
    words_[edge] = std::bit_cast<std::uint32_t>(deviation > least ? deviation : least);
  }
  void open(Corner edge) {
    if (!is_queued(edge)) words_[edge] = 0;
  }
  /// Opens an edge that something has changed near, unless that hardly helps.
  void reopen(Corner edge) {
    if (!is_far_beyond(deviation(edge))) open(edge);
  }
  /// These take no edge out of a queue: there must be none in one.
  void open_all() { std::fill(words_.begin(), words_.end(), 0); }
  void refuse_all() {
    for (Corner e = 0; e < words_.size(); ++e)
      if (!is_refused(e)) refuse(e, 0);
  }
  [[nodiscard]] std::size_t size() const { return words_.size(); }

 private:
  static constexpr std::uint32_t queued = 0x80000000;  ///< the sign of a float
  std::vector<std::uint32_t> words_;
};

}  // namespace meshbound
