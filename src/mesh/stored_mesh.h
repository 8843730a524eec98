// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/eigen_vec3.h"
#include "mesh/item_store.h"
#include "meshbound/mesh_summary.h"
#include "meshbound/triangle_mesh.h"

namespace meshbound {

/// A valid mesh that is read by ranges, as it may be larger than memory. Any number of threads may read.
class StoredMesh {
 public:
  StoredMesh() = default;
  StoredMesh(const StoredMesh&) = delete;
  StoredMesh& operator=(const StoredMesh&) = delete;
  virtual ~StoredMesh() = default;

  [[nodiscard]] virtual std::size_t vertex_count() const = 0;
  [[nodiscard]] virtual std::size_t triangle_count() const = 0;
  /// The vertices from `first` on, which must be there. Throws `IoError`.
  virtual void read_vertices(std::size_t first, std::span<Vec3> to) const = 0;
  /// The triangles from `first` on, likewise.
  virtual void read_triangles(std::size_t first, std::span<Triangle> to) const = 0;
  /// Where arrays of the size of this mesh are best kept.
  [[nodiscard]] virtual const StoreSpace& space() const = 0;

  /// Calls use(number, position) for all vertices, in order.
  template <class Use>
  void for_each_vertex(const Use& use) const {
    for_each_in_blocks<Vec3>(
        0, vertex_count(), [&](std::size_t first, std::span<Vec3> to) { read_vertices(first, to); },
        [&](std::size_t v, const Vec3& p) { use(static_cast<std::uint32_t>(v), to_eigen(p)); });
  }
  /// Calls use(number, corners) for all triangles, in order.
  template <class Use>
  void for_each_triangle(const Use& use) const {
    for_each_in_blocks<Triangle>(
        0, triangle_count(), [&](std::size_t first, std::span<Triangle> to) { read_triangles(first, to); },
        [&](std::size_t t, const Triangle& corners) { use(static_cast<std::uint32_t>(t), corners); });
  }
};

/// A mesh in memory.
class MeshInMemory : public StoredMesh {
 public:
  /// `mesh` must outlive this.
  explicit MeshInMemory(const TriangleMesh& mesh) : mesh_(mesh) {}
  [[nodiscard]] std::size_t vertex_count() const override { return mesh_.vertices.size(); }
  [[nodiscard]] std::size_t triangle_count() const override { return mesh_.triangles.size(); }
  void read_vertices(std::size_t first, std::span<Vec3> to) const override;
  void read_triangles(std::size_t first, std::span<Triangle> to) const override;
  [[nodiscard]] const StoreSpace& space() const override { return space_; }

 private:
  const TriangleMesh& mesh_;
  StoreSpace space_;
};

/// Where other processes of this user on this machine find a mesh.
struct SharedMesh {
  SharedBytes vertices, triangles;

  [[nodiscard]] std::size_t vertex_count() const { return vertices.size / sizeof(Vec3); }
  /// Its first items.
  [[nodiscard]] SharedMesh with_counts(std::size_t vertex_count, std::size_t triangle_count) const {
    return {{vertices.file, vertex_count * sizeof(Vec3)}, {triangles.file, triangle_count * sizeof(Triangle)}};
  }
};

/// A mesh in a space, of which it keeps no more than buffers in memory.
class MeshInSpace : public StoredMesh {
 public:
  explicit MeshInSpace(const StoreSpace& space) : space_(space), vertices_(space), triangles_(space) {}
  MeshInSpace(const StoreSpace& space, const TriangleMesh& mesh) : MeshInSpace(space) {
    append(mesh.vertices);
    append(mesh.triangles);
  }
  void append(std::span<const Eigen::Vector3d> vertices);
  void append(std::span<const Triangle> triangles) { triangles_.append(triangles); }
  /// Everything that was appended is there for others from here on. Throws `IoError`.
  [[nodiscard]] SharedMesh share() { return {vertices_.share(), triangles_.share()}; }
  /// Makes this the mesh of another process; what is appended stands behind it in the same files. Throws as
  /// `ByteStore`.
  void use(const SharedMesh& shared) {
    vertices_ = {space_, shared.vertices};
    triangles_ = {space_, shared.triangles};
  }

  [[nodiscard]] std::size_t vertex_count() const override { return vertices_.size(); }
  [[nodiscard]] std::size_t triangle_count() const override { return triangles_.size(); }
  void read_vertices(std::size_t first, std::span<Vec3> to) const override { vertices_.read(first, to); }
  void read_triangles(std::size_t first, std::span<Triangle> to) const override { triangles_.read(first, to); }
  [[nodiscard]] const StoreSpace& space() const override { return space_; }

 private:
  StoreSpace space_;
  ItemStore<Vec3> vertices_;
  ItemStore<Triangle> triangles_;
};

/// Some triangles of a mesh as a mesh of their own.
struct MeshPart {
  TriangleMesh mesh;                    ///< the triangles in the order that they were asked for
  std::vector<std::uint32_t> vertices;  ///< by vertex of the part: its number in the whole, ascending
};

/// O(n) for n triangles, and 1 / 4096 for each vertex of the whole. Numbers near one another are best given one after
/// the other.
[[nodiscard]] MeshPart part_of(const StoredMesh& whole, std::span<const std::uint32_t> triangles);

/// All of a mesh in memory.
[[nodiscard]] TriangleMesh loaded(const StoredMesh& mesh);

/// Whether two meshes have the same vertices and the same triangles in the same order. -0 and 0 are one coordinate.
/// Reads blocks of both, up to the first difference. Throws `IoError`.
[[nodiscard]] bool same_arrays(const StoredMesh& a, const StoredMesh& b);

/// By vertex: whether a triangle uses it.
[[nodiscard]] std::vector<bool> used_vertices(const StoredMesh& mesh);

/// As those of "meshbound/mesh_summary.h". A summary takes 8 bytes for each vertex in memory, and 4 for each of the
/// edges that it looks at in one go over the triangles: `max_edges`, or a quarter of the triangles if that is more.
[[nodiscard]] MeshSummary summarise(const StoredMesh& mesh, std::size_t max_edges = std::size_t{1} << 24);
[[nodiscard]] Eigen::AlignedBox3d used_bounding_box(const StoredMesh& mesh);

}  // namespace meshbound
