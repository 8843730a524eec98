// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

namespace meshbound {

/// Items in buckets, all in one array: those of a bucket in the order in which they were added. Fewer than 2^32 items.
template <class Item>
class Buckets {
 public:
  /// `for_each_item(add)` calls `add(bucket, item)` for each item, twice the same. O(buckets + items).
  template <class ForEachItem>
  Buckets(std::size_t buckets, const ForEachItem& for_each_item) : end_(buckets + 1, 0) {
    // Until the items are put in, `end_` has the begin of each bucket.
    for_each_item([this](std::size_t bucket, const Item&) { ++end_[bucket + 1]; });
    std::partial_sum(end_.begin(), end_.end(), end_.begin());
    items_.resize(end_.back());
    for_each_item([this](std::size_t bucket, const Item& item) { items_[end_[bucket]++] = item; });
  }

  [[nodiscard]] std::size_t size() const { return end_.size() - 1; }
  [[nodiscard]] std::span<const Item> operator[](std::size_t bucket) const {
    return std::span(items_).subspan(begin(bucket), end_[bucket] - begin(bucket));
  }
  [[nodiscard]] std::span<Item> operator[](std::size_t bucket) {
    return std::span(items_).subspan(begin(bucket), end_[bucket] - begin(bucket));
  }

 private:
  [[nodiscard]] std::uint32_t begin(std::size_t bucket) const { return bucket == 0 ? 0 : end_[bucket - 1]; }

  std::vector<std::uint32_t> end_;  ///< by bucket: the index after its last item
  std::vector<Item> items_;
};

}  // namespace meshbound
