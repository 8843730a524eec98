// SPDX-License-Identifier: MIT
#include "distance/shortcuts/corresponding.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "numeric/rounding.h"

namespace meshbound {
namespace {

/// Bounds of squared lengths whose computation neither underflows nor overflows.
constexpr double min_squared = 0x1p-960, max_squared = 0x1p960;

bool is_exact_enough(double squared) { return squared > min_squared && squared < max_squared; }

/// An upper bound of the length of a difference of two points, exact for 0. The coordinates carry u each, the sum of
/// their squares 3u more, its root half of that and u: less than 8u. Where squares would underflow or overflow, the sum
/// of the coordinates' magnitudes is taken.
double length_up(const Eigen::Vector3d& difference, double squared) {
  const double norm = is_exact_enough(squared) ? std::sqrt(squared) : difference.lpNorm<1>();
  return norm > 0 ? next_up(norm * (1 + 8 * unit_roundoff)) : 0;
}

/// Corner k of a triangle of A corresponds to corner pairing[k] of that of B.
using Pairing = std::array<std::uint8_t, 3>;
constexpr std::array<Pairing, 6> pairings{{{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};

/// The corners that are furthest apart so far.
struct Furthest {
  double squared = min_squared;  ///< as computed, of those that are exact enough
  double distance = 0;
  std::uint32_t triangle = 0, corner_a = 0, corner_b = 0;
};

/// Takes a pair of triangles into account; false when no pairing of their corners is within the limit.
bool include(const MeshView& a, const MeshView& b, std::uint32_t triangle, double limit, Furthest& furthest) {
  const Triangle t = a.triangle(triangle), u = b.triangle(triangle);
  for (const Pairing& pairing : pairings) {
    Furthest with = furthest;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d difference = a.vertex(t[k]) - b.vertex(u[pairing[k]]);
      const double squared = difference.squaredNorm();
      const bool exact = is_exact_enough(squared);
      if (exact && squared <= with.squared) continue;
      const double distance = length_up(difference, squared);
      if (distance > with.distance) with = {exact ? squared : with.squared, distance, triangle, k, pairing[k]};
    }
    if (!(with.distance <= limit)) continue;
    furthest = with;
    return true;
  }
  return false;
}

/// The triangles of a mesh with a point within `reach` of p in each coordinate; all others are further than that.
struct Vicinity {
  TriangleMesh mesh;
  std::vector<std::uint32_t> source;  ///< by its triangles: index in the whole mesh
};

Vicinity vicinity(const MeshView& mesh, const Eigen::Vector3d& p, double reach) {
  const Eigen::Array3d low = (p.array() - reach).unaryExpr(&next_down), high = (p.array() + reach).unaryExpr(&next_up);
  // By vertex, bits 0-2: below `low` in that coordinate, 3-5: above `high`. A triangle whose corners share a bit is
  // not near.
  std::vector<std::uint8_t> beyond(mesh.vertex_count());
  for (std::size_t v = 0; v < beyond.size(); ++v) {
    const Eigen::Array3d x = mesh.vertex(v);
    unsigned bits = 0;
    for (int axis = 0; axis < 3; ++axis)
      bits |= (x[axis] < low[axis] ? 1U : 0U) << axis | (x[axis] > high[axis] ? 8U : 0U) << axis;
    beyond[v] = static_cast<std::uint8_t>(bits);
  }
  Vicinity near;
  for (std::uint32_t i = 0; i < mesh.triangle_count(); ++i) {
    const Triangle t = mesh.triangle(i);
    if ((beyond[t[0]] & beyond[t[1]] & beyond[t[2]]) != 0) continue;
    const auto first = static_cast<std::uint32_t>(near.mesh.vertices.size());
    for (const std::uint32_t v : t) near.mesh.vertices.push_back(mesh.vertex(v));
    near.mesh.triangles.push_back({first, first + 1, first + 2});
    near.source.push_back(i);
  }
  return near;
}

/// One direction: the furthest corner is measured against the triangles around it.
OneSidedDistance from_corner(const MeshView& from, const MeshView& to, const Furthest& furthest, std::uint32_t corner) {
  const Eigen::Vector3d p = from.vertex(from.triangle(furthest.triangle)[corner]);
  // Twice the distance of a point that is known to be on `to`: the closest point is inside, whatever the rounding.
  const Vicinity near = vicinity(to, p, 2 * furthest.distance);
  const TriangleMesh point{{p}, {{0, 0, 0}}};
  const BvhOptions one_thread{1};
  const Bvh here(point, one_thread), there(near.mesh, one_thread);
  DistanceOptions options;
  options.error_bound = 0;
  options.threads = 1;
  OneSidedDistance result = one_sided_hausdorff_distance(here, there, options);
  result.bounds.lower = std::min(result.bounds.lower, furthest.distance);
  result.bounds.upper = furthest.distance;
  result.outcome = Outcome::Converged;
  result.witness.from.triangle = furthest.triangle;
  result.witness.nearest.triangle = near.source[result.witness.nearest.triangle];
  result.stats.triangles = result.stats.culled_by_vertices = from.triangle_count();
  result.stats.culled_on_a_percent = 100;
  result.stats.walked = 0;
  return result;
}

}  // namespace

std::optional<HausdorffDistance> distance_of_corresponding(const MeshView& a, const MeshView& b, double limit) {
  if (a.triangle_count() != b.triangle_count()) return std::nullopt;
  Furthest furthest;
  for (std::uint32_t i = 0; i < a.triangle_count(); ++i)
    if (!include(a, b, i, limit, furthest)) return std::nullopt;
  HausdorffDistance result;
  result.a_to_b = from_corner(a, b, furthest, furthest.corner_a);
  result.b_to_a = from_corner(b, a, furthest, furthest.corner_b);
  result.bounds = {std::max(result.a_to_b.bounds.lower, result.b_to_a.bounds.lower), furthest.distance};
  return result;
}

}  // namespace meshbound
