// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <numeric>

#include "geometry/magnitude.h"
#include "penetration/closed_model_data.h"
#include "penetration/exact_point.h"

namespace meshbound::test {

/// A mesh of vertices at different positions as a model, closed or not.
inline ClosedModel::Data model_data(const TriangleMesh& mesh) {
  ClosedModel::Data model{Bvh(mesh)};
  model.triangles = mesh.triangles;
  model.source_triangle.resize(mesh.triangles.size());
  std::iota(model.source_triangle.begin(), model.source_triangle.end(), 0);
  const Vec3& center = model.tree.data().frame.center;
  model.lowest_bit = std::min({lowest_bit(center.x), lowest_bit(center.y), lowest_bit(center.z)});
  for (const Eigen::Vector3d& p : mesh.vertices) {
    const Vec3& v = model.positions.emplace_back(Vec3{p.x(), p.y(), p.z()});
    model.lowest_bit = std::min({model.lowest_bit, lowest_bit(v.x), lowest_bit(v.y), lowest_bit(v.z)});
    model.reach = std::max(model.reach, largest_magnitude_of(v - center));
  }
  return model;
}

}  // namespace meshbound::test
