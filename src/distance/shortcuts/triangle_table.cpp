// SPDX-License-Identifier: MIT
#include "distance/shortcuts/triangle_table.h"

#include <algorithm>

namespace meshbound {
namespace {

Triangle sorted(Triangle t) {
  std::sort(t.begin(), t.end());
  return t;
}

}  // namespace

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
  return found != end && found->corners == wanted.corners ? found->index : no_index;
}

}  // namespace meshbound
