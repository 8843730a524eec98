// SPDX-License-Identifier: MIT
#include "distance/shortcuts/identical.h"

#include <algorithm>
#include <atomic>
#include <cstring>

#include "distance/shortcuts/triangle_table.h"
#include "numeric/tasks.h"

namespace meshbound {
namespace {

/// Vertices or triangles that one task looks up: some ten microseconds of work.
constexpr std::size_t found_per_task = 2048;

template <class T>
bool same_bytes(const Array<T>& a, const Array<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

}  // namespace

std::uint64_t drop_identical_triangles(const Bvh::Data& a, const Bvh::Data& b, std::vector<std::uint8_t>& alive) {
  if (same_bytes(a.corners, b.corners) && same_bytes(a.vertices, b.vertices)) {
    std::fill(alive.begin(), alive.end(), std::uint8_t{0});
    return a.triangle_count();
  }
  const PositionTable positions(b.vertices);
  const TriangleTable triangles(b.corners, b.vertices, positions);
  Array<std::uint32_t> twin(a.vertices.size());
  for_each_range(twin.size(), found_per_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) twin[v] = positions.find(a.vertices[v]);
  });
  std::atomic<std::uint64_t> count{0};
  for_each_range(a.triangle_count(), found_per_task, [&](std::size_t begin, std::size_t end) {
    std::uint64_t own_count = 0;
    for (std::size_t slot = begin; slot < end; ++slot) {
      const Triangle& t = a.corners[slot];
      const Triangle there{twin[t[0]], twin[t[1]], twin[t[2]]};
      if (there[0] == no_index || there[1] == no_index || there[2] == no_index) continue;
      if (triangles.find(there) == no_index) continue;
      alive[slot] = 0;
      ++own_count;
    }
    count += own_count;
  });
  return count;
}

bool same_triangle(const Bvh::Data& a, const Triangle& t, const Bvh::Data& b, const Triangle& u) {
  const auto same = [&](std::uint32_t v, std::uint32_t w) { return same_position(a.vertices[v], b.vertices[w]); };
  Triangle order{0, 1, 2};
  do {
    if (same(t[0], u[order[0]]) && same(t[1], u[order[1]]) && same(t[2], u[order[2]])) return true;
  } while (std::next_permutation(order.begin(), order.end()));
  return false;
}

std::uint32_t slot_using_vertex(const Bvh::Data& data, std::uint32_t vertex) {
  const auto uses = [&](std::uint32_t slot) {
    const Triangle& t = data.corners[slot];
    return t[0] == vertex || t[1] == vertex || t[2] == vertex;
  };
  const std::uint32_t n = data.triangle_count();
  const auto guess = static_cast<std::uint32_t>(std::uint64_t{vertex} * n / data.vertices.size());
  for (std::uint32_t away = 0; away < n; ++away) {
    if (guess + away < n && uses(guess + away)) return guess + away;
    if (away <= guess && uses(guess - away)) return guess - away;
  }
  return 0;
}

}  // namespace meshbound
