// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace meshbound {

/// Bytes of a large page of common machines, and the alignment it asks for.
inline constexpr std::size_t large_page = std::size_t{1} << 21;

/// Storage that begins on a large page; on Linux the kernel is asked to back it with such pages (madvise): the first
/// use of 2 MB then costs one page fault instead of 512. Elsewhere just aligned. Throws std::bad_alloc.
[[nodiscard]] void* allocate_on_large_pages(std::size_t bytes);
void deallocate_from_large_pages(void* storage) noexcept;

/// Leaves new elements as they are: a build writes each of them in parallel, and the first to touch a page pays for it.
/// Arrays that hold a large page or more are put on such pages.
template <class T>
struct UninitialisedAllocator : std::allocator<T> {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);
  template <class U>
  struct rebind {
    using other = UninitialisedAllocator<U>;
  };
  UninitialisedAllocator() = default;
  template <class U>
  UninitialisedAllocator(const UninitialisedAllocator<U>&) {}  // NOLINT: as the standard asks
  [[nodiscard]] T* allocate(std::size_t n) {
    if (n < large_page / sizeof(T)) return std::allocator<T>::allocate(n);
    if (n > static_cast<std::size_t>(-1) / sizeof(T)) throw std::bad_array_new_length();
    return static_cast<T*>(allocate_on_large_pages(n * sizeof(T)));
  }
  void deallocate(T* storage, std::size_t n) {
    if (n < large_page / sizeof(T))
      std::allocator<T>::deallocate(storage, n);
    else
      deallocate_from_large_pages(storage);
  }
  template <class U>
  void construct(U*) {}
  template <class U, class... Args>
  void construct(U* at, Args&&... args) {
    std::construct_at(at, std::forward<Args>(args)...);
  }
};

/// A vector whose `resize` does not initialise.
template <class T>
using Array = std::vector<T, UninitialisedAllocator<T>>;

}  // namespace meshbound
