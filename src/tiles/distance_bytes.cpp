// SPDX-License-Identifier: MIT
#include "tiles/compact_bytes.h"
#include "tiles/tile_bytes.h"

namespace meshbound {
namespace {

/// Calls use(member) for each integer that the statistics count.
template <class Stats, class Use>
void for_each_count(Stats& stats, const Use& use) {
  for (auto* count :
       {&stats.triangles, &stats.matched, &stats.proven_before, &stats.culled_by_node, &stats.culled_by_vertices,
        &stats.walked, &stats.closest_point_queries, &stats.nodes_visited, &stats.triangles_tested, &stats.subdivisions,
        &stats.pieces, &stats.resolved, &stats.enclosed, &stats.given_up})
    use(*count);
}

/// Calls use(member) for each number of a distance that is no integer.
template <class Distance, class Use>
void for_each_double(Distance& distance, const Use& use) {
  auto& stats = distance.stats;
  for (auto* value : {&distance.bounds.lower, &distance.bounds.upper, &distance.witness.distance,
                      &stats.culled_on_a_percent, &stats.culled_on_b_percent, &stats.seconds, &stats.phases.matching,
                      &stats.phases.culling_on_a, &stats.phases.culling_on_b, &stats.phases.subdivision})
    use(*value);
  for (auto* point : {&distance.witness.from, &distance.witness.nearest})
    for (int k = 0; k < 3; ++k) use(point->position[k]);
}

}  // namespace

std::string packed_distance(const OneSidedDistance& distance) {
  CompactWriter to;
  to.number(static_cast<std::uint64_t>(distance.outcome));
  to.number(distance.witness.from.triangle);
  to.number(distance.witness.nearest.triangle);
  to.number(distance.stats.deepest_subdivision);
  for_each_count(distance.stats, [&](std::uint64_t count) { to.number(count); });
  for_each_double(distance, [&](double value) { to.raw(value); });
  return to.take();
}

OneSidedDistance unpacked_distance(std::string_view bytes) {
  CompactReader from(bytes);
  OneSidedDistance distance;
  distance.outcome = static_cast<Outcome>(from.count(static_cast<std::size_t>(Outcome::PrecisionReached)));
  distance.witness.from.triangle = static_cast<std::uint32_t>(from.number());
  distance.witness.nearest.triangle = static_cast<std::uint32_t>(from.number());
  distance.stats.deepest_subdivision = static_cast<std::uint32_t>(from.number());
  for_each_count(distance.stats, [&](std::uint64_t& count) { count = from.number(); });
  for_each_double(distance, [&](double& value) { from.raw(value); });
  if (!from.at_end()) CompactReader::fail();
  return distance;
}

}  // namespace meshbound
