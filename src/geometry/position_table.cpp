// SPDX-License-Identifier: MIT
#include "geometry/position_table.h"

namespace meshbound {

PositionTable::PositionTable(std::span<const Vec3> vertices)
    : vertices_(vertices), table_(std::bit_ceil(2 * vertices.size() + 1), no_index) {
  for (std::uint32_t v = 0; v < vertices.size(); ++v) {
    std::uint32_t& entry = table_[entry_of(vertices[v])];
    if (entry == no_index) entry = v;
  }
}

std::size_t PositionTable::entry_of(const Vec3& p) const {
  const std::size_t mask = table_.size() - 1;
  std::size_t i = position_hash(position_key(p)) & mask;
  while (table_[i] != no_index && !same_position(vertices_[table_[i]], p)) i = (i + 1) & mask;
  return i;
}

std::vector<std::uint32_t> first_at_position(std::span<const Vec3> vertices) {
  const PositionTable table(vertices);
  std::vector<std::uint32_t> first(vertices.size());
  for (std::size_t v = 0; v < vertices.size(); ++v) first[v] = table.find(vertices[v]);
  return first;
}

}  // namespace meshbound
