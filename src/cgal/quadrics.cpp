// SPDX-License-Identifier: GPL-3.0-or-later
#include "cgal/quadrics.h"

#include <cmath>
#include <utility>

namespace meshbound::cgal {
namespace {

using Point = Kernel::Point_3;
using Vector = Kernel::Vector_3;

/// Of a plane through a border edge against those of the faces: CGAL's default.
constexpr double border_weight = 100;

/// Where the surface is flat the quadric is singular but for rounding, and its minimum may be anywhere: it is believed
/// within this many edge lengths only.
constexpr double longest_way = 5;

/// Costs fetched ahead for one vertex: most have about six edges, hubs thousands.
constexpr int max_fetched = 16;

/// Zero stays zero.
Vector unit(const Vector& v) {
  const double length = std::sqrt(v.squared_length());
  return length > 0 ? v / length : v;
}

}  // namespace

Quadric Quadric::of_plane(const Vector& n, const Point& p, double weight) {
  const double offset = -(n.x() * p.x() + n.y() * p.y() + n.z() * p.z());
  const double wx = weight * n.x(), wy = weight * n.y(), wz = weight * n.z();
  return {wx * n.x(), wx * n.y(),  wx * n.z(),  wy * n.y(),  wy * n.z(),
          wz * n.z(), wx * offset, wy * offset, wz * offset, weight * offset * offset};
}

Quadric& Quadric::operator+=(const Quadric& other) {
  xx += other.xx, xy += other.xy, xz += other.xz, yy += other.yy, yz += other.yz, zz += other.zz;
  x += other.x, y += other.y, z += other.z, constant += other.constant;
  return *this;
}

double Quadric::at(const Point& p) const {
  const double ax = xx * p.x() + xy * p.y() + xz * p.z(), ay = xy * p.x() + yy * p.y() + yz * p.z(),
               az = xz * p.x() + yz * p.y() + zz * p.z();
  return (ax + 2 * x) * p.x() + (ay + 2 * y) * p.y() + (az + 2 * z) * p.z() + constant;
}

/// By Cramer's rule: A is tiny and its entries are all of the same kind.
std::optional<Point> Quadric::minimum() const {
  const double c_xx = yy * zz - yz * yz, c_xy = xz * yz - xy * zz, c_xz = xy * yz - xz * yy;
  const double c_yy = xx * zz - xz * xz, c_yz = xy * xz - xx * yz, c_zz = xx * yy - xy * xy;
  const double determinant = xx * c_xx + xy * c_xy + xz * c_xz;
  if (determinant == 0) return std::nullopt;
  const double scale = -1 / determinant;
  return Point(scale * (c_xx * x + c_xy * y + c_xz * z), scale * (c_xy * x + c_yy * y + c_yz * z),
               scale * (c_xz * x + c_yz * y + c_zz * z));
}

Quadrics::Quadrics(std::vector<Quadric> of_vertex, const SurfaceMesh& mesh)
    : of_vertex_(std::move(of_vertex)), known_(mesh.num_edges()) {}

Quadrics::Quadrics(const SurfaceMesh& mesh, const IsSeamEdge& is_seam_edge)
    : of_vertex_(mesh.num_vertices()), known_(mesh.num_edges()) {
  for (const auto face : mesh.faces()) {
    const auto first = mesh.halfedge(face);
    const Point &p = mesh.point(mesh.target(first)), &q = mesh.point(mesh.target(mesh.next(first))),
                &r = mesh.point(mesh.source(first));
    const Vector normal = unit(CGAL::cross_product(q - p, r - p));
    const Quadric plane = Quadric::of_plane(normal, p, 1);
    for (const auto h : CGAL::halfedges_around_face(first, mesh)) {
      const auto source = mesh.source(h), target = mesh.target(h);
      of_vertex_[source] += plane;
      if (!mesh.is_border(mesh.edge(h)) || (is_seam_edge && is_seam_edge(source, target))) continue;
      const Vector along = mesh.point(target) - mesh.point(source);
      const Quadric wall =
          Quadric::of_plane(unit(CGAL::cross_product(along, normal)), mesh.point(target), border_weight);
      of_vertex_[source] += wall;
      of_vertex_[target] += wall;
    }
  }
}

const Quadrics::Collapse& Quadrics::of_edge(SurfaceMesh::Edge_index edge, SurfaceMesh::Vertex_index v0,
                                            SurfaceMesh::Vertex_index v1, const Point& p0, const Point& p1) {
  Collapse& known = known_[edge];
  if (!std::isnan(known.cost)) return known;
  Quadric sum = of_vertex_[v0];
  sum += of_vertex_[v1];
  const double reach = longest_way * longest_way * CGAL::squared_distance(p0, p1);
  const auto is_local = [&](const Point& p) {
    return CGAL::squared_distance(p0, p) < reach && CGAL::squared_distance(p1, p) < reach;
  };
  if (const auto minimum = sum.minimum(); minimum && is_local(*minimum)) {
    known = {*minimum, sum.at(*minimum)};
    return known;
  }
  const Point middle = CGAL::midpoint(p0, p1);
  known = {middle, sum.at(middle)};
  for (const Point& end : {p0, p1}) {
    if (const double cost = sum.at(end); cost < known.cost) known = {end, cost};
  }
  return known;
}

double Quadrics::cost(SurfaceMesh::Vertex_index v0, SurfaceMesh::Vertex_index v1, const Point& p) const {
  Quadric sum = of_vertex_[v0];
  sum += of_vertex_[v1];
  return sum.at(p);
}

void Quadrics::collapsed(SurfaceMesh::Vertex_index v0, SurfaceMesh::Vertex_index v1, SurfaceMesh::Vertex_index kept,
                         const SurfaceMesh& mesh) {
  Quadric sum = of_vertex_[v0];
  sum += of_vertex_[v1];
  of_vertex_[kept] = sum;
  for (const auto h : CGAL::halfedges_around_target(mesh.halfedge(kept), mesh)) {
    known_[mesh.edge(h)].cost = unknown;
    // CGAL is going to ask for all of these: half of the time of that is waiting for memory (igea).
    int fetched = 0;
    for (const auto around : CGAL::halfedges_around_target(mesh.opposite(h), mesh)) {
      if (++fetched > max_fetched) break;
      __builtin_prefetch(&known_[mesh.edge(around)]);
    }
  }
}

}  // namespace meshbound::cgal
