// SPDX-License-Identifier: MIT
/// Replaces operator new of a whole test program by one that fails at will: to be included by one source file of it.
#pragma once
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <new>

namespace {

constexpr std::ptrdiff_t unlimited = std::numeric_limits<std::ptrdiff_t>::max() / 2;

/// How many more allocations succeed, of all threads together.
std::atomic<std::ptrdiff_t> allowed{unlimited};

void* allocate(std::size_t bytes, std::size_t alignment) {
  if (allowed-- <= 0) throw std::bad_alloc();
  const std::size_t rounded = (std::max<std::size_t>(bytes, 1) + alignment - 1) / alignment * alignment;
  if (void* const storage = std::aligned_alloc(alignment, rounded)) return storage;
  throw std::bad_alloc();
}

}  // namespace

void* operator new(std::size_t bytes) { return allocate(bytes, alignof(std::max_align_t)); }
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return allocate(bytes, static_cast<std::size_t>(alignment));
}
void operator delete(void* storage) noexcept { std::free(storage); }
void operator delete(void* storage, std::size_t) noexcept { std::free(storage); }
void operator delete(void* storage, std::align_val_t) noexcept { std::free(storage); }
void operator delete(void* storage, std::size_t, std::align_val_t) noexcept { std::free(storage); }
