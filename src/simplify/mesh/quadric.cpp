// SPDX-License-Identifier: MIT
#include "simplify/mesh/quadric.h"

#include <cmath>

#include "geometry/unit.h"
#include "numeric/no_index.h"

namespace meshbound {
namespace {

/// Weight of a plane through a border edge, where that of a face is 1: CGAL's default.
constexpr double border_weight = 100;

/// Where the surface is flat the quadric is singular but for rounding, and its minimum may be anywhere: it is believed
/// within this many edge lengths only.
constexpr double max_way = 5;

/// Perpendicular to a face, twice as long as its area.
Vec3 doubled_area(const ArrayMesh& mesh, std::uint32_t face) {
  const auto [p, q, r] = mesh.triangle(face);
  return cross(q - p, r - p);
}

double mean_doubled_area(const ArrayMesh& mesh) {
  double sum = 0, count = 0;
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    if (mesh.is_removed(f)) continue;
    sum += length(doubled_area(mesh, f));
    ++count;
  }
  return sum / count;
}

}  // namespace

Quadric Quadric::of_plane(Vec3 n, Vec3 p, double weight) {
  const double offset = -dot(n, p);
  const double wx = weight * n.x, wy = weight * n.y, wz = weight * n.z;
  return {wx * n.x, wx * n.y,    wx * n.z,    wy * n.y,    wy * n.z,
          wz * n.z, wx * offset, wy * offset, wz * offset, weight * offset * offset};
}

Quadric& Quadric::operator+=(const Quadric& o) {
  xx += o.xx, xy += o.xy, xz += o.xz, yy += o.yy, yz += o.yz, zz += o.zz;
  x += o.x, y += o.y, z += o.z, constant += o.constant;
  return *this;
}

Quadric& Quadric::operator-=(const Quadric& o) {
  xx -= o.xx, xy -= o.xy, xz -= o.xz, yy -= o.yy, yz -= o.yz, zz -= o.zz;
  x -= o.x, y -= o.y, z -= o.z, constant -= o.constant;
  return *this;
}

double Quadric::at(Vec3 p) const {
  const double ax = xx * p.x + xy * p.y + xz * p.z, ay = xy * p.x + yy * p.y + yz * p.z,
               az = xz * p.x + yz * p.y + zz * p.z;
  return (ax + 2 * x) * p.x + (ay + 2 * y) * p.y + (az + 2 * z) * p.z + constant;
}

/// By Cramer's rule: A is tiny and its entries are all of the same kind.
std::optional<Vec3> Quadric::minimum() const {
  const double c_xx = yy * zz - yz * yz, c_xy = xz * yz - xy * zz, c_xz = xy * yz - xz * yy;
  const double c_yy = xx * zz - xz * xz, c_yz = xy * xz - xx * yz, c_zz = xx * yy - xy * xy;
  const double determinant = xx * c_xx + xy * c_xy + xz * c_xz;
  if (determinant == 0) return std::nullopt;
  const double scale = -1 / determinant;
  return Vec3{scale * (c_xx * x + c_xy * y + c_xz * z), scale * (c_xy * x + c_yy * y + c_yz * z),
              scale * (c_xz * x + c_yz * y + c_zz * z)};
}

std::vector<Quadric> vertex_quadrics(const ArrayMesh& mesh, PlaneWeights weights) {
  std::vector<Quadric> quadrics(mesh.vertex_count());
  const double mean = weights == PlaneWeights::Area ? mean_doubled_area(mesh) : 0;
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    if (mesh.is_removed(f)) continue;
    const Vec3 area = doubled_area(mesh, f), normal = unit(area);
    const double weight = mean > 0 ? length(area) / mean : 1;
    const Quadric plane = Quadric::of_plane(normal, mesh.position(mesh.start(3 * f)), weight);
    for (Corner c = 3 * f; c < 3 * f + 3; ++c) {
      quadrics[mesh.start(c)] += plane;
      if (mesh.twin(c) != no_index) continue;
      const Vec3 from = mesh.position(mesh.start(c)), to = mesh.position(mesh.end(c));
      const double border = mean > 0 ? squared_length(to - from) / mean : border_weight;
      const Quadric wall = Quadric::of_plane(unit(cross(to - from, normal)), to, border);
      quadrics[mesh.start(c)] += wall;
      quadrics[mesh.end(c)] += wall;
    }
  }
  return quadrics;
}

Placement best_placement(const Quadric& of_p, const Quadric& of_q, Vec3 p, Vec3 q) {
  Quadric sum = of_p;
  sum += of_q;
  const double reach = max_way * max_way * squared_length(q - p);
  const auto is_local = [&](Vec3 at) { return squared_length(at - p) < reach && squared_length(at - q) < reach; };
  if (const auto minimum = sum.minimum(); minimum && is_local(*minimum)) return {*minimum, sum.at(*minimum)};
  const Vec3 middle = 0.5 * (p + q);
  Placement best{middle, sum.at(middle)};
  for (const Vec3 end : {p, q}) {
    if (const double cost = sum.at(end); cost < best.cost) best = {end, cost};
  }
  return best;
}

}  // namespace meshbound
