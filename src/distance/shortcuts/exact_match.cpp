// SPDX-License-Identifier: MIT
#include "distance/shortcuts/exact_match.h"

#include <algorithm>
#include <bit>

namespace meshbound {
namespace {

bool same(const Vec3& p, const Vec3& q) { return p.x == q.x && p.y == q.y && p.z == q.z; }

std::uint64_t hash(const Vec3& p) {
  std::uint64_t h = 0;
  for (const double x : {p.x, p.y, p.z}) {
    h = (h ^ std::bit_cast<std::uint64_t>(x + 0.0)) * 0x9e3779b97f4a7c15ULL;  // + 0.0: -0 and 0 are one position
    h ^= h >> 29;
  }
  return h;
}

Triangle sorted(Triangle t) {
  std::sort(t.begin(), t.end());
  return t;
}

}  // namespace

PositionTable::PositionTable(std::span<const Vec3> vertices)
    : vertices_(vertices), table_(std::bit_ceil(2 * vertices.size() + 1), no_match) {
  for (std::uint32_t v = 0; v < vertices.size(); ++v) {
    std::uint32_t& entry = table_[place(vertices[v])];
    if (entry == no_match) entry = v;
  }
}

std::size_t PositionTable::place(const Vec3& p) const {
  const std::size_t mask = table_.size() - 1;
  std::size_t i = hash(p) & mask;
  while (table_[i] != no_match && !same(vertices_[table_[i]], p)) i = (i + 1) & mask;
  return i;
}

TriangleTable::TriangleTable(std::span<const Triangle> triangles, std::span<const Vec3> vertices,
                             const PositionTable& positions)
    : begin_(vertices.size() + 1, 0) {
  std::vector<std::uint32_t> first_at(vertices.size());
  for (std::size_t v = 0; v < vertices.size(); ++v) first_at[v] = positions.find(vertices[v]);
  std::vector<Triangle> all(triangles.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Triangle& t = triangles[i];
    all[i] = sorted({first_at[t[0]], first_at[t[1]], first_at[t[2]]});
    ++begin_[all[i][0] + 1];
  }
  for (std::size_t v = 1; v < begin_.size(); ++v) begin_[v] += begin_[v - 1];
  entries_.resize(all.size());
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  for (std::uint32_t i = 0; i < all.size(); ++i) entries_[next[all[i][0]]++] = {all[i], i};
  for (std::size_t v = 0; v < vertices.size(); ++v)
    if (begin_[v + 1] - begin_[v] > 1) std::sort(entries_.begin() + begin_[v], entries_.begin() + begin_[v + 1]);
}

std::uint32_t TriangleTable::find(const Triangle& corners) const {
  const Entry wanted{sorted(corners), 0};
  const auto begin = entries_.begin() + begin_[wanted.corners[0]],
             end = entries_.begin() + begin_[wanted.corners[0] + 1];
  const auto found = std::lower_bound(begin, end, wanted);
  return found != end && found->corners == wanted.corners ? found->index : no_match;
}

}  // namespace meshbound
