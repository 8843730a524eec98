// SPDX-License-Identifier: MIT
#pragma once
#include <atomic>
#include <cstddef>
#include <memory>
#include <new>
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

/// One block of memory for several arrays, on large pages. What it gives out is never taken back one by one, but by
/// loans. Several threads may take memory at a time.
class Arena {
 public:
  Arena() = default;  ///< has nothing to give
  /// A block too small to fill a good part of a large page is not worth one: then it has nothing to give either.
  explicit Arena(std::size_t bytes);

  /// Where several threads are to use it: they share its pages for the first touch (`for_each_task`), each of which
  /// takes as long as a thousand triangles do. Threads that meet at a page would both clear it, one of them for
  /// nothing.
  void touch();

  /// Memory that begins at a cache line, which no other array then shares. Null where not enough is left.
  [[nodiscard]] void* take(std::size_t bytes) noexcept;
  [[nodiscard]] bool owns(const void* storage) const noexcept;

  /// Takes back at its end what was taken since its beginning. No other thread may take memory at either moment.
  class Loan {
   public:
    explicit Loan(Arena& arena) : arena_(arena), taken_(arena.taken_) {}
    Loan(const Loan&) = delete;
    Loan& operator=(const Loan&) = delete;
    ~Loan() { arena_.taken_ = taken_; }

   private:
    Arena& arena_;
    std::size_t taken_;
  };

 private:
  struct Release {
    void operator()(std::byte* storage) const noexcept { deallocate_from_large_pages(storage); }
  };
  std::unique_ptr<std::byte, Release> block_;
  std::size_t bytes_ = 0;
  std::atomic<std::size_t> taken_{0};
};

/// Leaves new elements as they are: a build writes each of them in parallel, and the first to touch a page pays for it.
/// Takes memory from an arena while that has some; otherwise arrays that hold a large page or more are put on such
/// pages.
template <class T>
struct UninitialisedAllocator {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);
  using value_type = T;
  UninitialisedAllocator() = default;
  explicit UninitialisedAllocator(Arena* arena) : arena_(arena) {}
  template <class U>
  UninitialisedAllocator(const UninitialisedAllocator<U>& other) : arena_(other.arena()) {}  // NOLINT: as asked for
  [[nodiscard]] T* allocate(std::size_t n) {
    if (n > static_cast<std::size_t>(-1) / sizeof(T)) throw std::bad_array_new_length();
    if (arena_ != nullptr)
      if (void* const storage = arena_->take(n * sizeof(T))) return static_cast<T*>(storage);
    if (n < large_page / sizeof(T)) return std::allocator<T>().allocate(n);
    return static_cast<T*>(allocate_on_large_pages(n * sizeof(T)));
  }
  void deallocate(T* storage, std::size_t n) {
    if (arena_ != nullptr && arena_->owns(storage)) return;
    if (n < large_page / sizeof(T))
      std::allocator<T>().deallocate(storage, n);
    else
      deallocate_from_large_pages(storage);
  }
  template <class U>
  void construct(U*) {}
  template <class U, class... Args>
  void construct(U* at, Args&&... args) {
    std::construct_at(at, std::forward<Args>(args)...);
  }
  [[nodiscard]] Arena* arena() const { return arena_; }
  template <class U>
  bool operator==(const UninitialisedAllocator<U>& other) const {
    return arena_ == other.arena();
  }

 private:
  Arena* arena_ = nullptr;
};

/// A vector whose `resize` does not initialise.
template <class T>
using Array = std::vector<T, UninitialisedAllocator<T>>;

/// An empty array that takes its memory from an arena.
template <class T>
Array<T> array_in(Arena& arena) {
  return Array<T>(UninitialisedAllocator<T>(&arena));
}

}  // namespace meshbound
