// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <utility>
#include <vector>

namespace meshbound {

/// Which current faces the cover of each original triangle uses, and the same relation seen from the faces. Covers that
/// have no face in common, neither before nor after, may be assigned by several threads.
class CoverAssignment {
 public:
  using Ids = std::vector<std::uint32_t>;

  explicit CoverAssignment(std::size_t originals) : faces_of_(originals) {}

  void reserve_face(std::uint32_t face) {
    if (face >= originals_of_.size()) originals_of_.resize(std::size_t{face} + 1);
  }
  [[nodiscard]] std::span<const std::uint32_t> faces_of(std::uint32_t original) const {
    return faces_of_[original].ids();
  }
  /// The cover of `original` is going to be asked for.
  void prefetch(std::uint32_t original) const { __builtin_prefetch(&faces_of_[original]); }
  [[nodiscard]] std::span<const std::uint32_t> originals_of(std::uint32_t face) const {
    if (face >= originals_of_.size()) return {};
    return originals_of_[face];
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

  /// The faces of a cover. Most have three at most, which need no memory of their own.
  class Faces {
   public:
    Faces() = default;
    Faces(Faces&& other) noexcept : size_(std::exchange(other.size_, 0)), few_(other.few_) {}
    Faces& operator=(Faces&&) = delete;
    ~Faces() { free(); }

    [[nodiscard]] std::span<const std::uint32_t> ids() const { return {is_many() ? many() : few_.data(), size_}; }
    void set(std::span<const std::uint32_t> faces);

   private:
    [[nodiscard]] bool is_many() const { return size_ > few_.size(); }
    /// Where more than a few are: the address lies in `few_`.
    [[nodiscard]] std::uint32_t* many() const {
      std::uint32_t* list = nullptr;
      std::memcpy(&list, few_.data(), sizeof(list));
      return list;
    }
    void free() {
      if (is_many()) delete[] many();
    }

    std::uint32_t size_ = 0;
    std::array<std::uint32_t, 3> few_{};
    static_assert(sizeof(std::uint32_t*) <= sizeof(few_));
  };

  std::vector<Faces> faces_of_;
  std::vector<Ids> originals_of_;
};

}  // namespace meshbound
