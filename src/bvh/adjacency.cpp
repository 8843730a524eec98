// SPDX-License-Identifier: MIT
#include <algorithm>
#include <utility>

#include "bvh/build.h"

namespace meshbound {
namespace {

struct HalfEdge {
  std::uint32_t far_vertex;  ///< the larger of the edge's two; the smaller one is the bucket
  std::uint32_t id;          ///< 4 slot + edge

  [[nodiscard]] std::uint32_t slot() const { return id / 4; }
  [[nodiscard]] std::uint32_t edge() const { return id % 4; }
};

bool runs_upward(const Triangle& corners, std::uint32_t edge) { return corners[edge] < corners[(edge + 1) % 3]; }

/// Where each vertex's bucket of half-edges begins.
std::vector<std::uint32_t> bucket_begins(const Bvh::Data& data, int threads) {
  std::vector<std::uint32_t> begin(data.vertices.size() + 1, 0);
#pragma omp parallel for num_threads(threads) schedule(static)
  for (std::uint32_t slot = 0; slot < data.triangle_count(); ++slot) {
    const Triangle& t = data.corners[slot];
    for (std::size_t k = 0; k < 3; ++k) {
      std::uint32_t& count = begin[std::min(t[k], t[(k + 1) % 3]) + 1];
#pragma omp atomic
      ++count;
    }
  }
  for (std::size_t v = 1; v < begin.size(); ++v) begin[v] += begin[v - 1];
  return begin;
}

void link(Bvh::Data& data, const HalfEdge& from, const HalfEdge& to) {
  Neighbour& neighbour = data.neighbours[from.slot()][from.edge()];
  neighbour.slot = to.slot() & 0x7fffffff;
  neighbour.flipped =
      runs_upward(data.corners[from.slot()], from.edge()) == runs_upward(data.corners[to.slot()], to.edge()) ? 1 : 0;
}

/// Links each half-edge of a bucket to the next one of the same edge, the last to the first: a pair on a manifold edge,
/// a ring where more triangles meet, nothing on a border.
void link_bucket(Bvh::Data& data, HalfEdge* begin, HalfEdge* end) {
  std::sort(begin, end, [](const HalfEdge& a, const HalfEdge& b) {
    return std::pair(a.far_vertex, a.id) < std::pair(b.far_vertex, b.id);
  });
  for (HalfEdge* run = begin; run != end;) {
    HalfEdge* after = run + 1;
    while (after != end && after->far_vertex == run->far_vertex) ++after;
    for (HalfEdge* h = run; after - run > 1 && h != after; ++h) link(data, *h, h + 1 == after ? *run : *(h + 1));
    run = after;
  }
}

}  // namespace

void build_adjacency(Bvh::Data& data, int threads) {
  data.neighbours.resize(data.corners.size());
  const std::vector<std::uint32_t> begin = bucket_begins(data, threads);
  std::vector<std::uint32_t> next = begin;
  std::vector<HalfEdge> half_edges(3 * data.corners.size());
#pragma omp parallel for num_threads(threads) schedule(static)
  for (std::uint32_t slot = 0; slot < data.triangle_count(); ++slot) {
    const Triangle& t = data.corners[slot];
    for (std::uint32_t k = 0; k < 3; ++k) {
      const auto [near, far] = std::minmax(t[k], t[(k + 1) % 3]);
      std::uint32_t at = 0;
#pragma omp atomic capture
      at = next[near]++;
      half_edges[at] = {far, 4 * slot + k};  // in any order: each bucket is sorted before it is linked
    }
  }
#pragma omp parallel for num_threads(threads) schedule(dynamic, 4096)
  for (std::size_t v = 0; v < data.vertices.size(); ++v)
    link_bucket(data, half_edges.data() + begin[v], half_edges.data() + begin[v + 1]);
}

}  // namespace meshbound
