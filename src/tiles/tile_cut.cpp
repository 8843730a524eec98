// SPDX-License-Identifier: MIT
#include "tiles/tile_cut.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "geometry/cut_axes.h"
#include "tiles/plane_search.h"

namespace meshbound {
namespace {

const CutAxes& axes_of(const TileCut& cut) { return cut_axes[static_cast<std::size_t>(cut.direction)]; }

/// How many of some items come before a plane.
std::size_t before_plane(std::size_t items, double share) {
  return std::max<std::size_t>(1, static_cast<std::size_t>(share * static_cast<double>(items)));
}

template <class Use>
void for_each_item(std::span<const CutItem> items, const Use& use) {
  for (const CutItem& item : items) use(item);
}

template <class Use>
void for_each_item(const ItemStore<CutItem>& items, const Use& use) {
  items.for_each([&](std::size_t, const CutItem& item) { use(item); });
}

/// What need not be cut: what weighs no more, or has no more items.
struct CutLimits {
  std::uint64_t max_weight = 0;
  std::size_t max_in_memory = 0;
};

/// Planes that cut the items of a store into parts: a binary tree, whose leaves are the parts. All planes of a level
/// are found in the same rounds, which read all items: mostly one for a level.
class CutTree {
 public:
  CutTree(const ItemStore<CutItem>& items, const CutAxes& axes, double share, const CutLimits& limits)
      : axes_(axes), limits_(limits) {
    CutExtent extent(axes);
    CutSample sample(limits.max_in_memory);
    for_each_item(items, [&](const CutItem& item) {
      extent.add(item);
      sample.add(item);
    });
    add({extent, std::move(sample.items())}, share);
    while (searches_ > 0) search(items);
  }

  [[nodiscard]] std::size_t part_count() const { return parts_; }

  /// The items of each leaf, in the order of the leaves along the planes.
  [[nodiscard]] std::vector<ItemStore<CutItem>> parts(const ItemStore<CutItem>& items, const StoreSpace& space) {
    std::vector<ItemStore<CutItem>> parts;
    number_leaves(nodes_[0], parts, space);
    for_each_item(items, [&](const CutItem& item) { parts[leaf_of(item).part].append(item); });
    return parts;
  }

 private:
  struct Node {
    std::unique_ptr<PlaneSearch> search;  ///< of the plane of this node, while it goes on
    CutPlane plane;
    std::size_t children = 0;  ///< the first of two nodes; 0: this is a leaf
    std::size_t part = 0;      ///< index of a leaf
  };

  void add(CutPart part, double share) {
    Node& node = nodes_.emplace_back();
    const std::size_t items = part.extent.count();
    if (items <= limits_.max_in_memory || part.extent.weight() <= limits_.max_weight) return;
    if (parts_ == std::min(max_parts, limits_.max_in_memory / min_items_of_round)) return;
    node.search = std::make_unique<PlaneSearch>(std::move(part), axes_, before_plane(items, share));
    ++searches_;
    ++parts_;
  }

  void search(const ItemStore<CutItem>& items) {
    for (const Node& node : nodes_)
      if (node.search) node.search->begin_round(limits_.max_in_memory / searches_);
    for_each_item(items, [&](const CutItem& item) {
      if (const Node& leaf = leaf_of(item); leaf.search) leaf.search->add(item);
    });
    for (std::size_t k = 0, end = nodes_.size(); k < end; ++k) {
      if (!nodes_[k].search) continue;
      const std::optional<CutPlane> plane = nodes_[k].search->end_round();
      if (!plane) continue;
      const std::unique_ptr<PlaneSearch> search = std::move(nodes_[k].search);
      --searches_;
      nodes_[k].plane = *plane;
      nodes_[k].children = nodes_.size();
      auto [before, behind] = search->halves(*plane);
      add(std::move(before), 0.5);
      add(std::move(behind), 0.5);
    }
  }

  [[nodiscard]] const Node& leaf_of(const CutItem& item) const {
    std::size_t k = 0;
    while (nodes_[k].children != 0) k = nodes_[k].children + (nodes_[k].plane.has_behind(item) ? 1 : 0);
    return nodes_[k];
  }

  void number_leaves(Node& node, std::vector<ItemStore<CutItem>>& parts, const StoreSpace& space) {
    if (node.children == 0) {
      node.part = parts.size();
      parts.emplace_back(space);
    } else {
      for (std::size_t k : {node.children, node.children + 1}) number_leaves(nodes_[k], parts, space);
    }
  }

  /// Each part that is written has a buffer of 256 KiB and a file.
  static constexpr std::size_t max_parts = 64;
  /// Room for the items that the search for a plane keeps.
  static constexpr std::size_t min_items_of_round = 64;

  const CutAxes& axes_;
  CutLimits limits_;
  std::vector<Node> nodes_;
  std::size_t searches_ = 0;  ///< that go on
  std::size_t parts_ = 1;     ///< leaves when all searches have ended
};

class TileCutter {
 public:
  TileCutter(const TileCut& cut, const CutLimits& limits, const UseTile& use, const StoreSpace& space)
      : axes_(axes_of(cut)), limits_(limits), use_(use), space_(space) {}

  void cut(std::span<CutItem> items, double share) const {
    if (items.empty()) return;
    CutExtent extent(axes_);
    for (const CutItem& item : items) extent.add(item);
    if (items.size() == 1 || extent.weight() <= limits_.max_weight) return use_all(items);
    const Vec3& axis = extent.longest_axis();
    const std::size_t before = before_plane(items.size(), share);
    std::nth_element(
        items.begin(), items.begin() + static_cast<std::ptrdiff_t>(before), items.end(),
        [&](const CutItem& item, const CutItem& other) { return key_of(item, axis) < key_of(other, axis); });
    cut(items.first(before), 0.5);
    cut(items.subspan(before), 0.5);
  }
  void cut(ItemStore<CutItem> items, double share) const {
    if (items.size() <= limits_.max_in_memory) {
      std::vector<CutItem> all(items.size());
      items.read(0, all);
      return cut(std::span(all), share);
    }
    CutTree tree(items, axes_, share, limits_);
    if (tree.part_count() == 1) return use_all(items);
    std::vector<ItemStore<CutItem>> parts = tree.parts(items, space_);
    items = ItemStore<CutItem>(StoreSpace());  // gives the room back
    for (ItemStore<CutItem>& part : parts) cut(std::move(part), 0.5);
  }

 private:
  template <class Items>
  void use_all(const Items& items) const {
    std::vector<std::uint32_t> numbers;
    numbers.reserve(items.size());
    for_each_item(items, [&](const CutItem& item) { numbers.push_back(item.number); });
    std::sort(numbers.begin(), numbers.end());
    use_(numbers);
  }

  const CutAxes& axes_;
  CutLimits limits_;
  const UseTile& use_;
  const StoreSpace& space_;
};

}  // namespace

void cut_into_tiles(std::vector<CutItem> items, std::uint64_t max_weight, const TileCut& cut, const UseTile& use) {
  TileCutter(cut, {max_weight, items.size()}, use, {}).cut(std::span(items), cut.first_share);
}

void cut_into_tiles(ItemStore<CutItem> items, std::uint64_t max_weight, const TileCut& cut, const StoreSpace& space,
                    const UseTile& use, std::size_t max_in_memory) {
  TileCutter(cut, {max_weight, max_in_memory}, use, space).cut(std::move(items), cut.first_share);
}

}  // namespace meshbound
