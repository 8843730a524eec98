// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>

#include "bvh/build.h"
#include "bvh/build_kernels.h"
#include "numeric/tasks.h"

namespace meshbound {
namespace {

/// A triangle's index along the curve in the high bits and its index in the mesh in the low ones, so that one number is
/// sorted and ties go by index.
using Keyed = std::uint64_t;

/// The cache lines at the ends of 2^11 buckets take 128 KB: four passes over 2M triangles by such digits take 8 ns a
/// triangle, three by digits of 13 bits 13 ns.
constexpr int digit_bits = 11;
constexpr std::size_t digits = std::size_t{1} << digit_bits;

/// A surface of n triangles crosses about n of the 4^bits cells of a grid: two bits more tell neighbours apart. Key and
/// index share 64 bits, which takes one of them away above 4M triangles.
int grid_bits(std::size_t triangles, int index_bits) {
  const int bits = static_cast<int>(std::bit_width(triangles)) / 2 + 3;
  return std::min(bits, (64 - index_bits) / 3);
}

/// Samples for each thread where the items are divided into ranges of keys: these then differ in size by a few percent.
constexpr std::size_t samples_per_part = 256;

/// Stable least-significant-digit radix sort by the bits from `first` to below `end`, in so many passes; `from` and
/// `to` change places with each of them.
void radix_sort(std::span<Keyed> from, std::span<Keyed> to, int first, int end, int passes) {
  std::array<std::uint32_t, digits> start;
  for (int pass = 0; pass < passes; ++pass, std::swap(from, to)) {
    const int low = first + (end - first) * pass / passes, high = first + (end - first) * (pass + 1) / passes;
    const Keyed mask = (Keyed{1} << (high - low)) - 1;
    std::fill_n(start.begin(), mask + 1, 0);
    for (const Keyed item : from) ++start[item >> low & mask];
    std::uint32_t sum = 0;
    for (std::size_t d = 0; d <= mask; ++d) sum += std::exchange(start[d], sum);
    for (const Keyed item : from) to[start[item >> low & mask]++] = item;
  }
}

/// Divides items into ranges of keys, each of which one thread then sorts in memory of its own: threads that scatter
/// into one array by digits would write to the same cache lines.
class Partition {
 public:
  Partition(const Array<Keyed>& items, std::size_t parts) : items_(items), parts_(parts), begin_(parts * parts + 1) {
    std::vector<Keyed> samples(samples_per_part * parts);
    for (std::size_t i = 0; i < samples.size(); ++i) samples[i] = items[items.size() * i / samples.size()];
    std::sort(samples.begin(), samples.end());
    for (std::size_t part = 1; part < parts; ++part) first_of_.push_back(samples[samples_per_part * part]);
  }

  /// Counts how many items of a run belong to each range.
  void count(std::size_t run) {
    std::vector<std::uint32_t> counts(parts_, 0);
    for_each(run, [&](std::size_t part, Keyed) { ++counts[part]; });
    for (std::size_t part = 0; part < parts_; ++part) begin_[part * parts_ + run + 1] = counts[part];
  }
  void sum() { std::partial_sum(begin_.begin(), begin_.end(), begin_.begin()); }

  /// Moves the items in the order of the runs, so that they keep their order inside a range.
  void move(std::size_t run, Array<Keyed>& to) const {
    std::vector<std::uint32_t> at(parts_);
    for (std::size_t part = 0; part < parts_; ++part) at[part] = begin_[part * parts_ + run];
    for_each(run, [&](std::size_t part, Keyed item) { to[at[part]++] = item; });
  }

  [[nodiscard]] std::span<Keyed> part_of(Array<Keyed>& items, std::size_t part) const {
    const std::uint32_t begin = begin_[part * parts_];
    return std::span(items).subspan(begin, begin_[(part + 1) * parts_] - begin);
  }

 private:
  template <class Use>
  void for_each(std::size_t run, Use&& use) const {
    const std::size_t end = items_.size() * (run + 1) / parts_;
    for (std::size_t i = items_.size() * run / parts_; i < end; ++i) {
      const auto after = std::upper_bound(first_of_.begin(), first_of_.end(), items_[i]);
      use(static_cast<std::size_t>(after - first_of_.begin()), items_[i]);
    }
  }

  const Array<Keyed>& items_;
  std::size_t parts_;
  std::vector<Keyed> first_of_;       ///< the least item of each range but the first
  std::vector<std::uint32_t> begin_;  ///< by range, and in it by the run that the items come from
};

/// Sorts by key; items of one key keep their order.
void sort_by_key(Array<Keyed>& items, Array<Keyed>& scratch, int first, int end, std::size_t parts) {
  // Clearing the counters of the digits costs more than this many items; those of one key are in the order of their
  // indices, which stand in the lower bits.
  constexpr std::size_t max_sorted_by_comparison = 256;
  if (items.size() <= max_sorted_by_comparison) {
    std::sort(items.begin(), items.end());
    return;
  }
  const int passes = (end - first + digit_bits - 1) / digit_bits;
  if (parts == 1) {
    radix_sort(items, scratch, first, end, passes);
    if (passes % 2 != 0) items.swap(scratch);
    return;
  }
  Partition partition(items, parts);
  for_each_task(parts, [&](std::size_t run) { partition.count(run); });
  partition.sum();
  for_each_task(parts, [&](std::size_t run) { partition.move(run, scratch); });
  for_each_task(parts, [&](std::size_t part) {
    radix_sort(partition.part_of(scratch, part), partition.part_of(items, part), first, end, passes);
  });
  if (passes % 2 == 0) items.swap(scratch);
}

Vec3 corner_sum(const MeshView& mesh, std::size_t triangle) {
  Vec3 sum;
  for (const std::uint32_t v : mesh.triangle(triangle)) {
    const Eigen::Vector3d p = mesh.vertex(v);
    sum = sum + Vec3{p.x(), p.y(), p.z()};
  }
  return sum;
}

}  // namespace

void hilbert_order(Bvh::Data& data, const MeshView& mesh, std::size_t runs) {
  const std::size_t n = mesh.triangle_count();
  data.triangle_of_slot.resize(n);
  const Arena::Loan loan(data.arena);
  const int index_bits = static_cast<int>(std::bit_width(n)), bits = grid_bits(n, index_bits);
  const Box box = data.working_box;
  const Vec3 size = box.hi - box.lo;
  const double largest = std::max({size.x, size.y, size.z, 1e-300});
  const double cells = std::ldexp(1.0, bits) - 1, scale = cells / largest;
  const FrameMap to_working(data.frame);
  Array<Keyed> items = array_in<Keyed>(data.arena), other = array_in<Keyed>(data.arena);
  items.resize(n);
  other.resize(n);
  const auto cell = [&](double x) { return static_cast<std::uint32_t>(std::min(std::max(x * scale, 0.0), cells)); };
  const BuildKernels kernels = build_kernels();
  for_each_range(n, triangles_per_task, [&](std::size_t begin, std::size_t end) {
    Batch<Vec3> sums;
    Cells of_sums;
    Batch<std::uint64_t> along_curve;
    for (std::size_t first = begin; first < end; first += triangles_at_once) {
      const std::size_t taken = std::min<std::size_t>(triangles_at_once, end - first);
      for (std::size_t i = 0; i < taken; ++i) sums[i] = corner_sum(mesh, first + i);
      for (std::size_t i = 0; i < taken; ++i) {
        const Vec3 centroid = to_working((1.0 / 3) * sums[i]) - box.lo;
        of_sums.x[i] = cell(centroid.x);
        of_sums.y[i] = cell(centroid.y);
        of_sums.z[i] = cell(centroid.z);
      }
      kernels.hilbert_indices(of_sums, bits, along_curve);
      for (std::size_t i = 0; i < taken; ++i) items[first + i] = along_curve[i] << index_bits | (first + i);
    }
  });
  sort_by_key(items, other, index_bits, index_bits + 3 * bits, runs);
  const Keyed index_mask = (Keyed{1} << index_bits) - 1;
  for_each_range(n, triangles_per_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      data.triangle_of_slot[i] = static_cast<std::uint32_t>(items[i] & index_mask);
  });
}

}  // namespace meshbound
