// SPDX-License-Identifier: MIT
#include "reference/point_triangle_cases.h"

#include <Eigen/Geometry>
#include <array>

namespace meshbound::reference {
namespace {

using Eigen::Vector3d;
using Case = PointTriangleCase;

Corners triangle(Random& random) {
  const Vector3d a = random.in_cube(), b = random.in_cube(), c = random.in_cube();
  return {a, b, c};
}

Case generic(Random& random) {
  const Corners t = triangle(random);
  return {t, 2 * random.in_cube()};
}

Vector3d inside(Random& random, const Corners& t) {
  const double u = random.uniform(0, 1), v = random.uniform(0, 1 - u);
  return t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]);
}

/// Near the surface of the triangle, at any distance from it down to rounding.
Case near_surface(Random& random, const Corners& t, double min_exponent, double largest_exponent) {
  const Vector3d on = inside(random, t);
  return {t, on + random.power_of_ten(min_exponent, largest_exponent) * random.in_cube()};
}

Case near(Random& random) { return near_surface(random, triangle(random), -20, -1); }

/// Corners almost or exactly on a line, at any ratio of height to length.
Corners sliver(Random& random) {
  const Vector3d a = random.in_cube(), b = random.in_cube();
  const Vector3d between = a + random.uniform(-0.2, 1.2) * (b - a);
  return {a, b, between + random.power_of_ten(-18, -2) * random.in_cube()};
}

/// Two corners almost or exactly in one place.
Corners needle(Random& random) {
  const Vector3d a = random.in_cube();
  const Vector3d b = a + random.power_of_ten(-18, -2) * random.in_cube();
  return {a, b, random.in_cube()};
}

Case slivers(Random& random) {
  const Corners t = sliver(random);
  return {t, random.in_cube()};
}
Case near_slivers(Random& random) { return near_surface(random, sliver(random), -18, 0); }
Case needles(Random& random) {
  const Corners t = needle(random);
  return {t, random.in_cube()};
}
Case near_needles(Random& random) { return near_surface(random, needle(random), -18, 0); }

Case zero_area(Random& random) {
  const Vector3d a = random.in_cube(), b = random.in_cube();
  const std::array<Corners, 4> shapes = {Corners{a, a, a}, Corners{a, b, b}, Corners{a, b, a},
                                         Corners{a, b, a + 0.5 * (b - a)}};
  const Corners& t = shapes[static_cast<std::size_t>(random.below(4))];
  return {t, random.in_cube()};
}

/// Small integers hit every tie: coplanar and coincident points, bisectors, corners, edges, collinear corners.
Case integer_grid(Random& random) {
  const auto grid = [&random] {
    const int x = random.below(4), y = random.below(4), z = random.below(2);
    return Vector3d(x, y, z);
  };
  const Vector3d a = grid(), b = grid(), c = grid();
  return {{a, b, c}, grid()};
}

/// The query in the plane of the triangle, exactly: a plane z = constant, coordinates permuted.
Case coplanar(Random& random) {
  Case c = generic(random);
  const int axis = random.below(3);
  const double height = random.uniform(-1, 1);
  for (Vector3d& corner : c.triangle) corner[axis] = height;
  c.query[axis] = height;
  return c;
}

/// The query on the triangle, exactly or as nearly as doubles allow: a corner, the middle of an edge, a point inside.
Case coincident(Random& random) {
  const Corners t = triangle(random);
  const std::array<Vector3d, 4> places = {t[0], 0.5 * (t[0] + t[1]), 0.25 * t[0] + 0.75 * t[2], inside(random, t)};
  return {t, places[static_cast<std::size_t>(random.below(4))]};
}

/// On the planes through corners and middles of edges where the closest feature changes.
Case region_boundaries(Random& random) {
  const Corners t = triangle(random);
  const Vector3d normal = (t[1] - t[0]).cross(t[2] - t[0]);
  const Vector3d outward = (t[1] - t[0]).cross(normal);
  const std::array<Vector3d, 3> bases = {t[0], 0.5 * (t[0] + t[1]), t[1]};
  const Vector3d base = bases[static_cast<std::size_t>(random.below(3))];
  const double up = random.below(2) * random.uniform(-2, 2), out = random.below(2) * random.uniform(-1, 1);
  return {t, base + up * normal + out * outward};
}

/// On the line or plane of points equally far from two edges, and from two corners.
Case bisectors(Random& random) {
  const Corners t = triangle(random);
  const Vector3d along = (t[1] - t[0]).normalized() + (t[2] - t[0]).normalized();
  const Vector3d normal = (t[1] - t[0]).cross(t[2] - t[0]);
  const Vector3d between_corners = 0.5 * (t[1] + t[2]) + random.uniform(-2, 2) * normal.cross(t[2] - t[1]);
  const Vector3d between_edges = t[0] + random.uniform(-2, 2) * along;
  const Vector3d base = random.below(2) == 0 ? between_corners : between_edges;
  return {t, base + random.below(2) * random.uniform(-1, 1) * normal};
}

Case scaled(Case c, double scale) {
  for (Vector3d& corner : c.triangle) corner *= scale;
  c.query *= scale;
  return c;
}

Case any_scale(Random& random) {
  const Case c = generic(random);
  return scaled(c, random.power_of_ten(-160, 155));
}
Case slivers_of_any_scale(Random& random) {
  const Case c = near_slivers(random);
  return scaled(c, random.power_of_ten(-160, 155));
}

Case query_of_smaller_scale(Random& random) {
  Case c = generic(random);
  c.query *= random.power_of_ten(-30, 0);
  return scaled(c, random.power_of_ten(-160, 155));
}
Case query_of_larger_scale(Random& random) {
  Case c = generic(random);
  c.query *= random.power_of_ten(0, 55);
  return scaled(c, random.power_of_ten(-160, 100));
}

Case moved(Case c, const Vector3d& offset) {
  for (Vector3d& corner : c.triangle) corner += offset;
  c.query += offset;
  return c;
}

Vector3d large_offset(Random& random) {
  const double size = random.power_of_ten(6, 12), x = random.sign(), y = random.sign();
  return size * Vector3d(x, y, random.uniform(-1, 1));
}

Case large_offsets(Random& random) {
  const Case c = generic(random);
  return moved(c, large_offset(random));
}
Case needles_at_large_offsets(Random& random) {
  const Case c = near_needles(random);
  return moved(c, large_offset(random));
}
Case large_offsets_of_any_scale(Random& random) {
  const Case c = large_offsets(random);
  return scaled(c, random.power_of_ten(-160, 140));
}

Case subnormal(Random& random) {
  const Case c = generic(random);
  return scaled(c, random.power_of_ten(-322, -300));
}
Case subnormal_grid(Random& random) {
  const Case c = integer_grid(random);
  return scaled(c, std::numeric_limits<double>::denorm_min());
}

}  // namespace

const std::vector<CaseFamily>& case_families() {
  static const std::vector<CaseFamily> families = {
      {"generic", generic, 20000, width_of_plain_cases},
      {"near_the_surface", near, 10000, width_of_thin_cases},
      {"slivers", slivers, 8000, width_of_thin_cases},
      {"near_slivers", near_slivers, 8000, width_of_thin_cases},
      {"needles", needles, 6000, width_of_thin_cases},
      {"near_needles", near_needles, 6000, width_of_thin_cases},
      {"zero_area", zero_area, 4000, width_of_thin_cases},
      {"integer_grid", integer_grid, 8000, width_of_plain_cases},
      {"coplanar", coplanar, 4000, width_of_plain_cases},
      {"coincident", coincident, 4000, width_of_thin_cases},
      {"region_boundaries", region_boundaries, 6000, width_of_thin_cases},
      {"bisectors", bisectors, 4000, width_of_thin_cases},
      {"any_scale", any_scale, 4000, width_of_plain_cases},
      {"slivers_of_any_scale", slivers_of_any_scale, 4000, width_of_thin_cases},
      {"query_of_smaller_scale", query_of_smaller_scale, 3000, width_of_plain_cases},
      {"query_of_larger_scale", query_of_larger_scale, 3000, width_of_far_cases},
      {"large_offsets", large_offsets, 4000, width_of_plain_cases},
      {"needles_at_large_offsets", needles_at_large_offsets, 3000, width_of_thin_cases},
      {"large_offsets_of_any_scale", large_offsets_of_any_scale, 3000, width_of_plain_cases},
      {"subnormal", subnormal, 2000, width_of_plain_cases},
      {"subnormal_grid", subnormal_grid, 1000, width_of_plain_cases},
  };
  return families;
}

}  // namespace meshbound::reference
