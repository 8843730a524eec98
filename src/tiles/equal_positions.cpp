// SPDX-License-Identifier: MIT
#include "tiles/equal_positions.h"

#include "geometry/position_table.h"
#include "mesh/weld.h"
#include "numeric/numbers_below.h"

namespace meshbound {
namespace {

struct Point {
  Vec3 position;
  std::uint32_t vertex = 0;
};

}  // namespace

std::vector<std::uint32_t> first_at_positions(const StoredMesh& mesh, std::size_t vertices_of_bucket) {
  std::vector<ItemStore<Point>> buckets;
  while (buckets.size() * vertices_of_bucket < mesh.vertex_count()) buckets.emplace_back(mesh.space());
  mesh.for_each_vertex([&](std::uint32_t v, const Eigen::Vector3d& p) {
    const Vec3 position = to_vec3(p);
    // The low bits of the hash are the Welder's.
    buckets[(position_hash(position_key(position)) >> 32) % buckets.size()].append({position, v});
  });
  std::vector<std::uint32_t> first_at;
  for (ItemStore<Point>& bucket : buckets) {
    Welder welder;
    std::vector<std::uint32_t> first;
    bucket.for_each([&](std::size_t, const Point& point) {
      const std::uint32_t position = welder.index_of(to_eigen(point.position));
      if (position == first.size()) {
        first.push_back(point.vertex);
        return;
      }
      if (first_at.empty()) first_at = numbers_below(mesh.vertex_count());
      first_at[point.vertex] = first[position];
    });
    bucket = ItemStore<Point>(StoreSpace());  // gives the room back
  }
  return first_at;
}

}  // namespace meshbound
