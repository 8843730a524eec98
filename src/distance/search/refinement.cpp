// SPDX-License-Identifier: MIT
/// What cheap bounds left over, cut into pieces.
#include <algorithm>

#include "distance/search/steps.h"

namespace meshbound {
namespace {

constexpr std::uint32_t walks_per_chunk = 8;  ///< walks differ much in cost
constexpr std::ptrdiff_t worst_first = 256;   ///< walks in the order of their bounds; a few of them set the lower bound

/// The worst first, to raise the lower bound early; the rest in the order of the curve, where neighbours share what is
/// in the cache.
void sort_open(std::vector<OpenTriangle>& open) {
  const auto worse = [](const OpenTriangle& x, const OpenTriangle& y) {
    return x.bound_squared != y.bound_squared ? x.bound_squared > y.bound_squared : x.slot < y.slot;
  };
  const auto middle = open.begin() + std::min<std::ptrdiff_t>(worst_first, std::ssize(open));
  std::partial_sort(open.begin(), middle, open.end(), worse);
  std::sort(middle, open.end(), [](const OpenTriangle& x, const OpenTriangle& y) { return x.slot < y.slot; });
}

void cover_and_record(const OneSidedSearch& search, SearchKernel& kernel, std::uint32_t slot, std::uint32_t start,
                      Found& found) {
  const auto [a, b, c] = search.triangle(slot);
  CoverRecord record = search.recorder().new_record();
  kernel.record_in(&record);
  kernel.cover(a, b, c, slot, start, search.cuts_left());
  kernel.record_in(nullptr);
  search.recorder().cover(slot, record, found.covers);
}

void refine_triangle(const OneSidedSearch& search, SearchKernel& kernel, const OpenTriangle& open, Found& found) {
  if (open.bound_squared <= kernel.accepted_squared() || search.exhausted() || search.goal().out_of_time())
    return kernel.accept(open.bound_squared);
  const TriangleCorners corners = search.triangle(open.slot);
  if (search.task().options.method == Method::CrossCulling)
    return kernel.subdivide(corners, open.slot, open.bound_squared, search.cuts_left());
  // The centroid breaks the ties of corners, which many triangles of B share.
  const Nearest start = kernel.nearest(centroid(corners), open.start, kernel.accepted_squared());
  if (search.recorder().is_on()) return cover_and_record(search, kernel, open.slot, start.slot, found);
  kernel.cover(corners[0], corners[1], corners[2], open.slot, start.slot, search.cuts_left());
}

}  // namespace

void refine(OneSidedSearch& search, std::vector<OpenTriangle> open) {
  if (search.decided()) return;
  sort_open(open);
  search.stats().walked += open.size();
  const OneSidedSearch::Batches batches{
      .per_chunk = walks_per_chunk, .first = 1, .max_chunks = 512, .from = 0.3, .to = 1};
  (void)search.run_chunks(static_cast<std::uint32_t>(open.size()), batches,
                          [&](SearchKernel& kernel, std::uint32_t begin, std::uint32_t end, Found& found) {
                            for (std::uint32_t i = begin; i < end; ++i) refine_triangle(search, kernel, open[i], found);
                          });
}

}  // namespace meshbound
