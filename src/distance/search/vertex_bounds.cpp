// SPDX-License-Identifier: MIT
/// Triangles bounded by a closest triangle of one of their vertices. Paper, Lemma 2, Eq. 5.
#include <limits>

#include "distance/search/steps.h"
#include "numeric/sort_unique.h"

namespace meshbound {
namespace {

constexpr std::uint32_t vertices_per_chunk = 256;   ///< hints are handed on inside a chunk, so not too few
constexpr std::uint32_t triangles_per_chunk = 256;  ///< cheap bounds

/// Queries between two looks at the clock: each may take a tenth of a millisecond where thousands of triangles are
/// equally near.
constexpr std::uint32_t queries_between_looks = 16;

/// The vertices of listed triangles, ascending. Their number decides the cost where whole nodes were culled: there
/// flags would touch all vertices for nothing.
std::vector<std::uint32_t> vertices_of(const Bvh::Data& a, const Remaining& remaining) {
  std::vector<std::uint32_t> vertices;
  if (remaining.size() > a.vertices.size() / 16) {
    std::vector<std::uint8_t> wanted(a.vertices.size(), 0);
    for (std::uint32_t i = 0; i < remaining.size(); ++i)
      for (const std::uint32_t v : a.corners[remaining.slot(i)]) wanted[v] = 1;
    for (std::uint32_t v = 0; v < wanted.size(); ++v)
      if (wanted[v] != 0) vertices.push_back(v);
    return vertices;
  }
  vertices.reserve(3 * std::size_t{remaining.size()});
  for (std::uint32_t i = 0; i < remaining.size(); ++i) {
    const Triangle& t = a.corners[remaining.slot(i)];
    vertices.insert(vertices.end(), t.begin(), t.end());
  }
  sort_unique(vertices);
  return vertices;
}

void query_chunk(const OneSidedSearch& search, const VertexDistances& vertices, SearchKernel& kernel,
                 std::uint32_t begin, std::uint32_t end, Found& found) {
  std::uint32_t hint = 0;
  bool hurried = search.exhausted();
  for (std::uint32_t i = begin; i < end; ++i) {
    const std::uint32_t v = vertices.asked_all ? i : vertices.asked[i];
    if (i % queries_between_looks == 0) hurried = hurried || search.goal().out_of_time();
    if (const std::uint32_t before = search.hint_before(v); before != no_slot) hint = before;
    const double enough = hurried ? std::numeric_limits<double>::infinity() : kernel.accepted_squared();
    const Nearest nearest = kernel.nearest(search.vertex(v), hint, enough);
    vertices.nearest[v] = {nearest.squared, nearest.slot};
    hint = nearest.slot;
    if (!hurried && nearest.squared > found.farthest.squared) {
      found.farthest = nearest;
      found.farthest_vertex = v;
    }
  }
}

void bound_chunk(const OneSidedSearch& search, const Remaining& remaining, const VertexDistances& vertices,
                 SearchKernel& kernel, std::uint32_t begin, std::uint32_t end, Found& found) {
  const auto& nearest = vertices.nearest;
  for (std::uint32_t i = begin; i < end; ++i) {
    const std::uint32_t slot = remaining.slot(i);
    const Triangle& t = search.a().corners[slot];
    const TriangleCorners corner = search.triangle(slot);
    double bound = std::numeric_limits<double>::infinity();
    int worst = 0;
    std::uint32_t nearest_to_all = 0;
    for (int k = 0; k < 3 && bound > kernel.accepted_squared(); ++k) {
      if (nearest[t[k]].squared > nearest[t[worst]].squared) worst = k;
      const std::uint32_t candidate = nearest[t[k]].slot;
      if (k > 0 && (candidate == nearest[t[0]].slot || (k == 2 && candidate == nearest[t[1]].slot))) continue;
      const double squared = kernel.farthest_squared(corner[0], corner[1], corner[2], candidate);
      if (squared < bound) {
        bound = squared;
        nearest_to_all = candidate;
      }
    }
    search.recorder().triangle(slot, bound, nearest_to_all);
    if (bound <= kernel.accepted_squared() || search.exhausted())
      kernel.accept(bound);
    else
      found.open.push_back({bound, slot, nearest[t[worst]].slot});
  }
}

}  // namespace

VertexDistances query_vertices(OneSidedSearch& search, const Remaining& remaining) {
  VertexDistances vertices;
  if (search.decided()) return vertices;
  const auto all = static_cast<std::uint32_t>(search.a().vertices.size());
  vertices.asked_all = remaining.is_whole();
  if (!vertices.asked_all) vertices.asked = vertices_of(search.a(), remaining);
  vertices.nearest = std::make_unique_for_overwrite<VertexDistances::Entry[]>(all);
  const auto count = vertices.asked_all ? all : static_cast<std::uint32_t>(vertices.asked.size());
  const OneSidedSearch::Batches batches{
      .per_chunk = vertices_per_chunk, .first = 4, .max_chunks = 256, .from = 0, .to = 0.2};
  (void)search.run_chunks(count, batches,
                          [&](SearchKernel& kernel, std::uint32_t begin, std::uint32_t end, Found& found) {
                            query_chunk(search, vertices, kernel, begin, end, found);
                          });
  return vertices;
}

std::vector<OpenTriangle> bound_triangles(OneSidedSearch& search, const Remaining& remaining,
                                          const VertexDistances& vertices) {
  if (search.decided()) return {};
  const OneSidedSearch::Batches batches{
      .per_chunk = triangles_per_chunk, .first = 256, .max_chunks = 256, .from = 0.2, .to = 0.3};
  return search.run_chunks(remaining.size(), batches,
                           [&](SearchKernel& kernel, std::uint32_t begin, std::uint32_t end, Found& found) {
                             bound_chunk(search, remaining, vertices, kernel, begin, end, found);
                           });
}

void remember_hints(OneSidedSearch& search, const VertexDistances& vertices) {
  SearchMemory* memory = search.task().memory;
  if (memory == nullptr || vertices.nearest == nullptr || search.decided()) return;
  const std::size_t count = vertices.asked_all ? search.a().vertices.size() : vertices.asked.size();
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t v = vertices.asked_all ? i : vertices.asked[i];
    memory->hints[v] = vertices.nearest[v].slot;
  }
}

}  // namespace meshbound
