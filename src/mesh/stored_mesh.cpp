// SPDX-License-Identifier: MIT
#include "mesh/stored_mesh.h"

#include <algorithm>
#include <functional>

#include "numeric/ranked_numbers.h"

namespace meshbound {
namespace {

/// Whether two arrays of `count` items, which read_a(first, items) and read_b(first, items) read, agree.
template <class T, class ReadA, class ReadB, class Same>
bool same_items(std::size_t count, const ReadA& read_a, const ReadB& read_b, const Same& same) {
  constexpr std::size_t block_size = 4096;
  std::vector<T> block_a(std::min(block_size, count)), block_b(block_a.size());
  for (std::size_t first = 0; first < count; first += block_size) {
    const std::size_t size = std::min(block_size, count - first);
    const std::span<T> of_a(block_a.data(), size), of_b(block_b.data(), size);
    read_a(first, of_a);
    read_b(first, of_b);
    if (!std::equal(of_a.begin(), of_a.end(), of_b.begin(), same)) return false;
  }
  return true;
}

}  // namespace

void MeshInMemory::read_vertices(std::size_t first, std::span<Vec3> to) const {
  for (std::size_t i = 0; i < to.size(); ++i) to[i] = to_vec3(mesh_.vertices[first + i]);
}

void MeshInMemory::read_triangles(std::size_t first, std::span<Triangle> to) const {
  std::copy_n(mesh_.triangles.begin() + static_cast<std::ptrdiff_t>(first), to.size(), to.begin());
}

void MeshInSpace::append(std::span<const Eigen::Vector3d> vertices) {
  for (const Eigen::Vector3d& p : vertices) vertices_.append(to_vec3(p));
}

MeshPart part_of(const StoredMesh& whole, std::span<const std::uint32_t> triangles) {
  MeshPart part;
  part.mesh.triangles =
      gathered<Triangle>(triangles, whole.triangle_count(),
                         [&](std::size_t first, std::span<Triangle> to) { whole.read_triangles(first, to); });
  const RankedNumbers vertices(part.mesh.triangles);
  part.vertices = vertices.ascending();
  const std::vector<Vec3> positions =
      gathered<Vec3>(part.vertices, whole.vertex_count(),
                     [&](std::size_t first, std::span<Vec3> to) { whole.read_vertices(first, to); });
  part.mesh.vertices.reserve(positions.size());
  for (const Vec3& p : positions) part.mesh.vertices.push_back(to_eigen(p));
  for (Triangle& corners : part.mesh.triangles)
    for (std::uint32_t& v : corners) v = vertices.index_of(v);
  return part;
}

TriangleMesh loaded(const StoredMesh& mesh) {
  TriangleMesh all;
  all.vertices.reserve(mesh.vertex_count());
  mesh.for_each_vertex([&](std::uint32_t, const Eigen::Vector3d& p) { all.vertices.push_back(p); });
  all.triangles.resize(mesh.triangle_count());
  mesh.read_triangles(0, all.triangles);
  return all;
}

bool same_arrays(const StoredMesh& a, const StoredMesh& b) {
  if (a.vertex_count() != b.vertex_count() || a.triangle_count() != b.triangle_count()) return false;
  const auto same_position = [](const Vec3& p, const Vec3& q) { return to_eigen(p) == to_eigen(q); };
  return same_items<Vec3>(
             a.vertex_count(), [&](std::size_t first, std::span<Vec3> to) { a.read_vertices(first, to); },
             [&](std::size_t first, std::span<Vec3> to) { b.read_vertices(first, to); }, same_position) &&
         same_items<Triangle>(
             a.triangle_count(), [&](std::size_t first, std::span<Triangle> to) { a.read_triangles(first, to); },
             [&](std::size_t first, std::span<Triangle> to) { b.read_triangles(first, to); }, std::equal_to<>{});
}

std::vector<bool> used_vertices(const StoredMesh& mesh) {
  std::vector<bool> used(mesh.vertex_count());
  mesh.for_each_triangle([&](std::uint32_t, const Triangle& corners) {
    for (const std::uint32_t v : corners) used[v] = true;
  });
  return used;
}

Eigen::AlignedBox3d used_bounding_box(const StoredMesh& mesh) {
  const std::vector<bool> used = used_vertices(mesh);
  Eigen::AlignedBox3d box;
  mesh.for_each_vertex([&](std::uint32_t v, const Eigen::Vector3d& p) {
    if (used[v]) box.extend(p);
  });
  return box;
}

}  // namespace meshbound
