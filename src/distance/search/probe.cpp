// SPDX-License-Identifier: MIT
/// A first lower bound, from a few points.
#include <algorithm>
#include <array>

#include "distance/search/steps.h"
#include "numeric/tasks.h"

namespace meshbound {
namespace {

constexpr std::uint32_t max_vertices = 64, centroids = 16;
constexpr std::uint32_t probes_per_chunk = 16;
constexpr std::uint32_t min_triangles = 128;  ///< below it the centroids' queries cost more than their bound saves

/// Offers the furthest point of the earlier search, which often is the furthest one still, and returns whether it lies
/// on B. The point is constructed with less than 21 u M of rounding; a lower bound uses 32 of the 128 u M in the slack,
/// so that is allowed for.
bool probe_start(OneSidedSearch& search) {
  const SearchMemory* memory = search.task().memory;
  if (memory == nullptr || !memory->start) return false;
  const StartPoint& start = *memory->start;
  const auto [a, b, c] = search.triangle(start.slot);
  const Vec3 p = a + start.v * (b - a) + start.w * (c - a);
  const std::uint32_t hint = memory->hints[search.a().corners[start.slot][0]];
  SearchKernel& kernel = search.begin_own_batch();
  const Nearest nearest = kernel.nearest(p, hint != no_slot ? hint : 0, 0);
  kernel.offer(p, nearest, start.slot);
  search.offer_lower(kernel.lower());
  return nearest.squared <= search.goal().slack * search.goal().slack;
}

/// The vertices of a mesh that was simplified lie on the original, its triangles do not.
void probe_centroids(OneSidedSearch& search) {
  const std::uint32_t n = search.a().triangle_count();
  if (n < min_triangles) return;
  SearchKernel& kernel = search.begin_own_batch();
  std::uint32_t hint = 0;
  for (std::uint32_t i = 0; i < centroids; ++i) {
    const auto slot = static_cast<std::uint32_t>(std::uint64_t{i} * n / centroids);
    const Vec3 p = centroid(search.triangle(slot));
    const Nearest nearest = kernel.nearest(p, hint, 0);
    hint = nearest.slot;
    kernel.offer(p, nearest, slot);
  }
  search.offer_lower(kernel.lower());
}

}  // namespace

bool probe(OneSidedSearch& search) {
  const bool start_touches_b = probe_start(search);
  if (search.decided()) return start_touches_b;
  if (const SearchMemory* memory = search.task().memory; memory != nullptr && memory->rigid) {
    // The furthest point has come nearer by no more than the models have moved: other points could gain no more.
    if (is_coherent(memory->front, search)) return start_touches_b;
    search.forget_hints();
  }
  const std::size_t n = search.a().vertices.size(), count = std::min<std::size_t>(max_vertices, n);
  const auto probed = [&](std::size_t i) { return static_cast<std::uint32_t>(i * n / count); };
  std::array<Nearest, max_vertices> nearest;
  for_each_range(count, probes_per_chunk, [&](std::size_t begin, std::size_t end) {
    std::uint32_t hint = 0;
    for (std::size_t i = begin; i < end; ++i) {
      nearest[i] = search.own_kernel().nearest(search.vertex(probed(i)), hint, 0);
      hint = nearest[i].slot;
    }
  });
  std::size_t farthest = 0;
  bool touches_b = false;
  for (std::size_t i = 0; i < count; ++i) {
    touches_b = touches_b || nearest[i].squared <= search.goal().slack * search.goal().slack;
    if (nearest[i].squared > nearest[farthest].squared) farthest = i;
  }
  search.offer_vertex(probed(farthest), nearest[farthest]);
  probe_centroids(search);
  return touches_b;
}

}  // namespace meshbound
