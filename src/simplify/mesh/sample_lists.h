// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <vector>

#include "numeric/no_index.h"

namespace meshbound {

/// Which samples belong to each face of a mesh, by numbers. Threads may change the lists of different faces at once.
class SampleLists {
 public:
  explicit SampleLists(std::size_t faces) : first_(faces, no_index) {}

  /// Makes room for so many samples.
  void reserve(std::size_t samples) { following_.reserve(samples); }
  /// Adds the sample with the next number, from 0 on.
  void add(std::uint32_t face) {
    following_.push_back(no_index);
    give_to(static_cast<std::uint32_t>(following_.size() - 1), face);
  }
  /// Puts a sample, which must be in no list, into that of the face.
  void give_to(std::uint32_t sample, std::uint32_t face) {
    following_[sample] = first_[face];
    first_[face] = sample;
  }
  /// Empties the list of the face: its samples are in no list then.
  void clear(std::uint32_t face) { first_[face] = no_index; }
  /// Calls visit(sample) for all samples of the face.
  template <class Visit>
  void for_each(std::uint32_t face, const Visit& visit) const {
    for (std::uint32_t s = first_[face]; s != no_index; s = following_[s]) visit(s);
  }

 private:
  std::vector<std::uint32_t> first_;      ///< by face
  std::vector<std::uint32_t> following_;  ///< by sample
};

}  // namespace meshbound
