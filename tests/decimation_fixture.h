// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <vector>

#include "decimation_states.h"
#include "meshbound/triangle_mesh.h"
#include "numeric/no_index.h"

namespace meshbound {

/// The state of a decimation at a tolerance, and the mesh that is left of it.
class DecimationFixture {
 public:
  DecimationFixture(const TriangleMesh& mesh, double tolerance) : state_of_(mesh), state(*state_of_) {
    state.grow_tolerance(tolerance);
    state.set_samples(tolerance);
  }
  DecimationFixture(const DecimationFixture&) = delete;
  DecimationFixture& operator=(const DecimationFixture&) = delete;

  /// What is left.
  [[nodiscard]] TriangleMesh result() const {
    TriangleMesh out;
    std::vector<std::uint32_t> index(state.mesh.vertex_count(), no_index);
    for (std::uint32_t f = 0; f < state.mesh.face_count(); ++f) {
      if (state.mesh.is_removed(f)) continue;
      Triangle& triangle = out.triangles.emplace_back();
      for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t v = state.mesh.vertex(3 * f + k);
        if (index[v] == no_index) {
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
  test::StateOf state_of_;

 public:
  DecimationState& state;
};

}  // namespace meshbound
