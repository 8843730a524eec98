// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "simplify/cover/id_list.h"

namespace meshbound {

/// Which current faces the cover of each original triangle uses, and the same relation seen from the faces. Covers that
/// have no face in common, neither before nor after, may be assigned by several threads.
class CoverAssignment {
 public:
  using Ids = std::vector<std::uint32_t>;

  explicit CoverAssignment(std::size_t originals) : faces_of_(originals) {}

  /// For faces with numbers below `count`.
  void reserve_faces(std::size_t count) {
    if (count > originals_of_.size()) originals_of_.resize(count);
  }
  [[nodiscard]] std::span<const std::uint32_t> faces_of(std::uint32_t original) const {
    return faces_of_[original].ids();
  }
  /// The cover of `original` is going to be asked for.
  void prefetch(std::uint32_t original) const { __builtin_prefetch(&faces_of_[original]); }
  [[nodiscard]] std::span<const std::uint32_t> originals_of(std::uint32_t face) const {
    if (face >= originals_of_.size()) return {};
    return originals_of_[face].ids();
  }

  /// Replaces the covers of some originals by cover_of(0), cover_of(1), ..., in their order, each face once. The faces
  /// must have been reserved where other threads assign as well. Linear in what the faces that lose an original cover.
  template <class CoverOf>
  void assign(std::span<const std::uint32_t> originals, const CoverOf& cover_of) {
    Ids left;  // faces that lose an original
    for (std::size_t i = 0; i < originals.size(); ++i) replace(originals[i], cover_of(i), left);
    remove_from_lists(left);
  }
  void assign(std::uint32_t original, std::span<const std::uint32_t> faces) {
    assign({&original, 1}, [&](std::size_t) { return faces; });
  }

 private:
  /// Replaces the cover of an original, which stays in the lists of the faces that it has `left`.
  void replace(std::uint32_t original, std::span<const std::uint32_t> faces, Ids& left);
  void remove_from_lists(Ids& left);

  std::vector<IdList> faces_of_, originals_of_;
};

}  // namespace meshbound
