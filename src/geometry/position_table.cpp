// SPDX-License-Identifier: MIT
#include "geometry/position_table.h"

#include "numeric/no_index.h"

namespace meshbound {

PositionTable::PositionTable(std::span<const Vec3> vertices)
    : vertices_(vertices), table_(2 * vertices.size() + 1, no_index) {
  for (std::uint32_t v = 0; v < vertices.size(); ++v) (void)add(v);
}

PositionTable::PositionTable(std::span<const Vec3> vertices, std::vector<std::uint32_t>& first)
    : vertices_(vertices), table_(2 * vertices.size() + 1, no_index) {
  first.resize(vertices.size());
  for (std::uint32_t v = 0; v < vertices.size(); ++v) first[v] = add(v);
}

/// The first vertex at the position of this one, which is itself where none came before.
std::uint32_t PositionTable::add(std::uint32_t vertex) {
  std::uint32_t& entry = table_[entry_of(vertices_[vertex])];
  if (entry == no_index) entry = vertex;
  return entry;
}

std::size_t PositionTable::entry_of(const Vec3& p) const {
  // A share of the table: it has less than 2^33 entries, so 31 bits of the hash do not overflow.
  auto i = static_cast<std::size_t>((position_hash(position_key(p)) >> 33) * std::uint64_t{table_.size()} >> 31);
  while (table_[i] != no_index && !same_position(vertices_[table_[i]], p)) i = i + 1 == table_.size() ? 0 : i + 1;
  return i;
}

std::vector<std::uint32_t> first_at_position(std::span<const Vec3> vertices) {
  std::vector<std::uint32_t> first;
  const PositionTable table(vertices, first);
  return first;
}

}  // namespace meshbound
