// SPDX-License-Identifier: MIT
#include "distance/paper/closed_model.h"

#include <algorithm>
#include <cmath>

#include "geometry/magnitude.h"
#include "numeric/rounding.h"

namespace meshbound {
namespace {

enum class Crossing { No, Yes, Unknown };

double sum_of_magnitudes(const Vec3& v) { return std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z); }

double largest_coordinate_of(const TriangleCorners& t) {
  return std::max({largest_magnitude_of(t[0]), largest_magnitude_of(t[1]), largest_magnitude_of(t[2])});
}

/// Whether a plane with this normal has the triangles on different sides. Any normal will do, so its own rounding does
/// not matter. Each projection errs by at most 3u |n|_1 M, and as much again is left for a centroid that is rounded off
/// its triangle.
bool separates(const Vec3& normal, const TriangleCorners& p, const TriangleCorners& q, double magnitude) {
  const auto [p_min, p_max] = std::minmax({dot(normal, p[0]), dot(normal, p[1]), dot(normal, p[2])});
  const auto [q_min, q_max] = std::minmax({dot(normal, q[0]), dot(normal, q[1]), dot(normal, q[2])});
  const double margin = 16 * unit_roundoff * sum_of_magnitudes(normal) * magnitude;
  return p_min - q_max > margin || q_min - p_max > margin;
}

/// Separating axes of two triangles: the coordinate axes as the cheapest, the normals, products of edges, and for
/// coplanar ones the normals of the edges within the plane.
bool disjoint(const TriangleCorners& p, const TriangleCorners& q, double magnitude) {
  for (const Vec3& axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}})
    if (separates(axis, p, q, magnitude)) return true;
  const TriangleCorners p_edges{p[1] - p[0], p[2] - p[1], p[0] - p[2]}, q_edges{q[1] - q[0], q[2] - q[1], q[0] - q[2]};
  const Vec3 p_normal = cross(p_edges[0], p_edges[1]), q_normal = cross(q_edges[0], q_edges[1]);
  if (separates(p_normal, p, q, magnitude) || separates(q_normal, p, q, magnitude)) return true;
  for (const Vec3& e : p_edges) {
    for (const Vec3& f : q_edges)
      if (separates(cross(e, f), p, q, magnitude)) return true;
    if (separates(cross(e, p_normal), p, q, magnitude)) return true;
  }
  return std::any_of(q_edges.begin(), q_edges.end(),
                     [&](const Vec3& f) { return separates(cross(f, q_normal), p, q, magnitude); });
}

/// Side of d from the plane of a, b, c: -1 or 1, 0 where rounding leaves it open. The six products of three differences
/// carry at most 8 roundings each.
int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = b - a, v = c - a, w = d - a;
  const double value = dot(cross(u, v), w);
  const double permanent = (std::fabs(u.y * v.z) + std::fabs(u.z * v.y)) * std::fabs(w.x) +
                           (std::fabs(u.z * v.x) + std::fabs(u.x * v.z)) * std::fabs(w.y) +
                           (std::fabs(u.x * v.y) + std::fabs(u.y * v.x)) * std::fabs(w.z);
  const double error = 16 * unit_roundoff * permanent + 0x1p-1000;
  return value > error ? 1 : value < -error ? -1 : 0;
}

/// Whether the open segment from p to q passes through the inside of a triangle.
Crossing crossing(const Vec3& p, const Vec3& q, const TriangleCorners& t) {
  const int at_p = orientation(t[0], t[1], t[2], p), at_q = orientation(t[0], t[1], t[2], q);
  if (at_p * at_q > 0) return Crossing::No;
  const int around[3] = {orientation(p, q, t[0], t[1]), orientation(p, q, t[1], t[2]), orientation(p, q, t[2], t[0])};
  const auto [min, max] = std::minmax({around[0], around[1], around[2]});
  if (min < 0 && max > 0) return Crossing::No;
  const bool inside = around[0] != 0 && around[0] == around[1] && around[1] == around[2];
  return inside && at_p * at_q < 0 ? Crossing::Yes : Crossing::Unknown;
}

/// The triangles at an edge are linked in a ring: two of them, when the neighbour's neighbour is the triangle itself.
bool has_two_triangles(const Bvh::Data& data, std::uint32_t slot, std::size_t edge) {
  const std::uint32_t other = data.neighbours[slot][edge].slot;
  if (other == no_slot || other == slot) return false;
  const Triangle &t = data.corners[slot], &u = data.corners[other];
  const auto ends = std::minmax(t[edge], t[(edge + 1) % 3]);
  for (std::size_t k = 0; k < 3; ++k)
    if (std::minmax(u[k], u[(k + 1) % 3]) == ends && data.neighbours[other][k].slot == slot) return true;
  return false;
}

}  // namespace

bool is_closed(const Bvh::Data& data) {
  for (std::uint32_t slot = 0; slot < data.triangle_count(); ++slot) {
    const Triangle& t = data.corners[slot];
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return false;
    for (std::size_t edge = 0; edge < 3; ++edge)
      if (!has_two_triangles(data, slot, edge)) return false;
  }
  return true;
}

bool crosses_surface(const Bvh::Data& b, const TriangleCorners& from, const TriangleCorners& to,
                     std::span<const std::uint32_t> slots) {
  const Vec3 here = centroid(from), there = centroid(to);
  const auto corners_of = [&b](std::uint32_t slot) {
    const Triangle& t = b.corners[slot];
    return TriangleCorners{b.vertices[t[0]], b.vertices[t[1]], b.vertices[t[2]]};
  };
  bool odd = false;
  for (const std::uint32_t slot : slots) {
    const Crossing found = crossing(here, there, corners_of(slot));
    if (found == Crossing::Unknown) return false;
    odd ^= found == Crossing::Yes;
  }
  if (!odd) return false;
  const double magnitude = std::max({1.0, largest_coordinate_of(from), largest_coordinate_of(to)});
  return std::all_of(slots.begin(), slots.end(), [&](std::uint32_t slot) {
    const TriangleCorners t = corners_of(slot);
    return disjoint(from, t, magnitude) && disjoint(to, t, magnitude);
  });
}

}  // namespace meshbound
