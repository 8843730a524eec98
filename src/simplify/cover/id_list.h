// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <utility>

namespace meshbound {

/// A list of numbers in 16 bytes. Three at most need no memory of their own; more have room for the next power of two,
/// so that the size says how much there is.
class IdList {
 public:
  IdList() = default;
  IdList(IdList&& other) noexcept : size_(std::exchange(other.size_, 0)), few_(other.few_) {}
  IdList& operator=(IdList&& other) noexcept {
    std::swap(size_, other.size_);
    std::swap(few_, other.few_);
    return *this;
  }
  ~IdList() { free(); }

  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] std::span<const std::uint32_t> ids() const { return {begin(), size_}; }
  /// `ids` must not be part of this list.
  void assign(std::span<const std::uint32_t> ids) {
    resize(ids.size());
    std::copy(ids.begin(), ids.end(), begin());
  }
  void add(std::uint32_t id) {
    resize(std::size_t{size_} + 1);
    begin()[size_ - 1] = id;
  }
  template <class IsWanted>
  void keep_if(const IsWanted& is_wanted) {
    const auto end = std::remove_if(begin(), begin() + size_, [&](std::uint32_t id) { return !is_wanted(id); });
    resize(static_cast<std::size_t>(end - begin()));
  }

 private:
  static constexpr std::size_t few = 3;
  static std::size_t room_for(std::size_t size) { return size <= few ? few : std::bit_ceil(size); }
  [[nodiscard]] bool is_many() const { return size_ > few; }
  /// Where more than a few are: the address lies in `few_`.
  [[nodiscard]] std::uint32_t* many() const {
    std::uint32_t* list = nullptr;
    std::memcpy(&list, few_.data(), sizeof(list));
    return list;
  }
  [[nodiscard]] const std::uint32_t* begin() const { return is_many() ? many() : few_.data(); }
  [[nodiscard]] std::uint32_t* begin() { return is_many() ? many() : few_.data(); }
  void free() {
    if (is_many()) delete[] many();
  }
  /// Keeps the numbers that there is room for.
  void resize(std::size_t size) {
    if (room_for(size) != room_for(size_)) {
      std::uint32_t* const list = size > few ? new std::uint32_t[room_for(size)] : nullptr;
      std::array<std::uint32_t, few> kept{};
      std::copy_n(std::as_const(*this).begin(), std::min<std::size_t>(size, size_),
                  list != nullptr ? list : kept.data());
      free();
      if (list != nullptr) std::memcpy(kept.data(), &list, sizeof(list));
      few_ = kept;
    }
    size_ = static_cast<std::uint32_t>(size);
  }

  std::uint32_t size_ = 0;
  std::array<std::uint32_t, few> few_{};
  static_assert(sizeof(std::uint32_t*) <= sizeof(few_));
};

}  // namespace meshbound
