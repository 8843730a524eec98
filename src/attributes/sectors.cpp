// SPDX-License-Identifier: MIT
#include "attributes/sectors.h"

#include <algorithm>
#include <utility>

#include "numeric/disjoint_sets.h"
#include "numeric/no_index.h"

namespace meshbound {
namespace {

std::uint32_t next(std::uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }

std::uint32_t vertex(const SimplifiedLevel& level, std::uint32_t corner) {
  return level.mesh.triangles[corner / 3][corner % 3];
}

/// An edge, and a corner where it starts.
using EdgeOfCorner = std::pair<Edge, std::uint32_t>;

/// The edges of all triangles that are no lines; those of one edge follow one another, by corner.
std::vector<EdgeOfCorner> edges_between_lines(const SimplifiedLevel& level) {
  std::vector<Edge> lines;
  for (const Edge& edge : level.lines) lines.push_back(sorted(edge));
  std::sort(lines.begin(), lines.end());
  std::vector<EdgeOfCorner> edges;
  edges.reserve(3 * level.mesh.triangles.size());
  for (std::uint32_t c = 0; c < 3 * level.mesh.triangles.size(); ++c) {
    const Edge edge = sorted({vertex(level, c), vertex(level, next(c))});
    if (!std::binary_search(lines.begin(), lines.end(), edge)) edges.emplace_back(edge, c);
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

}  // namespace

std::vector<std::vector<std::uint32_t>> sectors(const SimplifiedLevel& level, const MayJoin& may_join) {
  const auto count = static_cast<std::uint32_t>(3 * level.mesh.triangles.size());
  DisjointSets sets(count);
  const std::vector<EdgeOfCorner> edges = edges_between_lines(level);
  std::size_t first = 0;  // the first one of the same edge
  for (std::size_t e = 1; e < edges.size(); ++e) {
    if (edges[e].first != edges[first].first) {
      first = e;
      continue;
    }
    const std::uint32_t one = edges[first].second, other = edges[e].second;
    for (const std::uint32_t i : {other, next(other)})
      for (const std::uint32_t j : {one, next(one)})
        if (vertex(level, i) == vertex(level, j) && (!may_join || may_join(i, j))) sets.unite(i, j);
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
