// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <vector>

#include "numeric/no_index.h"
#include "simplify/mesh/array_mesh.h"

namespace meshbound {

/// Edges by cost, the cheapest first, edges of equal cost by number: a heap that knows the index of each edge in it.
class EdgeQueue {
 public:
  /// `index` has the index of each edge that is in a queue and `no_index` for the others. Queues of different edges may
  /// share it. It must outlive this.
  explicit EdgeQueue(std::vector<std::uint32_t>& index) : index_(index) {}

  [[nodiscard]] bool empty() const { return heap_.empty(); }
  [[nodiscard]] bool contains(Corner edge) const { return index_[edge] != no_index; }
  void put(Corner edge, float cost) {
    if (index_[edge] == no_index) {
      index_[edge] = static_cast<std::uint32_t>(heap_.size());
      heap_.push_back({cost, edge});
      rise(index_[edge]);
      return;
    }
    const std::uint32_t at = index_[edge];
    heap_[at].cost = cost;
    rise(at);
    sink(index_[edge]);
  }
  void erase(Corner edge) {
    const std::uint32_t at = index_[edge];
    if (at == no_index) return;
    index_[edge] = no_index;
    const Entry last = heap_.back();
    heap_.pop_back();
    if (at == heap_.size()) return;
    set(at, last);
    rise(at);
    sink(index_[last.edge]);
  }
  Corner pop() {
    const Corner edge = heap_.front().edge;
    erase(edge);
    return edge;
  }
  void clear() {
    for (const Entry& entry : heap_) index_[entry.edge] = no_index;
    heap_.clear();
  }

 private:
  static constexpr std::uint32_t children = 4;
  struct Entry {
    float cost;
    Corner edge;
    [[nodiscard]] bool before(const Entry& other) const {
      return cost < other.cost || (cost == other.cost && edge < other.edge);
    }
  };
  void set(std::uint32_t at, const Entry& entry) {
    heap_[at] = entry;
    index_[entry.edge] = at;
  }
  void rise(std::uint32_t at) {
    const Entry entry = heap_[at];
    while (at > 0) {
      const std::uint32_t parent = (at - 1) / children;
      if (!entry.before(heap_[parent])) break;
      set(at, heap_[parent]);
      at = parent;
    }
    set(at, entry);
  }
  void sink(std::uint32_t at) {
    const Entry entry = heap_[at];
    for (;;) {
      const std::size_t first = std::size_t{children} * at + 1;
      if (first >= heap_.size()) break;
      std::size_t best = first;
      for (std::size_t k = first + 1; k < first + children && k < heap_.size(); ++k)
        if (heap_[k].before(heap_[best])) best = k;
      if (!heap_[best].before(entry)) break;
      set(at, heap_[best]);
      at = static_cast<std::uint32_t>(best);
    }
    set(at, entry);
  }

  std::vector<Entry> heap_;
  std::vector<std::uint32_t>& index_;  ///< by edge
};

}  // namespace meshbound
