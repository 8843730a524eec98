// SPDX-License-Identifier: MIT
#include "distance/identical.h"

#include <algorithm>
#include <bit>
#include <optional>

namespace meshbound {
namespace {

constexpr std::uint32_t none = 0xffffffff;

bool same(const Vec3& p, const Vec3& q) { return p.x == q.x && p.y == q.y && p.z == q.z; }

std::uint64_t hash(const Vec3& p) {
  std::uint64_t h = 0;
  for (const double x : {p.x, p.y, p.z}) {
    h = (h ^ std::bit_cast<std::uint64_t>(x + 0.0)) * 0x9e3779b97f4a7c15ULL;  // + 0.0: -0 and 0 are one position
    h ^= h >> 29;
  }
  return h;
}

/// Finds the first vertex of a model at an exact position; linear probing at most half full.
class PositionTable {
 public:
  explicit PositionTable(const std::vector<Vec3>& vertices)
      : vertices_(vertices), table_(std::bit_ceil(2 * vertices.size() + 1), none) {
    for (std::uint32_t v = 0; v < vertices.size(); ++v) {
      std::uint32_t& entry = table_[place(vertices[v])];
      if (entry == none) entry = v;
    }
  }

  [[nodiscard]] std::uint32_t find(const Vec3& p) const { return table_[place(p)]; }

 private:
  [[nodiscard]] std::size_t place(const Vec3& p) const {
    const std::size_t mask = table_.size() - 1;
    std::size_t i = hash(p) & mask;
    while (table_[i] != none && !same(vertices_[table_[i]], p)) i = (i + 1) & mask;
    return i;
  }

  const std::vector<Vec3>& vertices_;
  std::vector<std::uint32_t> table_;
};

using SortedCorners = Triangle;

SortedCorners sorted(Triangle t) {
  std::sort(t.begin(), t.end());
  return t;
}

/// Triangles of B as sorted corners, by their smallest corner. Vertices at one position count as one.
class TriangleTable {
 public:
  TriangleTable(const Bvh::Data& b, const PositionTable& positions) : begin_(b.vertices.size() + 1, 0) {
    std::vector<SortedCorners> all(b.corners.size());
    for (std::size_t slot = 0; slot < all.size(); ++slot) {
      Triangle t = b.corners[slot];
      for (std::uint32_t& v : t) v = positions.find(b.vertices[v]);
      all[slot] = sorted(t);
      ++begin_[all[slot][0] + 1];
    }
    for (std::size_t v = 1; v < begin_.size(); ++v) begin_[v] += begin_[v - 1];
    triangles_.resize(all.size());
    std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
    for (const SortedCorners& t : all) triangles_[next[t[0]]++] = t;
    for (std::size_t v = 0; v + 1 < begin_.size(); ++v)
      std::sort(triangles_.begin() + begin_[v], triangles_.begin() + begin_[v + 1]);
  }

  [[nodiscard]] bool contains(const SortedCorners& t) const {
    return std::binary_search(triangles_.begin() + begin_[t[0]], triangles_.begin() + begin_[t[0] + 1], t);
  }

 private:
  std::vector<std::uint32_t> begin_;
  std::vector<SortedCorners> triangles_;
};

}  // namespace

std::uint64_t drop_identical_triangles(const Bvh::Data& a, const Bvh::Data& b, std::vector<std::uint8_t>& alive) {
  const PositionTable positions(b.vertices);
  std::vector<std::uint32_t> twin(a.vertices.size());
  for (std::size_t v = 0; v < twin.size(); ++v) twin[v] = positions.find(a.vertices[v]);
  std::optional<TriangleTable> triangles;  // built when the first triangle has all its corners in B
  std::uint64_t count = 0;
  for (std::uint32_t slot = 0; slot < a.triangle_count(); ++slot) {
    const Triangle& t = a.corners[slot];
    const Triangle there{twin[t[0]], twin[t[1]], twin[t[2]]};
    if (there[0] == none || there[1] == none || there[2] == none) continue;
    if (!triangles) triangles.emplace(b, positions);
    if (!triangles->contains(sorted(there))) continue;
    alive[slot] = 0;
    ++count;
  }
  return count;
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
