// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "bvh/build.h"
#include "geometry/hilbert.h"

namespace meshbound {
namespace {

/// A triangle's place along the curve above its index, so that one number is sorted and ties go by index.
using Keyed = std::uint64_t;

constexpr int digit_bits = 12;  ///< a histogram of 2^12 counters of 32 bits stays in the first-level cache
constexpr std::size_t digits = std::size_t{1} << digit_bits;

/// A surface of n triangles crosses about n of the 4^bits cells of a grid: two bits more tell neighbours apart. Key and
/// index share 64 bits, which takes one of them away above 4M triangles.
int grid_bits(std::size_t triangles, int index_bits) {
  const int bits = static_cast<int>(std::bit_width(triangles)) / 2 + 3;
  return std::min(bits, (64 - index_bits) / 3);
}

/// Stable least-significant-digit radix sort by the bits from `first` to below `end`. Each thread counts and moves one
/// run of the items; where a run's items of a digit begin follows from the counts, so the result is the one order.
void sort_by_key(Array<Keyed>& items, int first, int end, int threads) {
  const std::size_t runs = static_cast<std::size_t>(threads),
                    passes = static_cast<std::size_t>((end - first + digit_bits - 1) / digit_bits);
  Array<Keyed> scratch(items.size());
  std::vector<std::array<std::uint32_t, digits>> start(runs);
  const auto run_begin = [&](std::size_t run) { return items.size() * run / runs; };
  for (std::size_t pass = 0; pass < passes; ++pass) {
    const int from = first + (end - first) * static_cast<int>(pass) / static_cast<int>(passes);
    const int to = first + (end - first) * static_cast<int>(pass + 1) / static_cast<int>(passes);
    const Keyed mask = (Keyed{1} << (to - from)) - 1;
#pragma omp parallel for num_threads(threads) schedule(static)
    for (std::size_t run = 0; run < runs; ++run) {
      std::fill_n(start[run].begin(), mask + 1, 0);
      for (std::size_t i = run_begin(run); i < run_begin(run + 1); ++i) ++start[run][items[i] >> from & mask];
    }
    std::uint32_t sum = 0;
    for (std::size_t d = 0; d <= mask; ++d)
      for (auto& counts : start) sum += std::exchange(counts[d], sum);
#pragma omp parallel for num_threads(threads) schedule(static)
    for (std::size_t run = 0; run < runs; ++run)
      for (std::size_t i = run_begin(run); i < run_begin(run + 1); ++i)
        scratch[start[run][items[i] >> from & mask]++] = items[i];
    items.swap(scratch);
  }
}

}  // namespace

void hilbert_order(Bvh::Data& data, const MeshView& mesh, int threads) {
  const std::size_t n = mesh.triangle_count();
  const int index_bits = static_cast<int>(std::bit_width(n)), bits = grid_bits(n, index_bits);
  const Box box = data.working_box;
  const Vec3 size = box.hi - box.lo;
  const double largest = std::max({size.x, size.y, size.z, 1e-300});
  const double cells = std::ldexp(1.0, bits) - 1, scale = cells / (3 * largest);
  const FrameMap to_working(data.frame);
  Array<Keyed> items(n);
#pragma omp parallel for num_threads(threads) schedule(static)
  for (std::size_t i = 0; i < n; ++i) {
    Vec3 sum;
    for (const std::uint32_t v : mesh.triangle(i)) {
      const Eigen::Vector3d p = mesh.vertex(v);
      sum = sum + (to_working({p.x(), p.y(), p.z()}) - box.lo);
    }
    const auto cell = [&](double x) { return static_cast<std::uint32_t>(std::clamp(x * scale, 0.0, cells)); };
    items[i] = hilbert_index(cell(sum.x), cell(sum.y), cell(sum.z), bits) << index_bits | i;
  }
  sort_by_key(items, index_bits, index_bits + 3 * bits, threads);
  data.triangle_of_slot.resize(n);
  const Keyed index_mask = (Keyed{1} << index_bits) - 1;
#pragma omp parallel for num_threads(threads) schedule(static)
  for (std::size_t i = 0; i < n; ++i) data.triangle_of_slot[i] = static_cast<std::uint32_t>(items[i] & index_mask);
}

}  // namespace meshbound
