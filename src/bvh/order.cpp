// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "bvh/build.h"
#include "geometry/hilbert.h"

namespace meshbound {
namespace {

struct Keyed {
  std::uint64_t key;
  std::uint32_t triangle;
};

constexpr int digit_bits = 11;  ///< a histogram of 2^11 counters stays in the first-level cache
constexpr std::size_t digits = std::size_t{1} << digit_bits;

/// A surface of n triangles crosses about n of the 4^bits cells of a grid: two bits more tell neighbours apart.
int grid_bits(std::size_t triangles) {
  const int bits = static_cast<int>(std::bit_width(triangles)) / 2 + 3;
  return std::min(bits, 20);
}

/// Stable least-significant-digit radix sort over the lowest `bits` of the keys. Each thread counts and moves one run
/// of the items; where a run's items of a digit begin follows from the counts, so the result is the one order.
void sort_by_key(std::vector<Keyed>& items, int bits, int threads) {
  const auto runs = static_cast<std::size_t>(threads);
  std::vector<Keyed> scratch(items.size());
  std::vector<std::array<std::size_t, digits>> start(runs);
  const auto run_begin = [&](std::size_t run) { return items.size() * run / runs; };
  for (int shift = 0; shift < bits; shift += digit_bits) {
    const auto digit = [shift](const Keyed& item) { return item.key >> shift & (digits - 1); };
#pragma omp parallel for num_threads(threads) schedule(static)
    for (std::size_t run = 0; run < runs; ++run) {
      start[run].fill(0);
      for (std::size_t i = run_begin(run); i < run_begin(run + 1); ++i) ++start[run][digit(items[i])];
    }
    std::size_t sum = 0;
    for (std::size_t d = 0; d < digits; ++d)
      for (auto& counts : start) sum += std::exchange(counts[d], sum);
#pragma omp parallel for num_threads(threads) schedule(static)
    for (std::size_t run = 0; run < runs; ++run)
      for (std::size_t i = run_begin(run); i < run_begin(run + 1); ++i)
        scratch[start[run][digit(items[i])]++] = items[i];
    items.swap(scratch);
  }
}

}  // namespace

std::vector<std::uint32_t> hilbert_order(const MeshView& mesh, const std::vector<Vec3>& working, const Box& box,
                                         int threads) {
  const std::size_t n = mesh.triangle_count();
  const int bits = grid_bits(n);
  const Vec3 size = box.hi - box.lo;
  const double largest = std::max({size.x, size.y, size.z, 1e-300});
  const double cells = std::ldexp(1.0, bits) - 1, scale = cells / (3 * largest);
  std::vector<Keyed> items(n);
#pragma omp parallel for num_threads(threads) schedule(static)
  for (std::size_t i = 0; i < n; ++i) {
    Vec3 sum;
    for (const std::uint32_t v : mesh.triangle(i)) sum = sum + (working[v] - box.lo);
    const auto cell = [&](double x) { return static_cast<std::uint32_t>(std::clamp(x * scale, 0.0, cells)); };
    items[i] = {hilbert_index(cell(sum.x), cell(sum.y), cell(sum.z), bits), static_cast<std::uint32_t>(i)};
  }
  sort_by_key(items, 3 * bits, threads);
  std::vector<std::uint32_t> order(n);
  for (std::size_t i = 0; i < n; ++i) order[i] = items[i].triangle;
  return order;
}

}  // namespace meshbound
