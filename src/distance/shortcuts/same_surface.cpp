// SPDX-License-Identifier: MIT
#include <algorithm>
#include <optional>

#include "distance/shortcuts/corresponding.h"
#include "distance/shortcuts/triangle_table.h"
#include "mesh/mesh_arrays.h"
#include "meshbound/distance.h"
#include "numeric/rounding.h"

namespace meshbound {
namespace {

constexpr std::size_t sampled_vertices = 64;

bool same_arrays(const MeshView& a, const MeshView& b) {
  if (a.vertex_count() != b.vertex_count()) return false;
  for (std::size_t v = 0; v < a.vertex_count(); ++v)
    if (a.vertex(v) != b.vertex(v)) return false;
  for (std::size_t i = 0; i < a.triangle_count(); ++i)
    if (a.triangle(i) != b.triangle(i)) return false;
  return true;
}

/// Finds the triangles of one mesh in another.
class Twins {
 public:
  explicit Twins(const MeshView& mesh) : vertices_(positions_of(mesh)), positions_(vertices_) {}

  [[nodiscard]] bool has_sample_of(const MeshView& other) const {
    const std::size_t n = other.triangle_count(), samples = std::min(sampled_vertices, n);
    for (std::size_t i = 0; i < samples; ++i)
      if (vertex_at(other, other.triangle(i * n / samples)[0]) == no_index) return false;
    return true;
  }

  void index(const MeshView& mesh) { triangles_.emplace(triangles_of(mesh), vertices_, positions_); }

  /// The twin of a triangle, the same one for all that are equal, or `no_index`.
  [[nodiscard]] std::uint32_t find(const MeshView& other, std::size_t triangle) const {
    Triangle there = other.triangle(triangle);
    for (std::uint32_t& v : there) {
      v = vertex_at(other, v);
      if (v == no_index) return no_index;
    }
    return triangles_->find(there);
  }

 private:
  [[nodiscard]] std::uint32_t vertex_at(const MeshView& other, std::uint32_t v) const {
    const Eigen::Vector3d p = other.vertex(v);
    return positions_.find({p.x(), p.y(), p.z()});
  }

  std::vector<Vec3> vertices_;
  PositionTable positions_;
  std::optional<TriangleTable> triangles_;
};

/// Whether each triangle of A has a twin in B, and each of B is one. The meshes have equally many triangles.
bool same_sets(const MeshView& a, const MeshView& b) {
  Twins in_b(b);
  if (!in_b.has_sample_of(a)) return false;
  in_b.index(b);
  std::vector<std::uint8_t> met(b.triangle_count(), 0);
  for (std::size_t i = 0; i < a.triangle_count(); ++i) {
    const std::uint32_t twin = in_b.find(a, i);
    if (twin == no_index) return false;
    met[twin] = 1;
  }
  for (std::size_t i = 0; i < b.triangle_count(); ++i)
    if (met[i] == 0 && met[in_b.find(b, i)] == 0) return false;
  return true;
}

/// Whether two triangles have the same corners in any order.
bool same_corners(const MeshView& a, Triangle t, const MeshView& b, Triangle u) {
  std::sort(u.begin(), u.end());
  do {
    if (a.vertex(t[0]) == b.vertex(u[0]) && a.vertex(t[1]) == b.vertex(u[1]) && a.vertex(t[2]) == b.vertex(u[2]))
      return true;
  } while (std::next_permutation(u.begin(), u.end()));
  return false;
}

/// The result for two meshes that `same_sets` or `same_arrays` found to have the same triangles.
OneSidedDistance zero_distance(const MeshView& from, const MeshView& to) {
  OneSidedDistance result;
  result.bounds = {0, 0};
  const Triangle first = from.triangle(0);
  std::uint32_t twin = 0;
  while (!same_corners(from, first, to, to.triangle(twin))) ++twin;
  const Eigen::Vector3d point = from.vertex(first[0]);
  result.witness = {{point, 0}, {point, twin}, 0};
  result.stats.triangles = result.stats.matched = from.triangle_count();
  result.stats.culled_on_a_percent = result.stats.culled_on_b_percent = 100;
  return result;
}

}  // namespace

bool same_surface(const MeshView& a, const MeshView& b) {
  check_floating_point_model();
  validate(a);
  validate(b);
  return a.triangle_count() == b.triangle_count() && (same_arrays(a, b) || same_sets(a, b));
}

std::optional<HausdorffDistance> distance_without_trees(const MeshView& a, const MeshView& b, double limit) {
  if (!(limit >= 0)) throw InvalidInput("the limit of a distance must be a length of 0 or more");
  check_floating_point_model();
  if (a.triangle_count() != b.triangle_count()) return std::nullopt;  // without a look, which would take long
  validate(a);
  validate(b);
  if (same_arrays(a, b)) return HausdorffDistance{{0, 0}, zero_distance(a, b), zero_distance(b, a)};
  if (auto distance = distance_of_corresponding(a, b, limit)) return distance;
  if (!same_sets(a, b)) return std::nullopt;
  return HausdorffDistance{{0, 0}, zero_distance(a, b), zero_distance(b, a)};
}

}  // namespace meshbound
