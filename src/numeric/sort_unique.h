// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <vector>

namespace meshbound {

/// Sorts the items and leaves one of each. O(n log n), or O(n) where they are sorted.
template <class Item>
void sort_unique(std::vector<Item>& items) {
  if (!std::is_sorted(items.begin(), items.end())) std::sort(items.begin(), items.end());
  items.erase(std::unique(items.begin(), items.end()), items.end());
}

}  // namespace meshbound
