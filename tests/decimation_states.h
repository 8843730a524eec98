// SPDX-License-Identifier: MIT
/// States of a decimation that nothing has happened to, for tests of single functions on them.
#pragma once
#include <array>
#include <optional>
#include <vector>

#include "meshbound/bvh.h"
#include "simplify/decimation_state.h"
#include "simplify/mesh/manifold_soup.h"

namespace meshbound::test {

/// That of a mesh in its own coordinates.
class StateOf {
 public:
  explicit StateOf(const TriangleMesh& mesh) : triangles_(mesh.triangles.begin(), mesh.triangles.end()), tree_(mesh) {
    for (const Eigen::Vector3d& p : mesh.vertices) vertices_.push_back({p.x(), p.y(), p.z()});
    const ManifoldSoup soup = manifold_soup(mesh);
    std::vector<Vec3> positions;
    for (const std::uint32_t v : soup.vertex_of) positions.push_back(vertices_[v]);
    state_.emplace(original_of_decimation(vertices_, triangles_, tree_),
                   ArrayMesh(std::move(positions), soup.faces, soup.twin), soup.vertex_of, soup.triangle_of);
  }
  StateOf(const StateOf&) = delete;
  StateOf& operator=(const StateOf&) = delete;

  DecimationState& operator*() { return *state_; }
  const DecimationState& operator*() const { return *state_; }
  DecimationState* operator->() { return &*state_; }
  const DecimationState* operator->() const { return &*state_; }

 private:
  std::vector<Vec3> vertices_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  Bvh tree_;
  std::optional<DecimationState> state_;
};

}  // namespace meshbound::test
