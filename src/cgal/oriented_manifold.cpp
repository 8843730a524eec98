// SPDX-License-Identifier: GPL-3.0-or-later
#include "cgal/oriented_manifold.h"

#include <algorithm>
#include <cstdint>
#include <span>

namespace meshbound::cgal {
namespace {

/// A face as one of its corners sees it: the edge that leaves the corner goes to `next`, the one that enters it comes
/// from `previous`.
struct Wedge {
  std::uint32_t next, previous;
};

/// `wedges` are sorted by `next`, and no two have the same. A fan begins at an edge that no face precedes.
bool is_one_fan_or_ring(std::span<const Wedge> wedges) {
  const auto after = [&](const Wedge& wedge) {
    return std::lower_bound(wedges.begin(), wedges.end(), wedge.previous,
                            [](const Wedge& a, std::uint32_t next) { return a.next < next; });
  };
  std::vector<bool> has_before(wedges.size(), false);
  for (const Wedge& wedge : wedges) {
    const auto at = after(wedge);
    if (at == wedges.end() || at->next != wedge.previous) continue;
    if (has_before[static_cast<std::size_t>(at - wedges.begin())]) return false;
    has_before[static_cast<std::size_t>(at - wedges.begin())] = true;
  }
  const auto begin = std::find(has_before.begin(), has_before.end(), false);
  auto at = begin == has_before.end() ? wedges.begin() : wedges.begin() + (begin - has_before.begin());
  const auto start = at;
  for (std::size_t visited = 1;; ++visited) {
    const auto following = after(*at);
    const bool ends = following == wedges.end() || following->next != at->previous || following == start;
    if (ends) return visited == wedges.size();
    at = following;
  }
}

}  // namespace

bool is_oriented_manifold(const std::vector<std::array<std::size_t, 3>>& triangles, std::size_t vertices) {
  std::vector<std::uint32_t> first(vertices + 1, 0);
  for (const auto& corners : triangles) {
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) return false;
    for (const std::size_t v : corners) ++first[v + 1];
  }
  for (std::size_t v = 0; v < vertices; ++v) first[v + 1] += first[v];
  std::vector<Wedge> wedges(3 * triangles.size());
  std::vector<std::uint32_t> end(first.begin(), first.end() - 1);
  for (const auto& corners : triangles) {
    for (std::size_t k = 0; k < 3; ++k)
      wedges[end[corners[k]]++] = {static_cast<std::uint32_t>(corners[(k + 1) % 3]),
                                   static_cast<std::uint32_t>(corners[(k + 2) % 3])};
  }
  for (std::size_t v = 0; v < vertices; ++v) {
    const std::span<Wedge> around(wedges.data() + first[v], wedges.data() + first[v + 1]);
    if (around.empty()) continue;
    std::sort(around.begin(), around.end(), [](const Wedge& a, const Wedge& b) { return a.next < b.next; });
    const auto repeats = [](const Wedge& a, const Wedge& b) { return a.next == b.next; };
    if (std::adjacent_find(around.begin(), around.end(), repeats) != around.end()) return false;
    if (!is_one_fan_or_ring(around)) return false;
  }
  return true;
}

}  // namespace meshbound::cgal
