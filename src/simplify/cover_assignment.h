// SPDX-License-Identifier: MIT
#pragma once
#include <array>
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
  [[nodiscard]] std::span<const std::uint32_t> faces_of(std::uint32_t original) const {
    const Faces& faces = faces_of_[original];
    if (faces.size <= Faces::room) return {faces.ids.data(), faces.size};
    return many_[faces.ids[0]];
  }
  /// The cover of `original` is going to be asked for.
  void prefetch(std::uint32_t original) const { __builtin_prefetch(&faces_of_[original]); }
  [[nodiscard]] std::span<const std::uint32_t> originals_of(std::uint32_t face) const {
    if (face >= originals_of_.size()) return {};
    return originals_of_[face];
  }

  /// Replaces the cover of `original`.
  void assign(std::uint32_t original, std::span<const std::uint32_t> faces);

 private:
  /// Nearly all covers have three faces at most: these lie side by side, the others in `many_[ids[0]]`.
  struct Faces {
    static constexpr std::uint32_t room = 3;
    std::uint32_t size = 0;
    std::array<std::uint32_t, room> ids{};
  };
  void store(Faces& at, std::span<const std::uint32_t> faces);

  std::vector<Faces> faces_of_;
  std::vector<Ids> many_;
  std::vector<std::uint32_t> unused_;  ///< of `many_`
  std::vector<Ids> originals_of_;
};

}  // namespace meshbound
