// SPDX-License-Identifier: MIT
#include "tiles/tile_borders.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "numeric/no_index.h"

namespace meshbound {
namespace {

/// Most vertices have moved after two rounds; with 20 of them results have as many faces.
constexpr int max_rounds = 6;

/// The vertices of each tile and what they weigh.
struct Tile {
  std::uint64_t weight = 0;
  std::size_t vertices = 0;
};

std::vector<Tile> tiles_of(std::span<const std::uint32_t> weights, const std::vector<std::uint32_t>& owner) {
  std::vector<Tile> tiles;
  for (std::size_t v = 0; v < owner.size(); ++v) {
    if (owner[v] == no_index) continue;
    if (owner[v] >= tiles.size()) tiles.resize(std::size_t{owner[v]} + 1);
    tiles[owner[v]].weight += weights[v];
    ++tiles[owner[v]].vertices;
  }
  return tiles;
}

/// Pairs of a vertex and one of its neighbours, both with a tile, sorted: for each vertex of a triangle of several
/// tiles. Neighbours with two common triangles come twice.
std::vector<std::pair<std::uint32_t, std::uint32_t>> neighbours_at_borders(std::span<const Triangle> triangles,
                                                                           const std::vector<std::uint32_t>& owner) {
  std::vector<bool> is_at_border(owner.size());
  const auto for_each_owned_pair = [&](const auto& use) {
    for (const Triangle& corners : triangles)
      for (const std::uint32_t v : corners)
        for (const std::uint32_t w : corners)
          if (v != w && owner[v] != no_index && owner[w] != no_index) use(v, w);
  };
  for_each_owned_pair([&](std::uint32_t v, std::uint32_t w) {
    if (owner[v] != owner[w]) is_at_border[v] = true;
  });
  std::vector<std::pair<std::uint32_t, std::uint32_t>> neighbours;
  for_each_owned_pair([&](std::uint32_t v, std::uint32_t w) {
    if (is_at_border[v]) neighbours.emplace_back(v, w);
  });
  std::sort(neighbours.begin(), neighbours.end());
  return neighbours;
}

/// The tile that comes most often, the first one of several; `present` if no other comes more often. Sorts.
std::uint32_t most_frequent(std::vector<std::uint32_t>& tiles, std::uint32_t present) {
  std::sort(tiles.begin(), tiles.end());
  std::uint32_t best = present;
  auto count = std::count(tiles.begin(), tiles.end(), present);
  for (auto first = tiles.begin(); first != tiles.end();) {
    const auto end = std::upper_bound(first, tiles.end(), *first);
    if (end - first > count) best = *first, count = end - first;
    first = end;
  }
  return best;
}

}  // namespace

void smooth_tile_borders(std::span<const Triangle> triangles, std::span<const std::uint32_t> weights,
                         std::uint64_t max_weight, std::vector<std::uint32_t>& owner) {
  std::vector<Tile> tiles = tiles_of(weights, owner);
  std::vector<std::uint32_t> around;  // tiles of the neighbours of one vertex
  bool moved = true;
  for (int round = 0; round < max_rounds && moved; ++round) {
    moved = false;
    const auto neighbours = neighbours_at_borders(triangles, owner);
    for (std::size_t i = 0; i < neighbours.size();) {
      const std::uint32_t v = neighbours[i].first;
      around.clear();
      for (; i < neighbours.size() && neighbours[i].first == v; ++i) around.push_back(owner[neighbours[i].second]);
      const std::uint32_t to = most_frequent(around, owner[v]);
      Tile &from = tiles[owner[v]], &into = tiles[to];
      if (to == owner[v] || from.vertices == 1 || into.weight + weights[v] > max_weight) continue;
      from.weight -= weights[v], --from.vertices;
      into.weight += weights[v], ++into.vertices;
      owner[v] = to;
      moved = true;
    }
  }
}

}  // namespace meshbound
