// SPDX-License-Identifier: GPL-3.0-or-later
#include "cgal/refinement.h"

#include <cmath>

namespace meshbound::cgal {
namespace {

/// A shaken vertex goes this share of the way to the middle of its neighbours, and up to a share of an edge beside.
/// Without, or in every third round only, the search ends in the next local minimum, with 5 to 8% more faces.
constexpr double way_to_middle = 0.2;
constexpr double jitter = 0.3;
/// Where that breaks the bound, a shorter way may do.
constexpr int shake_attempts = 3;
constexpr double shorter_way = 0.4;
/// On a crease nearly every way does, but along it: up to a share of a random edge.
constexpr int slide_attempts = 2;
constexpr double longest_slide = 0.4;

/// Of the edges are turned whatever that gains: on plane faces every triangulation is as good as another, but not every
/// one has room for the next collapse (fandisk: 3% fewer faces; twice or three times as many gain nothing more).
constexpr double turned_share = 0.1;

Eigen::Vector3d to_eigen(const Kernel::Point_3& p) { return {p.x(), p.y(), p.z()}; }

}  // namespace

void Refinement::round() {
  shake();
  turn();
  flip();
  relocate();
  flip();
}

double Refinement::mean_edge(SurfaceMesh::Vertex_index v) const {
  double sum = 0;
  int count = 0;
  for (const auto h : CGAL::halfedges_around_target(mesh_.halfedge(v), mesh_)) {
    sum += (to_eigen(mesh_.point(mesh_.source(h))) - to_eigen(mesh_.point(v))).norm();
    ++count;
  }
  return sum / count;
}

void Refinement::relocate() {
  for (const auto v : mesh_.vertices()) {
    if (mesh_.is_isolated(v)) continue;
    if (stop_()) return;
    monitor_.relocate_vertex(v);
  }
}

void Refinement::flip() {
  for (const auto e : mesh_.edges()) {
    if (stop_()) return;
    monitor_.flip_edge(e);
  }
}

void Refinement::turn() {
  for (const auto e : mesh_.edges()) {
    if (stop_()) return;
    if (std::abs(uniform()) < turned_share) monitor_.turn_edge(e);
  }
}

double Refinement::uniform() { return static_cast<double>(random_() >> 11) * 0x1p-52 - 1; }

void Refinement::shake() {
  for (const auto v : mesh_.vertices()) {
    if (mesh_.is_isolated(v) || mesh_.is_border(v) || monitor_.is_locked(v)) continue;
    if (stop_()) return;
    shake(v);
  }
}

void Refinement::shake(SurfaceMesh::Vertex_index v) {
  const Eigen::Vector3d p = to_eigen(mesh_.point(v));
  Eigen::Vector3d middle = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::Zero();
  for (const auto h : CGAL::halfedges_around_target(mesh_.halfedge(v), mesh_)) {
    const Eigen::Vector3d q = to_eigen(mesh_.point(mesh_.source(h)));
    middle += q / mesh_.degree(v);
    normal += (to_eigen(mesh_.point(mesh_.target(mesh_.next(h)))) - p).cross(q - p);
  }
  const double length = normal.norm();
  if (!(length > 0)) return;
  normal /= length;
  const Eigen::Vector3d aside(uniform(), uniform(), uniform());
  Eigen::Vector3d way = way_to_middle * (middle - p) + jitter * mean_edge(v) * aside;
  way -= way.dot(normal) * normal;
  const auto move = [&](const Eigen::Vector3d& by) {
    const Eigen::Vector3d q = p + by;
    return monitor_.move_vertex(v, Kernel::Point_3(q.x(), q.y(), q.z()));
  };
  for (int attempt = 0; attempt < shake_attempts; ++attempt, way *= shorter_way) {
    if (move(way)) return;
  }
  for (int attempt = 0; attempt < slide_attempts; ++attempt) {
    auto h = mesh_.halfedge(v);
    for (auto skip = random_() % mesh_.degree(v); skip > 0; --skip) h = mesh_.opposite(mesh_.next(h));
    if (move(longest_slide * std::abs(uniform()) * (to_eigen(mesh_.point(mesh_.source(h))) - p))) return;
  }
}

}  // namespace meshbound::cgal
