// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace meshbound {

/// Which current faces the cover of each original triangle uses, and the same relation seen from the faces.
class CoverAssignment {
 public:
  using Ids = std::vector<std::uint32_t>;

  explicit CoverAssignment(std::size_t originals) : faces_of_(originals) {}

  void reserve_face(std::uint32_t face) {
    if (face >= originals_of_.size()) originals_of_.resize(std::size_t{face} + 1);
  }
  [[nodiscard]] const Ids& faces_of(std::uint32_t original) const { return faces_of_[original]; }
  [[nodiscard]] std::span<const std::uint32_t> originals_of(std::uint32_t face) const {
    if (face >= originals_of_.size()) return {};
    return originals_of_[face];
  }

  /// Replaces the cover of `original`; `faces` receives the old one.
  void assign(std::uint32_t original, Ids& faces);

 private:
  std::vector<Ids> faces_of_;
  std::vector<Ids> originals_of_;
};

}  // namespace meshbound
