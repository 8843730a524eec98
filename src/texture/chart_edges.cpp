// SPDX-License-Identifier: MIT
#include "texture/chart_edges.h"

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "numeric/no_index.h"

namespace meshbound {
namespace {

/// A hash table of the edges of the triangles with an area in the texture, by their ends there and their material.
class EdgeTable {
 public:
  explicit EdgeTable(std::span<ChartTriangle> triangles)
      : triangles_(triangles), slots_(std::bit_ceil(6 * triangles.size() + 1)) {}

  void link() {
    for (const ChartTriangle& t : triangles_)
      if (t.chart == Chart::Area) add(t);
  }

 private:
  struct Slot {
    std::uint32_t key = 0;
    std::uint32_t first = no_index, second = no_index;  ///< edges: 3 triangle + corner
  };

  [[nodiscard]] const ChartTriangle*& across(std::uint32_t edge) { return triangles_[edge / 3].across[edge % 3]; }

  /// The ends of an edge, with the triangle to the left.
  [[nodiscard]] std::array<const Eigen::Vector2d*, 2> ends_of(std::uint32_t edge) const {
    const ChartTriangle& t = triangles_[edge / 3];
    const auto& uv = t.source->coordinates;
    const std::uint32_t corner = edge % 3, next = (corner + 1) % 3, last = (corner + 2) % 3;
    return t.turned ? std::array{&uv[last], &uv[next]} : std::array{&uv[next], &uv[last]};
  }
  /// Equal for equal points, rarely for others.
  static std::uint64_t key_of(const Eigen::Vector2d& p) {
    const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x + 0.0); };  // no -0
    const std::uint64_t key = (bits(p.x()) * odd ^ std::rotl(bits(p.y()), 29)) * odd;
    return key ^ (key >> 32);
  }

  void add(const ChartTriangle& t) {
    const auto& uv = t.source->coordinates;
    const std::array<std::uint64_t, 3> keys = {key_of(uv[0]), key_of(uv[1]), key_of(uv[2])};
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint64_t key = (keys[(k + 1) % 3] + keys[(k + 2) % 3]) * odd;
      add(3 * t.number + k, static_cast<std::size_t>(key >> 32), static_cast<std::uint32_t>(key));
    }
  }

  void add(std::uint32_t edge, std::size_t place, std::uint32_t key) {
    const std::size_t mask = slots_.size() - 1;
    std::size_t i = place & mask;
    while (slots_[i].first != no_index && !(slots_[i].key == key && are_equal(slots_[i].first, edge)))
      i = (i + 1) & mask;
    Slot& slot = slots_[i];
    if (slot.first == no_index) {
      slot = {key, edge, no_index};
    } else if (slot.second == no_index) {
      slot.second = edge;
      if (*ends_of(slot.first)[0] == *ends_of(edge)[0]) return;  // on the same side
      across(slot.first) = &triangles_[edge / 3];
      across(edge) = &triangles_[slot.first / 3];
    } else {
      across(slot.first) = across(slot.second) = nullptr;
    }
  }

  [[nodiscard]] bool are_equal(std::uint32_t e, std::uint32_t f) const {
    const auto [p, q] = ends_of(e);
    const auto [from, to] = ends_of(f);
    return triangles_[e / 3].source->material == triangles_[f / 3].source->material &&
           ((*p == *from && *q == *to) || (*p == *to && *q == *from));
  }

  static constexpr std::uint64_t odd = 0x9E3779B97F4A7C15;  ///< 2^64 over the golden ratio

  std::span<ChartTriangle> triangles_;
  std::vector<Slot> slots_;
};

}  // namespace

void link_across_edges(std::span<ChartTriangle> triangles) { EdgeTable(triangles).link(); }

}  // namespace meshbound
