// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "meshbound/bvh.h"
#include "meshbound/triangle_mesh.h"
#include "simplify/decimation_state.h"
#include "simplify/mesh/manifold_soup.h"

namespace meshbound {

/// A mesh as the decimation keeps it, and the arrays of the original that its state refers to.
class DecimationFixture {
 public:
  DecimationFixture(const TriangleMesh& mesh, double tolerance)
      : vertices_(positions(mesh)),
        triangles_(mesh.triangles),
        soup_(manifold_soup(mesh)),
        tree_(mesh),
        state(vertices_, triangles_, tree_, array_mesh(), soup_.vertex_of, soup_.triangle_of) {
    state.grow_tolerance(tolerance);
    state.set_samples(tolerance);
  }
  DecimationFixture(const DecimationFixture&) = delete;
  DecimationFixture& operator=(const DecimationFixture&) = delete;

  /// What is left.
  [[nodiscard]] TriangleMesh result() const {
    TriangleMesh out;
    std::vector<std::uint32_t> index(state.mesh.vertex_count(), ArrayMesh::none);
    for (std::uint32_t f = 0; f < state.mesh.face_count(); ++f) {
      if (state.mesh.is_removed(f)) continue;
      Triangle& triangle = out.triangles.emplace_back();
      for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t v = state.mesh.vertex(3 * f + k);
        if (index[v] == ArrayMesh::none) {
          index[v] = static_cast<std::uint32_t>(out.vertices.size());
          const Vec3 p = state.mesh.position(v);
          out.vertices.emplace_back(p.x, p.y, p.z);
        }
        triangle[k] = index[v];
      }
    }
    return out;
  }

 private:
  static std::vector<Vec3> positions(const TriangleMesh& mesh) {
    std::vector<Vec3> result;
    for (const Eigen::Vector3d& p : mesh.vertices) result.push_back({p.x(), p.y(), p.z()});
    return result;
  }
  [[nodiscard]] ArrayMesh array_mesh() const {
    std::vector<Vec3> points;
    for (const std::uint32_t v : soup_.vertex_of) points.push_back(vertices_[v]);
    return {std::move(points), soup_.faces, soup_.twin};
  }

  std::vector<Vec3> vertices_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  ManifoldSoup soup_;
  Bvh tree_;

 public:
  DecimationState state;
};

}  // namespace meshbound
