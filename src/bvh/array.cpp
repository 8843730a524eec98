// SPDX-License-Identifier: MIT
#include "bvh/array.h"

#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace meshbound {

void* allocate_on_large_pages(std::size_t bytes) {
  void* const storage = ::operator new (bytes, std::align_val_t{large_page});
#if defined(__linux__)
  // Only pages that the array fills: a last one in part would cost memory that nobody uses. A kernel that has none to
  // give refuses, which costs time only.
  static_cast<void>(madvise(storage, bytes / large_page * large_page, MADV_HUGEPAGE));
#endif
  return storage;
}

void deallocate_from_large_pages(void* storage) noexcept { ::operator delete (storage, std::align_val_t{large_page}); }

}  // namespace meshbound
