// SPDX-License-Identifier: MIT
#include "tiles/clusters.h"

#include <algorithm>

#include "numeric/numbers_below.h"
#include "numeric/rounding.h"
#include "tiles/tile_cut.h"

namespace meshbound {
namespace {

/// Triangles of a cluster. Smaller clusters include less beyond the reach, but more boxes have to be tested.
constexpr std::uint64_t triangles_of_cluster = 4096;

/// Number of clusters near a tile for which it is not halved, however small it is: a single triangle may be near as
/// many.
constexpr std::size_t clusters_beside = 8;

/// Calls use(triangles) for tiles of all triangles of a mesh in memory.
void cut(const TriangleMesh& mesh, std::uint64_t max_triangles, const UseTile& use) {
  std::vector<CutItem> items;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) items.push_back({to_vec3(sum_of_corners(mesh, t)), t});
  cut_into_tiles(std::move(items), max_triangles, {}, use);
}

/// Calls use(triangles) for tiles of all triangles of a mesh.
void cut(const StoredMesh& mesh, std::uint64_t max_triangles, const UseTile& use) {
  constexpr std::size_t triangles_of_block = std::size_t{1} << 18;
  ItemStore<CutItem> items(mesh.space());
  for (std::size_t first = 0; first < mesh.triangle_count(); first += triangles_of_block) {
    std::vector<std::uint32_t> block = numbers_below(std::min(triangles_of_block, mesh.triangle_count() - first));
    for (std::uint32_t& t : block) t += static_cast<std::uint32_t>(first);
    const MeshPart part = part_of(mesh, block);
    for (std::uint32_t t = 0; t < block.size(); ++t) items.append({to_vec3(sum_of_corners(part.mesh, t)), block[t]});
  }
  cut_into_tiles(std::move(items), max_triangles, {}, mesh.space(), use);
}

/// A lower bound of the distance between two boxes: the largest gap along an axis, which rounds once.
double separation(const Eigen::AlignedBox3d& a, const Eigen::AlignedBox3d& b) {
  const double gap = (a.min() - b.max()).cwiseMax(b.min() - a.max()).maxCoeff();
  return std::max(0.0, next_down(gap));
}

/// Those of `numbers` at these indices.
std::vector<std::uint32_t> selected(std::span<const std::uint32_t> numbers, std::span<const std::uint32_t> indices) {
  std::vector<std::uint32_t> chosen;
  for (const std::uint32_t i : indices) chosen.push_back(numbers[i]);
  return chosen;
}

/// The box of some triangles of a mesh.
Eigen::AlignedBox3d box_of(const TriangleMesh& mesh, std::span<const std::uint32_t> triangles) {
  Eigen::AlignedBox3d box;
  for (const std::uint32_t t : triangles)
    for (const std::uint32_t v : mesh.triangles[t]) box.extend(mesh.vertices[v]);
  return box;
}

/// Adds a tile of these triangles of A, whose box this is. It is halved while more than `max_near` triangles of B are
/// near, since a few large triangles may run along all of B.
void add_tile(StoredLists& tiles, const StoredMesh& a, std::span<const std::uint32_t> triangles,
              const Eigen::AlignedBox3d& box, const Clusters& b, double reach, std::size_t max_near) {
  std::size_t near = 0;
  for (std::size_t i = 0; i < b.boxes.size(); ++i)
    if (separation(box, b.boxes[i]) <= reach) near += b.sizes[i];
  if (triangles.size() == 1 || near <= max_near) return tiles.append(triangles);
  const TriangleMesh part = part_of(a, triangles).mesh;
  cut(part, (triangles.size() + 1) / 2, [&](std::span<const std::uint32_t> half) {
    add_tile(tiles, a, selected(triangles, half), box_of(part, half), b, reach, max_near);
  });
}

}  // namespace

Clusters::Clusters(const StoredMesh& whole, std::size_t max_triangles) : mesh(whole), triangles(whole.space()) {
  cut(mesh, max_triangles, [&](std::span<const std::uint32_t> tile) {
    first_of_tile.push_back(boxes.size());
    const TriangleMesh part = part_of(mesh, tile).mesh;
    cut(part, triangles_of_cluster, [&](std::span<const std::uint32_t> cluster) {
      triangles.append(selected(tile, cluster));
      sizes.push_back(cluster.size());
      boxes.push_back(box_of(part, cluster));
    });
  });
  first_of_tile.push_back(boxes.size());
}

Eigen::AlignedBox3d box_of(const TriangleMesh& part) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : part.vertices) box.extend(p);
  return box;
}

Near near_to(const Clusters& b, const Eigen::AlignedBox3d& box, double reach) {
  Near near;
  for (std::size_t k = 0; k < b.boxes.size(); ++k) {
    const double apart = separation(box, b.boxes[k]);
    if (apart > reach) {
      near.rest = std::min(near.rest, apart);
      continue;
    }
    const std::vector<std::uint32_t> cluster = b.triangles[k];
    near.triangles.insert(near.triangles.end(), cluster.begin(), cluster.end());
  }
  return near;
}

StoredLists tiles_beside(const Clusters& a, const Clusters& b, double reach, std::size_t max_triangles) {
  StoredLists tiles(a.mesh.space());
  const std::size_t max_near = 2 * max_triangles + clusters_beside * triangles_of_cluster;
  for (std::size_t tile = 0; tile + 1 < a.first_of_tile.size(); ++tile) {
    const std::size_t first = a.first_of_tile[tile], end = a.first_of_tile[tile + 1];
    std::vector<std::uint32_t> triangles = a.triangles.range(first, end).numbers;
    std::sort(triangles.begin(), triangles.end());
    Eigen::AlignedBox3d box;
    for (std::size_t k = first; k < end; ++k) box.extend(a.boxes[k]);
    add_tile(tiles, a.mesh, triangles, box, b, reach, max_near);
  }
  return tiles;
}

}  // namespace meshbound
