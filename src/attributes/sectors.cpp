// SPDX-License-Identifier: MIT
#include "attributes/sectors.h"

#include <algorithm>
#include <numeric>

#include "numeric/buckets.h"
#include "numeric/disjoint_sets.h"
#include "numeric/no_index.h"

namespace meshbound {
namespace {

std::uint32_t next(std::uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }

std::uint32_t vertex(const SimplifiedLevel& level, std::uint32_t corner) {
  return level.mesh.triangles[corner / 3][corner % 3];
}

Edge edge_at(const SimplifiedLevel& level, std::uint32_t corner) {
  return sorted({vertex(level, corner), vertex(level, next(corner))});
}

/// The corners where the edges of all triangles start, by the smaller vertex of the edge.
Buckets<std::uint32_t> corners_by_vertex(const SimplifiedLevel& level) {
  return {level.mesh.vertices.size(), [&](const auto& add) {
            for (std::uint32_t c = 0; c < 3 * level.mesh.triangles.size(); ++c) add(edge_at(level, c)[0], c);
          }};
}

}  // namespace

Sectors::Sectors(std::span<const std::uint32_t> name_of) : corners_(name_of.size()) {
  std::vector<std::uint32_t> sector_of(name_of.size(), no_index);  // by name
  std::vector<std::uint32_t> sector;                               // by corner
  sector.reserve(name_of.size());
  for (const std::uint32_t name : name_of) {
    if (sector_of[name] == no_index) {
      sector_of[name] = static_cast<std::uint32_t>(end_.size());
      end_.push_back(0);
    }
    sector.push_back(sector_of[name]);
    ++end_[sector.back()];
  }
  std::exclusive_scan(end_.begin(), end_.end(), end_.begin(), std::uint32_t{0});
  for (std::uint32_t c = 0; c < sector.size(); ++c) corners_[end_[sector[c]]++] = c;
}

SectorFinder::SectorFinder(const SimplifiedLevel& level) : level_(level) {
  std::vector<Edge> lines;
  for (const Edge& edge : level.lines) lines.push_back(sorted(edge));
  std::sort(lines.begin(), lines.end());
  const Buckets<std::uint32_t> by_vertex = corners_by_vertex(level);
  std::vector<std::array<std::uint32_t, 2>> to;  // of one vertex: the larger vertex of an edge, and the corner
  for (std::size_t v = 0; v < by_vertex.size(); ++v) {
    to.clear();
    for (const std::uint32_t corner : by_vertex[v]) to.push_back({edge_at(level, corner)[1], corner});
    std::sort(to.begin(), to.end());
    for (std::size_t i = 1, of_edge = 0; i < to.size(); ++i) {
      if (to[i][0] != to[of_edge][0])
        of_edge = i;
      else if (!std::binary_search(lines.begin(), lines.end(), Edge{static_cast<std::uint32_t>(v), to[i][0]}))
        across_.push_back({to[of_edge][1], to[i][1]});
    }
  }
}

Sectors SectorFinder::find(const MayJoin& may_join) const {
  const auto count = static_cast<std::uint32_t>(3 * level_.mesh.triangles.size());
  DisjointSets sets(count);
  for (const auto& [one, other] : across_)
    for (const std::uint32_t i : {other, next(other)})
      for (const std::uint32_t j : {one, next(one)})
        if (vertex(level_, i) == vertex(level_, j) && (!may_join || may_join(i, j))) sets.unite(i, j);
  std::vector<std::uint32_t> name_of;
  name_of.reserve(count);
  for (std::uint32_t c = 0; c < count; ++c) name_of.push_back(sets.find(c));
  return Sectors(name_of);
}

}  // namespace meshbound
