// SPDX-License-Identifier: MIT
#include "reference/brute_force.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace meshbound::reference {
namespace {

using Eigen::Vector3d;
using Corners = std::array<Vector3d, 3>;

std::vector<Corners> all_corners(const MeshView& mesh) {
  std::vector<Corners> result;
  for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
    const Triangle t = mesh.triangle(i);
    result.push_back({mesh.vertex(t[0]), mesh.vertex(t[1]), mesh.vertex(t[2])});
  }
  return result;
}

double largest_magnitude(const std::vector<Corners>& triangles) {
  double largest = 0;
  for (const Corners& t : triangles) {
    for (const Vector3d& v : t) largest = std::max(largest, v.cwiseAbs().maxCoeff());
  }
  return largest;
}

double distance_to_segment(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
  const Vector3d ab = b - a;
  const double squared_length = ab.squaredNorm();
  const double t = squared_length > 0 ? std::clamp((p - a).dot(ab) / squared_length, 0.0, 1.0) : 0.0;
  return (p - a - t * ab).norm();
}

double distance_to_triangle(const Vector3d& p, const Corners& t) {
  const double to_edges = std::min(
      {distance_to_segment(p, t[0], t[1]), distance_to_segment(p, t[1], t[2]), distance_to_segment(p, t[2], t[0])});
  const Vector3d normal = (t[1] - t[0]).cross(t[2] - t[0]);
  const double length = normal.norm();
  if (!(length > 0)) return to_edges;
  for (std::size_t i = 0; i < 3; ++i) {
    if (normal.dot((t[(i + 1) % 3] - t[i]).cross(p - t[i])) < 0) return to_edges;
  }
  return std::min(to_edges, std::abs(normal.dot(p - t[0])) / length);
}

double distance_to_all(const Vector3d& p, const std::vector<Corners>& triangles) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Corners& t : triangles) nearest = std::min(nearest, distance_to_triangle(p, t));
  return nearest;
}

void push_quarters(const Corners& t, std::vector<Corners>& pieces) {
  const Vector3d m01 = (t[0] + t[1]) / 2, m12 = (t[1] + t[2]) / 2, m20 = (t[2] + t[0]) / 2;
  pieces.insert(pieces.end(), {{t[0], m01, m20}, {m01, t[1], m12}, {m20, m12, t[2]}, {m01, m12, m20}});
}

}  // namespace

Bounds brute_force_one_sided(const MeshView& a, const MeshView& b, double width) {
  std::vector<Corners> pieces = all_corners(a);
  const std::vector<Corners> target = all_corners(b);
  const double allowance = brute_force_allowance * std::max(largest_magnitude(pieces), largest_magnitude(target));
  double furthest = 0;
  for (const Corners& t : pieces) {
    for (const Vector3d& v : t) furthest = std::max(furthest, distance_to_all(v, target));
  }
  while (!pieces.empty()) {
    const Corners piece = pieces.back();
    pieces.pop_back();
    const Vector3d centre = (piece[0] + piece[1] + piece[2]) / 3;
    const double distance = distance_to_all(centre, target);
    furthest = std::max(furthest, distance);
    double radius = 0;
    for (const Vector3d& v : piece) radius = std::max(radius, (v - centre).norm());
    if (distance + radius > furthest + width) push_quarters(piece, pieces);
  }
  return {std::max(0.0, furthest - allowance), furthest + width + allowance};
}

Bounds brute_force_symmetric(const MeshView& a, const MeshView& b, double width) {
  const Bounds forward = brute_force_one_sided(a, b, width);
  const Bounds backward = brute_force_one_sided(b, a, width);
  return {std::max(forward.lower, backward.lower), std::max(forward.upper, backward.upper)};
}

}  // namespace meshbound::reference
