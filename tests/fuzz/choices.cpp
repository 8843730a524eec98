// SPDX-License-Identifier: MIT
#include "fuzz/choices.h"

#include <cmath>

namespace meshbound::fuzz {

Eigen::Vector3d Source::point() {
  const double x = coordinate(kind_), y = coordinate(kind_), z = coordinate(kind_);
  return {x, y, z};
}

double Source::coordinate(unsigned kind) {
  switch (kind % 4) {
    case 0:
      return take<double>();
    case 1:
      return static_cast<double>(take<float>());
    case 2:
      return take<std::int8_t>() / 8.0;
    default:
      const int mantissa = take<std::int8_t>();
      return std::ldexp(mantissa, 8 * take<std::int8_t>());
  }
}

TriangleMesh Source::mesh(unsigned kind, const TriangleMesh* other) {
  constexpr unsigned soups = 144, max_hard_triangles = 12, variants = 2;
  set_kind(kind);
  const unsigned shape = take<std::uint8_t>();
  if (shape < soups) return small_soup(shape);
  const unsigned chosen = below(other != nullptr ? reference::hard_shapes + variants : reference::hard_shapes);
  if (chosen == reference::hard_shapes) return with_seams(*other, *this);
  if (chosen > reference::hard_shapes) return moved_a_little(*other);
  return hard_mesh(static_cast<reference::HardShape>(chosen), *this, 1 + shape % max_hard_triangles);
}

TriangleMesh Source::small_soup(unsigned shape) {
  TriangleMesh mesh;
  const unsigned vertices = 1 + shape % 8, triangles = 1 + shape / 8 % 6;
  for (unsigned i = 0; i < vertices; ++i) mesh.vertices.push_back(point());
  for (unsigned i = 0; i < triangles; ++i) {
    const std::uint32_t a = take<std::uint8_t>(), b = take<std::uint8_t>(), c = take<std::uint8_t>();
    mesh.triangles.push_back({a % vertices, b % vertices, c % vertices});
  }
  return mesh;
}

TriangleMesh Source::moved_a_little(TriangleMesh mesh) {
  const double factor = std::ldexp(1.0, -static_cast<int>(below(64)));
  for (Eigen::Vector3d& vertex : mesh.vertices)
    if (below(2) == 0) vertex += factor * point();
  return mesh;
}

}  // namespace meshbound::fuzz
