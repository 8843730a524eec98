// SPDX-License-Identifier: MIT
#include "attributes/chart_surface.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mesh/mesh_arrays.h"
#include "numeric/no_index.h"

namespace meshbound {
namespace {

/// Barycentric coordinates of a point on a triangle whose corners lie on a line: those between the corners before and
/// behind it.
Eigen::Vector3d weights_on_line(const std::array<Eigen::Vector3d, 3>& corners, const Eigen::Vector3d& p) {
  const auto far_from_first = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return (a - corners[0]).stableNorm() < (b - corners[0]).stableNorm();
  };
  const Eigen::Vector3d end = std::max(corners[1], corners[2], far_from_first);
  const Eigen::Vector3d line = (end - corners[0]).stableNormalized();
  const auto place = [&](const Eigen::Vector3d& q) { return (q - corners[0]).dot(line); };
  Eigen::Index before = 0, behind = 0;
  double low = -HUGE_VAL, high = HUGE_VAL;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double at = place(corners[static_cast<std::size_t>(k)]);
    if (at <= place(p) && at > low) low = at, before = k;
    if (at >= place(p) && at < high) high = at, behind = k;
  }
  if (low == -HUGE_VAL) before = behind;
  const double share = low > -HUGE_VAL && high < HUGE_VAL && high > low ? (place(p) - low) / (high - low) : 0;
  return (1 - share) * Eigen::Vector3d::Unit(before) + share * Eigen::Vector3d::Unit(behind);
}

/// Barycentric coordinates of a point in the plane of a triangle.
/// Products are of lengths divided by the longest side, so that they neither overflow nor underflow.
Eigen::Vector3d barycentric(const std::array<Eigen::Vector3d, 3>& corners, const Eigen::Vector3d& p) {
  Eigen::Vector3d u = corners[1] - corners[0], v = corners[2] - corners[0], w = p - corners[0];
  const double size = std::max(u.cwiseAbs().maxCoeff(), v.cwiseAbs().maxCoeff());
  if (!(size > 0)) return {1, 0, 0};  // all corners at one place
  u /= size, v /= size, w /= size;
  const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), uw = u.dot(w), vw = v.dot(w);
  const double determinant = uu * vv - uv * uv;
  if (!(determinant > 0)) return weights_on_line(corners, p);
  const double second = std::clamp((vv * uw - uv * vw) / determinant, 0.0, 1.0);
  const double third = std::clamp((uu * vw - uv * uw) / determinant, 0.0, 1.0 - second);
  return {1 - second - third, second, third};
}

}  // namespace

std::size_t WeightedPoint::nearest_corner() const {
  return static_cast<std::size_t>(std::max_element(weights.begin(), weights.end()) - weights.begin());
}

ChartSurface::CornersAt::CornersAt(const TriangleMesh& mesh, const ChartPartition& charts)
    : positions(positions_of(mesh)), table(positions), corners(mesh.vertices.size(), [&](const auto& add) {
        for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
          for (std::uint32_t k = 0; k < 3 && !charts.layers.repeats(t); ++k)
            add(charts.first[mesh.triangles[t][k]], 3 * t + k);
      }) {}

ChartSurface::ChartSurface(const TriangleMesh& mesh, ChartPartition charts)
    : mesh_(mesh),
      charts_(std::move(charts)),
      triangles_of_(charts_.count,
                    [this](const auto& add) {
                      for (std::uint32_t t = 0; t < charts_.chart_of.size(); ++t)
                        if (!charts_.layers.repeats(t)) add(charts_.chart_of[t], t);
                    }),
      trees_(charts_.count),
      number_in_chart_(mesh.vertices.size()) {}

std::span<const std::uint32_t> ChartSurface::corners_at(const Eigen::Vector3d& p) {
  if (!corners_at_) corners_at_.emplace(mesh_, charts_);
  const std::uint32_t v = corners_at_->table.find({p.x(), p.y(), p.z()});
  if (v == no_index) return {};
  return corners_at_->corners[v];
}

std::array<Eigen::Vector3d, 3> ChartSurface::corners(std::uint32_t triangle) const {
  const Triangle& v = mesh_.triangles[triangle];
  return {mesh_.vertices[v[0]], mesh_.vertices[v[1]], mesh_.vertices[v[2]]};
}

WeightedPoint ChartSurface::closest(std::uint32_t chart, const Eigen::Vector3d& p) {
  if (!trees_[chart]) trees_[chart] = std::make_unique<Bvh>(mesh_of(chart));
  const SurfacePoint found = closest_point(*trees_[chart], p).point;
  const std::uint32_t triangle = triangles_of_[chart][found.triangle];
  return {triangle, barycentric(corners(triangle), found.position)};
}

TriangleMesh ChartSurface::mesh_of(std::uint32_t chart) {
  TriangleMesh part;
  number_in_chart_.clear();
  for (const std::uint32_t t : triangles_of_[chart]) part.triangles.push_back(number_in_chart_(mesh_.triangles[t]));
  for (const std::uint32_t v : number_in_chart_.used()) part.vertices.push_back(mesh_.vertices[v]);
  return part;
}

}  // namespace meshbound
