// SPDX-License-Identifier: MIT
#include "attributes/chart_surface.h"

#include <algorithm>

#include "mesh/mesh_arrays.h"
#include "numeric/no_index.h"

namespace meshbound {
namespace {

/// Barycentric coordinates of a point in the plane of a triangle; the first corner if the triangle has no area.
/// Products are of lengths divided by the longest side, so that they neither overflow nor underflow.
Eigen::Vector3d barycentric(const std::array<Eigen::Vector3d, 3>& corners, const Eigen::Vector3d& p) {
  Eigen::Vector3d u = corners[1] - corners[0], v = corners[2] - corners[0], w = p - corners[0];
  const double size = std::max(u.cwiseAbs().maxCoeff(), v.cwiseAbs().maxCoeff());
  if (!(size > 0)) return {1, 0, 0};
  u /= size, v /= size, w /= size;
  const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), uw = u.dot(w), vw = v.dot(w);
  const double determinant = uu * vv - uv * uv;
  if (!(determinant > 0)) return {1, 0, 0};
  const double second = std::clamp((vv * uw - uv * vw) / determinant, 0.0, 1.0);
  const double third = std::clamp((uu * vw - uv * uw) / determinant, 0.0, 1.0 - second);
  return {1 - second - third, second, third};
}

}  // namespace

std::size_t WeightedPoint::nearest_corner() const {
  return static_cast<std::size_t>(std::max_element(weights.begin(), weights.end()) - weights.begin());
}

ChartSurface::ChartSurface(const TriangleMesh& mesh, const MeshAttributes& attributes, NormalSeams normal_seams)
    : mesh_(mesh),
      charts_(charts(mesh, attributes, normal_seams)),
      positions_(positions_of(mesh)),
      corners_at_(mesh.vertices.size()),
      triangles_of_(charts_.count),
      trees_(charts_.count) {
  at_position_.emplace(positions_);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    triangles_of_[charts_.chart_of[t]].push_back(t);
    for (std::uint32_t k = 0; k < 3; ++k) corners_at_[charts_.first[mesh.triangles[t][k]]].push_back(3 * t + k);
  }
}

const std::vector<std::uint32_t>& ChartSurface::corners_at(const Eigen::Vector3d& p) const {
  static const std::vector<std::uint32_t> no_corners;
  const std::uint32_t v = at_position_->find({p.x(), p.y(), p.z()});
  return v == no_index ? no_corners : corners_at_[v];
}

std::array<Eigen::Vector3d, 3> ChartSurface::corners(std::uint32_t triangle) const {
  const Triangle& v = mesh_.triangles[triangle];
  return {mesh_.vertices[v[0]], mesh_.vertices[v[1]], mesh_.vertices[v[2]]};
}

WeightedPoint ChartSurface::closest(std::uint32_t chart, const Eigen::Vector3d& p) {
  if (!trees_[chart]) trees_[chart] = std::make_unique<Bvh>(mesh_of(triangles_of_[chart]));
  const SurfacePoint found = closest_point(*trees_[chart], p).point;
  const std::uint32_t triangle = triangles_of_[chart][found.triangle];
  return {triangle, barycentric(corners(triangle), found.position)};
}

TriangleMesh ChartSurface::mesh_of(const std::vector<std::uint32_t>& triangles) const {
  TriangleMesh part;
  for (const std::uint32_t t : triangles) {
    const auto first = static_cast<std::uint32_t>(part.vertices.size());
    for (const Eigen::Vector3d& p : corners(t)) part.vertices.push_back(p);
    part.triangles.push_back({first, first + 1, first + 2});
  }
  return part;
}

}  // namespace meshbound
