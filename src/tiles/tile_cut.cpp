// SPDX-License-Identifier: MIT
#include "tiles/tile_cut.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <utility>

#include "geometry/cut_axes.h"
#include "geometry/eigen_vec3.h"
#include "numeric/numbers_below.h"

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

class TileCutter {
 public:
  TileCutter(const PositionOf& position, std::span<const std::uint32_t> weights, std::uint64_t max_weight,
             const TileCut& cut)
      : position_(position),
        weights_(weights),
        max_weight_(max_weight),
        axes_(axes_of(cut)),
        first_share_(cut.first_share) {}

  NumberLists run(std::vector<std::uint32_t> items) {
    NumberLists tiles;
    tiles.numbers = std::move(items);
    if (!tiles.numbers.empty()) cut(tiles, tiles.numbers, first_share_);
    return tiles;
  }

 private:
  void cut(NumberLists& tiles, std::span<std::uint32_t> items, double share) const {
    if (items.size() == 1 || weight(items) <= max_weight_) {
      std::sort(items.begin(), items.end());
      tiles.begin.push_back(tiles.begin.back() + static_cast<std::uint32_t>(items.size()));
      return;
    }
    CutBox box(axes_);
    for (const std::uint32_t i : items) box.extend(position_(i));
    const Vec3& axis = box.longest_axis();
    const std::size_t middle = before_plane(items.size(), share);
    std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(middle), items.end(),
                     [&](std::uint32_t i, std::uint32_t j) {
                       const double at = along(axis, position_(i)), other = along(axis, position_(j));
                       return at < other || (at == other && i < j);
                     });
    cut(tiles, items.first(middle), 0.5);
    cut(tiles, items.subspan(middle), 0.5);
  }

  [[nodiscard]] std::uint64_t weight(std::span<const std::uint32_t> items) const {
    if (weights_.empty()) return items.size();
    return std::accumulate(items.begin(), items.end(), std::uint64_t{0},
                           [&](std::uint64_t sum, std::uint32_t i) { return sum + weights_[i]; });
  }

  const PositionOf& position_;
  std::span<const std::uint32_t> weights_;
  std::uint64_t max_weight_;
  const CutAxes& axes_;
  double first_share_;
};

/// As `TileCutter` for items of a store.
class StoredTileCutter {
 public:
  StoredTileCutter(std::uint64_t max_weight, const TileCut& cut, const StoreSpace& space, const UseTile& use,
                   std::size_t max_in_memory)
      : max_weight_(max_weight), cut_(cut), space_(space), use_(use), max_in_memory_(max_in_memory) {}

  void cut(ItemStore<CutItem> items, double share) const {
    if (items.size() <= max_in_memory_) return cut_in_memory(items, share);
    CutBox box(axes_of(cut_));
    std::uint64_t weight = 0;
    items.for_each([&](std::size_t, const CutItem& item) {
      box.extend(to_eigen(item.position));
      weight += item.weight;
    });
    if (weight <= max_weight_) return use_all(items);
    const Vec3& axis = box.longest_axis();
    const Key first_behind = key_at(items, axis, before_plane(items.size(), share));
    ItemStore<CutItem> before(space_), behind(space_);
    items.for_each(
        [&](std::size_t, const CutItem& item) { (key_of(item, axis) < first_behind ? before : behind).append(item); });
    items = ItemStore<CutItem>(StoreSpace());  // gives the room back
    cut(std::move(before), 0.5);
    cut(std::move(behind), 0.5);
  }

 private:
  using Key = std::pair<double, std::uint32_t>;  ///< place along an axis, and number: no two items have the same

  static Key key_of(const CutItem& item, const Vec3& axis) {
    return {along(axis, to_eigen(item.position)), item.number};
  }

  void cut_in_memory(const ItemStore<CutItem>& items, double share) const {
    std::vector<CutItem> all(items.size());
    items.read(0, all);
    std::vector<std::uint32_t> weights;
    for (const CutItem& item : all) weights.push_back(item.weight);
    const NumberLists tiles =
        cut_into_tiles(numbers_below(all.size()), [&](std::uint32_t i) { return to_eigen(all[i].position); }, weights,
                       max_weight_, {cut_.direction, share});
    for (std::size_t k = 0; k < tiles.size(); ++k) {
      std::vector<std::uint32_t> numbers;
      for (const std::uint32_t i : tiles[k]) numbers.push_back(all[i].number);
      use_(numbers);
    }
  }

  void use_all(const ItemStore<CutItem>& items) const {
    std::vector<std::uint32_t> numbers;
    items.for_each([&](std::size_t, const CutItem& item) { numbers.push_back(item.number); });
    use_(numbers);
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
      items.for_each([&](std::size_t, const CutItem& item) {
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
    items.for_each([&](std::size_t, const CutItem& item) {
      const Key key = key_of(item, axis);
      if (key < low || !(key < high)) return;
      if (count++ % step == 0) keys.push_back(key);
    });
    return keys;
  }

  static constexpr std::size_t samples = std::size_t{1} << 16;

  std::uint64_t max_weight_;
  const TileCut& cut_;
  const StoreSpace& space_;
  const UseTile& use_;
  std::size_t max_in_memory_;
};

}  // namespace

NumberLists cut_into_tiles(std::vector<std::uint32_t> items, const PositionOf& position,
                           std::span<const std::uint32_t> weights, std::uint64_t max_weight, const TileCut& cut) {
  return TileCutter(position, weights, max_weight, cut).run(std::move(items));
}

void cut_into_tiles(ItemStore<CutItem> items, std::uint64_t max_weight, const TileCut& cut, const StoreSpace& space,
                    const UseTile& use, std::size_t max_in_memory) {
  StoredTileCutter(max_weight, cut, space, use, max_in_memory).cut(std::move(items), cut.first_share);
}

}  // namespace meshbound
