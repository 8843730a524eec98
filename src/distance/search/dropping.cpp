// SPDX-License-Identifier: MIT
/// Triangles of A that need no arithmetic: those that B has too, and those that an earlier search has proven.
#include <algorithm>
#include <bitset>
#include <cstdint>

#include "distance/search/steps.h"
#include "distance/shortcuts/identical.h"
#include "geometry/position_table.h"

namespace meshbound {
namespace {

constexpr std::uint32_t max_samples = 64;

/// A number that triangles with the same corners, in any order, share.
std::uint64_t corner_hash(const Bvh::Data& data, const Triangle& t) {
  std::uint64_t sum = 0;
  for (const std::uint32_t v : t) sum += position_hash(position_key(data.vertices[v]));
  return sum;
}

/// Tells that a small mesh lacks a triangle for less than a query takes. Larger meshes may have any triangle: reading
/// all of them would cost more than the samples do.
class TriangleFilter {
 public:
  explicit TriangleFilter(const Bvh::Data& data) : is_on_(data.triangle_count() <= max_triangles) {
    if (!is_on_) return;
    for (const Triangle& t : data.corners) bits_.set(corner_hash(data, t) % bit_count);
  }
  /// Whether the mesh may have a triangle `t` of `other`.
  [[nodiscard]] bool may_have(const Bvh::Data& other, const Triangle& t) const {
    return !is_on_ || bits_[corner_hash(other, t) % bit_count];
  }

 private:
  static constexpr std::size_t max_triangles = 256, bit_count = 2048;
  bool is_on_;
  std::bitset<bit_count> bits_;
};

/// Whether B has one of a few triangles of A: comparing all costs as much as bounding them.
bool sample_is_identical(OneSidedSearch& search) {
  const Bvh::Data &a = search.a(), &b = search.b();
  const std::uint32_t n = a.triangle_count(), samples = std::min(max_samples, n);
  const TriangleFilter filter(b);
  SearchKernel& kernel = search.begin_own_batch();
  std::uint32_t hint = 0;
  for (std::uint32_t i = 0; i < samples; ++i) {
    const auto slot = static_cast<std::uint32_t>(std::uint64_t{i} * n / samples);
    if (!filter.may_have(a, a.corners[slot])) continue;
    hint = kernel.nearest(centroid(search.triangle(slot)), hint, 0).slot;
    if (same_triangle(a, a.corners[slot], b, b.corners[hint])) return true;
  }
  return false;
}

}  // namespace

Remaining drop_identical(OneSidedSearch& search, bool touches_b) {
  Remaining remaining(search.a().triangle_count());
  const bool exact =
      search.map().is_identity && search.map().error == 0 && search.a().frame.error == 0 && search.b().frame.error == 0;
  if (exact && touches_b && sample_is_identical(search))
    search.stats().matched = drop_identical_triangles(search.a(), search.b(), remaining.flags());
  return remaining;
}

Remaining drop_proven(OneSidedSearch& search, Remaining remaining) {
  const OneSidedTask& task = search.task();
  if (!search.recorder().is_on() || search.decided()) return remaining;
  const double lower = search.b().frame.length_down(std::max(0.0, search.lower().lower));
  double target = task.decide_only ? task.tolerance : lower + task.error_bound;
  if (lower <= task.tolerance) target = std::min(target, task.tolerance);
  std::vector<std::uint8_t>& alive = remaining.flags();
  for (std::uint32_t slot = 0; slot < alive.size(); ++slot) {
    const double bound = task.memory->proofs[slot].bound;
    if (alive[slot] == 0 || bound > target) continue;
    alive[slot] = 0;
    search.offer_known_upper(bound);
    ++search.stats().proven_before;
  }
  return remaining;
}

}  // namespace meshbound
