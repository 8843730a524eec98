// SPDX-License-Identifier: MIT
#include "attributes/sectors.h"

#include <algorithm>
#include <map>

#include "numeric/disjoint_sets.h"
#include "numeric/no_index.h"

namespace meshbound {
namespace {

std::uint32_t next(std::uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }

}  // namespace

std::vector<std::vector<std::uint32_t>> sectors(const SimplifiedLevel& level, const MayJoin& may_join) {
  const std::vector<Triangle>& triangles = level.mesh.triangles;
  const auto vertex = [&](std::uint32_t corner) { return triangles[corner / 3][corner % 3]; };
  const auto count = static_cast<std::uint32_t>(3 * triangles.size());
  std::vector<Edge> lines;
  for (const Edge& edge : level.lines) lines.push_back(sorted(edge));
  std::sort(lines.begin(), lines.end());

  DisjointSets sets(count);
  std::map<Edge, std::uint32_t> open;  // edges seen once, with the corner where they start
  for (std::uint32_t c = 0; c < count; ++c) {
    const Edge edge = sorted({vertex(c), vertex(next(c))});
    if (std::binary_search(lines.begin(), lines.end(), edge)) continue;
    const auto [at, is_new] = open.emplace(edge, c);
    if (is_new) continue;
    for (const std::uint32_t i : {c, next(c)})
      for (const std::uint32_t j : {at->second, next(at->second)})
        if (vertex(i) == vertex(j) && (!may_join || may_join(i, j))) sets.unite(i, j);
  }

  std::vector<std::vector<std::uint32_t>> result;
  std::vector<std::uint32_t> sector_of(count, no_index);  // by name of its set
  for (std::uint32_t c = 0; c < count; ++c) {
    std::uint32_t& sector = sector_of[sets.find(c)];
    if (sector == no_index) {
      sector = static_cast<std::uint32_t>(result.size());
      result.emplace_back();
    }
    result[sector].push_back(c);
  }
  return result;
}

}  // namespace meshbound
