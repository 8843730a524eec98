// SPDX-License-Identifier: MIT
#include "reference/exact_intersection.h"

#include <cmath>
#include <cstddef>
#include <optional>

namespace meshbound::reference {
namespace {

ExactVector difference(const ExactVector& p, const ExactVector& q) { return {p[0] - q[0], p[1] - q[1], p[2] - q[2]}; }

mpq_class product(const ExactVector& p, const ExactVector& q) { return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]; }

ExactVector vector_product(const ExactVector& p, const ExactVector& q) {
  return {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
}

bool is_zero(const ExactVector& v) { return sgn(v[0]) == 0 && sgn(v[1]) == 0 && sgn(v[2]) == 0; }

/// The half-space against the normal.
struct HalfSpace {
  ExactVector normal;
  mpq_class limit;
  [[nodiscard]] mpq_class beyond(const ExactVector& p) const { return product(normal, p) - limit; }
};

ExactVector normal_of(const ExactPolygon& polygon) {
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    const ExactVector n = vector_product(difference(polygon[i - 1], polygon[0]), difference(polygon[i], polygon[0]));
    if (!is_zero(n)) return n;
  }
  return {0, 0, 0};
}

ExactPolygon cut(const ExactPolygon& polygon, const HalfSpace& half_space) {
  ExactPolygon result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const ExactVector &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const mpq_class at_p = half_space.beyond(p), at_q = half_space.beyond(q);
    if (sgn(at_p) <= 0) result.push_back(p);
    if (sgn(at_p) * sgn(at_q) >= 0) continue;
    const mpq_class t = at_p / (at_p - at_q);
    result.push_back({p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1]), p[2] + t * (q[2] - p[2])});
  }
  return result;
}

/// A placed convex cell.
struct Cell {
  std::vector<ExactPolygon> faces;
  std::vector<HalfSpace> half_spaces;
};

std::vector<ExactPolygon> placed_faces(const TriangleMesh& mesh, const Eigen::Isometry3d& pose) {
  std::vector<ExactPolygon> faces;
  for (const Triangle& t : mesh.triangles)
    faces.push_back({exact_image(pose, mesh.vertices[t[0]]), exact_image(pose, mesh.vertices[t[1]]),
                     exact_image(pose, mesh.vertices[t[2]])});
  return faces;
}

Cell placed_cell(const TriangleMesh& mesh, const Eigen::Isometry3d& pose) {
  Cell cell{placed_faces(mesh, pose), {}};
  for (const ExactPolygon& face : cell.faces) {
    const ExactVector n = normal_of(face);
    cell.half_spaces.push_back({n, product(n, face[0])});
  }
  return cell;
}

/// How a polygon in a cell's boundary plane is turned: 1 as the cell's face, -1 against it; 0: in no such plane.
int turn_in_boundary(const ExactPolygon& polygon, const Cell& cell) {
  const ExactVector n = normal_of(polygon);
  for (const HalfSpace& half_space : cell.half_spaces)
    if (sgn(half_space.beyond(polygon[0])) == 0 && is_zero(vector_product(n, half_space.normal)))
      return sgn(product(n, half_space.normal));
  return 0;
}

/// The part of a polygon in a cell; absent where it has no area.
std::optional<ExactPolygon> part_in(ExactPolygon polygon, const Cell& cell) {
  for (const HalfSpace& half_space : cell.half_spaces) {
    polygon = cut(polygon, half_space);
    if (polygon.size() < 3) return std::nullopt;
  }
  if (is_zero(normal_of(polygon))) return std::nullopt;
  return polygon;
}

mpq_class six_times_cone(const ExactPolygon& polygon) {
  mpq_class sum = 0;
  for (std::size_t i = 2; i < polygon.size(); ++i)
    sum += product(polygon[0], vector_product(polygon[i - 1], polygon[i]));
  return sum;
}

/// The surface of the intersection of two convex cells is what each has of the other's faces; what both have, once.
mpq_class common_content(const Cell& a, const Cell& b) {
  mpq_class sum = 0;
  for (const ExactPolygon& face : a.faces)
    if (const auto part = part_in(face, b)) sum += six_times_cone(*part);
  for (const ExactPolygon& face : b.faces)
    if (const auto part = part_in(face, a))
      if (turn_in_boundary(*part, a) != 1) sum += six_times_cone(*part);
  return sum / 6;
}

Eigen::Vector3d rounded(const ExactVector& p) { return {p[0].get_d(), p[1].get_d(), p[2].get_d()}; }

}  // namespace

ExactVector exact_image(const Eigen::Isometry3d& pose, const Eigen::Vector3d& p) {
  ExactVector image;
  for (int row = 0; row < 3; ++row) {
    mpq_class& value = image[static_cast<std::size_t>(row)];
    value = pose.translation()[row];
    for (int column = 0; column < 3; ++column) value += mpq_class(pose.linear()(row, column)) * mpq_class(p[column]);
  }
  return image;
}

mpq_class exact_common_content(const CellSolid& a, const Eigen::Isometry3d& pose_a, const CellSolid& b,
                               const Eigen::Isometry3d& pose_b) {
  std::vector<Cell> cells_b;
  for (const TriangleMesh& cell : b.cells) cells_b.push_back(placed_cell(cell, pose_b));
  mpq_class sum = 0;
  for (const TriangleMesh& mesh : a.cells) {
    const Cell cell = placed_cell(mesh, pose_a);
    for (const Cell& other : cells_b) sum += common_content(cell, other);
  }
  return sum;
}

ExactPart exact_part(const CellSolid& a, const Eigen::Isometry3d& pose_a, const CellSolid& b,
                     const Eigen::Isometry3d& pose_b) {
  std::vector<Cell> cells;
  for (const TriangleMesh& cell : b.cells) cells.push_back(placed_cell(cell, pose_b));
  ExactPart result;
  for (const ExactPolygon& face : placed_faces(a.surface, pose_a))
    for (const Cell& cell : cells)
      if (auto part = part_in(face, cell))
        (turn_in_boundary(*part, cell) == -1 ? result.contact : result.inside).push_back(std::move(*part));
  return result;
}

TriangleMesh rounded_mesh(const std::vector<ExactPolygon>& polygons) {
  TriangleMesh mesh;
  for (const ExactPolygon& polygon : polygons) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const ExactVector& p : polygon) mesh.vertices.push_back(rounded(p));
    for (std::uint32_t i = 2; i < polygon.size(); ++i) mesh.triangles.push_back({first, first + i - 1, first + i});
  }
  return mesh;
}

double area_of(const std::vector<ExactPolygon>& polygons) {
  double sum = 0;
  const TriangleMesh mesh = rounded_mesh(polygons);
  for (const Triangle& t : mesh.triangles)
    sum += (mesh.vertices[t[1]] - mesh.vertices[t[0]]).cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]).norm() / 2;
  return sum;
}

}  // namespace meshbound::reference
