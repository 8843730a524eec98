// SPDX-License-Identifier: MIT
#include "tiles/tile_cut.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "geometry/cut_axes.h"
#include "geometry/eigen_vec3.h"

namespace meshbound {
namespace {

using CutAxes = std::array<Vec3, 3>;

const CutAxes& axes_of(const TileCut& cut) { return cut_axes[static_cast<std::size_t>(cut.direction)]; }

double along(const Vec3& axis, const Eigen::Vector3d& p) { return axis.x * p.x() + axis.y * p.y() + axis.z * p.z(); }

/// The box of points by their places along axes.
class CutBox {
 public:
  explicit CutBox(const CutAxes& axes) : axes_(axes) {}
  void extend(const Eigen::Vector3d& p) {
    box_.extend(Eigen::Vector3d(along(axes_[0], p), along(axes_[1], p), along(axes_[2], p)));
  }
  [[nodiscard]] const Vec3& longest_axis() const {
    Eigen::Index axis = 0;
    box_.sizes().maxCoeff(&axis);
    return axes_[static_cast<std::size_t>(axis)];
  }

 private:
  const CutAxes& axes_;
  Eigen::AlignedBox3d box_;
};

/// How many of some items come before a plane.
std::size_t before_plane(std::size_t items, double share) {
  return std::max<std::size_t>(1, static_cast<std::size_t>(share * static_cast<double>(items)));
}

using Key = std::pair<double, std::uint32_t>;  ///< place along an axis, and number: no two items have the same

Key key_of(const CutItem& item, const Vec3& axis) { return {along(axis, to_eigen(item.position)), item.number}; }

template <class Use>
void for_each_item(std::span<const CutItem> items, const Use& use) {
  for (const CutItem& item : items) use(item);
}

template <class Use>
void for_each_item(const ItemStore<CutItem>& items, const Use& use) {
  items.for_each([&](std::size_t, const CutItem& item) { use(item); });
}

class TileCutter {
 public:
  TileCutter(std::uint64_t max_weight, const TileCut& cut, const UseTile& use, const StoreSpace& space,
             std::size_t max_in_memory)
      : max_weight_(max_weight), axes_(axes_of(cut)), use_(use), space_(space), max_in_memory_(max_in_memory) {}

  void cut(std::span<CutItem> items, double share) const {
    if (!items.empty()) cut_any(items, share);
  }
  void cut(ItemStore<CutItem> items, double share) const {
    if (items.size() > max_in_memory_) return cut_any(std::move(items), share);
    std::vector<CutItem> all(items.size());
    items.read(0, all);
    cut(std::span(all), share);
  }

 private:
  /// `Items` are in memory or in a store.
  template <class Items>
  void cut_any(Items items, double share) const {
    CutBox box(axes_);
    std::uint64_t weight = 0;
    for_each_item(items, [&](const CutItem& item) {
      box.extend(to_eigen(item.position));
      weight += item.weight;
    });
    if (items.size() == 1 || weight <= max_weight_) return use_all(items);
    auto [before, behind] = halves(items, box.longest_axis(), before_plane(items.size(), share));
    cut(std::move(before), 0.5);
    cut(std::move(behind), 0.5);
  }

  template <class Items>
  void use_all(const Items& items) const {
    std::vector<std::uint32_t> numbers;
    numbers.reserve(items.size());
    for_each_item(items, [&](const CutItem& item) { numbers.push_back(item.number); });
    std::sort(numbers.begin(), numbers.end());
    use_(numbers);
  }

  /// The first `rank` items along the axis, and the others.
  static std::pair<std::span<CutItem>, std::span<CutItem>> halves(std::span<CutItem> items, const Vec3& axis,
                                                                  std::size_t rank) {
    std::nth_element(
        items.begin(), items.begin() + static_cast<std::ptrdiff_t>(rank), items.end(),
        [&](const CutItem& item, const CutItem& other) { return key_of(item, axis) < key_of(other, axis); });
    return {items.first(rank), items.subspan(rank)};
  }
  /// Gives the room of the items back.
  std::pair<ItemStore<CutItem>, ItemStore<CutItem>> halves(ItemStore<CutItem>& items, const Vec3& axis,
                                                           std::size_t rank) const {
    const Key first_behind = key_at(items, axis, rank);
    ItemStore<CutItem> before(space_), behind(space_);
    for_each_item(items,
                  [&](const CutItem& item) { (key_of(item, axis) < first_behind ? before : behind).append(item); });
    items = ItemStore<CutItem>(StoreSpace());
    return {std::move(before), std::move(behind)};
  }

  /// The key that has `rank` others before it. A sample of what lies between two keys around it narrows these down
  /// until all keys between them fit into memory.
  [[nodiscard]] Key key_at(const ItemStore<CutItem>& items, const Vec3& axis, std::size_t rank) const {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Key low{-infinity, 0}, high{infinity, 0};
    std::size_t before = 0, between = items.size();  // keys before `low`, and from there to `high`
    while (between > max_in_memory_) {
      const std::size_t step = std::max<std::size_t>(between / samples, 1);
      std::vector<Key> sample = keys_between(items, axis, low, high, step);
      std::sort(sample.begin(), sample.end());
      const std::size_t expected = (rank - before) / step, margin = sample.size() / 64 + 1;
      const Key from = expected > margin ? sample[expected - margin] : low;
      const Key to = expected + margin < sample.size() ? sample[expected + margin] : high;
      std::size_t before_from = 0, before_to = 0;
      for_each_item(items, [&](const CutItem& item) {
        const Key key = key_of(item, axis);
        if (key < from) ++before_from;
        if (key < to) ++before_to;
      });
      if (rank < before_from) {
        high = from;
        between = before_from - before;
      } else if (rank >= before_to) {
        low = to;
        between -= before_to - before;
        before = before_to;
      } else {
        low = from;
        high = to;
        between = before_to - before_from;
        before = before_from;
      }
    }
    std::vector<Key> keys = keys_between(items, axis, low, high, 1);
    const auto at = keys.begin() + static_cast<std::ptrdiff_t>(rank - before);
    std::nth_element(keys.begin(), at, keys.end());
    return *at;
  }

  /// Every so many of the keys from `low` on that are before `high`.
  [[nodiscard]] static std::vector<Key> keys_between(const ItemStore<CutItem>& items, const Vec3& axis, const Key& low,
                                                     const Key& high, std::size_t step) {
    std::vector<Key> keys;
    std::size_t count = 0;
    for_each_item(items, [&](const CutItem& item) {
      const Key key = key_of(item, axis);
      if (key < low || !(key < high)) return;
      if (count++ % step == 0) keys.push_back(key);
    });
    return keys;
  }

  static constexpr std::size_t samples = std::size_t{1} << 16;

  std::uint64_t max_weight_;
  const CutAxes& axes_;
  const UseTile& use_;
  const StoreSpace& space_;
  std::size_t max_in_memory_;
};

}  // namespace

void cut_into_tiles(std::vector<CutItem> items, std::uint64_t max_weight, const TileCut& cut, const UseTile& use) {
  TileCutter(max_weight, cut, use, {}, items.size()).cut(std::span(items), cut.first_share);
}

void cut_into_tiles(ItemStore<CutItem> items, std::uint64_t max_weight, const TileCut& cut, const StoreSpace& space,
                    const UseTile& use, std::size_t max_in_memory) {
  TileCutter(max_weight, cut, use, space, max_in_memory).cut(std::move(items), cut.first_share);
}

}  // namespace meshbound
