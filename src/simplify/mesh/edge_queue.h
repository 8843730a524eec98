// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <vector>

#include "simplify/mesh/array_mesh.h"
#include "simplify/mesh/edge_notes.h"

namespace meshbound {

/// Edges by cost, the cheapest first, edges of equal cost by number: a heap that knows the index of each edge in it.
class EdgeQueue {
 public:
  /// `notes` keep the index of each edge that is in a queue. Queues of different edges may share them. They must
  /// outlive this.
  explicit EdgeQueue(EdgeNotes& notes) : notes_(notes) {}
  EdgeQueue(const EdgeQueue&) = delete;
  EdgeQueue& operator=(const EdgeQueue&) = delete;
  /// What is left becomes open, also where an exception ends the collapses: the notes are of use after it.
  ~EdgeQueue() {
    for (const Entry& entry : heap_) notes_.leave_queue(entry.edge);
  }

  [[nodiscard]] bool empty() const { return heap_.empty(); }
  void put(Corner edge, float cost) {
    if (!notes_.is_queued(edge)) {
      const auto last = static_cast<std::uint32_t>(heap_.size());
      heap_.push_back({cost, edge});
      rise(last);
      return;
    }
    const std::uint32_t at = notes_.index(edge);
    heap_[at].cost = cost;
    rise(at);
    sink(notes_.index(edge));
  }
  void erase(Corner edge) {
    if (!notes_.is_queued(edge)) return;
    const std::uint32_t at = notes_.index(edge);
    notes_.leave_queue(edge);
    const Entry last = heap_.back();
    heap_.pop_back();
    if (at == heap_.size()) return;
    set(at, last);
    rise(at);
    sink(notes_.index(last.edge));
  }
  Corner pop() {
    const Corner edge = heap_.front().edge;
    erase(edge);
    return edge;
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
    notes_.set_index(entry.edge, at);
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
  EdgeNotes& notes_;
};

}  // namespace meshbound
