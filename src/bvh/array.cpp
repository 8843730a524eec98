// SPDX-License-Identifier: MIT
#include "bvh/array.h"

#include <algorithm>
#include <functional>
#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#endif

#include "numeric/tasks.h"

namespace meshbound {
namespace {

constexpr std::size_t cache_line = 64;

}  // namespace

void* allocate_on_large_pages(std::size_t bytes) {
  void* const storage = ::operator new (bytes, std::align_val_t{large_page});
#if defined(__linux__)
  // Only pages that the array fills: a last one in part would cost memory that nobody uses. A kernel that has none to
  // give refuses, which costs time only.
  static_cast<void>(madvise(storage, bytes / large_page * large_page, MADV_HUGEPAGE));
#endif
  return storage;
}

Arena::Arena(std::size_t bytes) {
  // A last page that is used by half is worth its memory.
  const std::size_t rounded = (bytes + large_page / 2) / large_page * large_page;
  if (rounded == 0) return;
  bytes_ = std::max(bytes, rounded);
  block_.reset(static_cast<std::byte*>(allocate_on_large_pages(bytes_)));
}

void Arena::touch() {
  for_each_task(bytes_ / large_page, [&](std::size_t page) { block_.get()[page * large_page] = std::byte{0}; });
}

void* Arena::take(std::size_t bytes) noexcept {
  const std::size_t lines = (bytes + cache_line - 1) / cache_line * cache_line;
  std::size_t begin = taken_;
  do {
    if (lines < bytes || lines > bytes_ - begin) return nullptr;
  } while (!taken_.compare_exchange_weak(begin, begin + lines));
  return block_.get() + begin;
}

bool Arena::owns(const void* storage) const noexcept {
  const std::less_equal<const void*> not_after;
  return block_ && not_after(block_.get(), storage) && !not_after(block_.get() + bytes_, storage);
}

void deallocate_from_large_pages(void* storage) noexcept { ::operator delete (storage, std::align_val_t{large_page}); }

}  // namespace meshbound
