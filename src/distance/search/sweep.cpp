// SPDX-License-Identifier: MIT
/// Triangles bounded by what bounded their neighbour along the curve of the tree, without queries.
#include "distance/search/steps.h"

namespace meshbound {
namespace {

constexpr std::uint32_t swept_per_chunk = 512;  ///< each chunk begins with a query

/// Triangles between two looks at the clock: each may take a tenth of a millisecond where thousands of triangles are
/// equally near.
constexpr std::uint32_t triangles_between_looks = 16;

void sweep_chunk(const OneSidedSearch& search, const Remaining& remaining, SearchKernel& kernel, std::uint32_t begin,
                 std::uint32_t end, Found& found) {
  // Tries that fail cost about as much as a query does, so they end where most of them fail.
  int worth_testing = 32, worth_walking = 16, queries = 4;
  std::uint32_t hint = no_slot;
  const ProofRecorder& recorder = search.recorder();
  CoverRecord record = recorder.new_record();
  kernel.record_in(recorder.is_on() ? &record : nullptr);
  for (std::uint32_t i = begin; i < end; ++i) {
    const std::uint32_t slot = remaining.slot(i);
    if (!remaining.holds(slot)) continue;
    if (i % triangles_between_looks == 0 && search.goal().out_of_time()) worth_testing = 0;
    if (worth_testing <= 0) {
      found.open.push_back({0, slot, no_slot});
      continue;
    }
    const TriangleCorners corners = search.triangle(slot);
    const auto ask = [&] {
      --queries;
      hint = kernel.nearest(centroid(corners), hint == no_slot ? 0 : hint, 0).slot;
    };
    if (hint == no_slot) ask();
    record.clear();
    const std::uint64_t cuts = worth_walking > 0 ? search.cuts_left() : 0;
    Swept swept = kernel.sweep(corners, hint, cuts);
    if (swept == Swept::NotNear && queries > 0) {
      ask();
      swept = kernel.sweep(corners, hint, cuts);
    }
    if (swept == Swept::ByOneTriangle || swept == Swept::ByWalk) {
      worth_testing += 2;
      if (swept == Swept::ByWalk) ++found.walks, ++worth_walking;
      recorder.cover(slot, record, found.covers);
      continue;
    }
    --worth_testing;
    if (swept == Swept::NotAtAll) worth_walking -= 2;
    found.open.push_back({0, slot, no_slot});
  }
  kernel.record_in(nullptr);
}

}  // namespace

Remaining sweep(OneSidedSearch& search, Remaining remaining) {
  if (search.decided() || search.exhausted() || remaining.is_list()) return remaining;
  const OneSidedSearch::Batches batches{
      .per_chunk = swept_per_chunk, .first = 256, .max_chunks = 256, .from = 0, .to = 0.1};
  const std::vector<OpenTriangle> open = search.run_chunks(
      remaining.size(), batches, [&](SearchKernel& kernel, std::uint32_t begin, std::uint32_t end, Found& found) {
        sweep_chunk(search, remaining, kernel, begin, end, found);
      });
  std::vector<std::uint32_t> left;
  left.reserve(open.size());
  for (const OpenTriangle& triangle : open) left.push_back(triangle.slot);
  return {search.a().triangle_count(), std::move(left)};
}

}  // namespace meshbound
