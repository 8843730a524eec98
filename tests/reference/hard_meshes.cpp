// SPDX-License-Identifier: MIT
#include "reference/hard_meshes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "reference/small_meshes.h"

namespace meshbound::reference {
namespace {

using Eigen::Vector3d;

std::uint32_t add_vertex(TriangleMesh& mesh, const Vector3d& position) {
  mesh.vertices.push_back(position);
  return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
}

/// From 1 down to 2^-45.
double small_factor(Choices& choices) { return std::ldexp(1.0, -3 * static_cast<int>(choices.below(16))); }

/// A strip of squares of two triangles each over a parallelogram; one vertex in eight stands anywhere instead.
TriangleMesh patch(Choices& choices, unsigned triangles) {
  const Vector3d corner = choices.point(), along = choices.point(), across = choices.point();
  const unsigned squares = (triangles + 1) / 2, rows = 1 + choices.below(3);
  const unsigned columns = std::max(1U, squares / rows);
  TriangleMesh mesh;
  for (unsigned j = 0; j <= rows; ++j) {
    for (unsigned i = 0; i <= columns; ++i) {
      const bool is_free = choices.below(8) == 7;
      mesh.vertices.push_back(is_free ? choices.point() : Vector3d(corner + i * along + j * across));
    }
  }
  for (unsigned j = 0; j < rows; ++j) {
    for (unsigned i = 0; i < columns; ++i) {
      const std::uint32_t a = j * (columns + 1) + i, b = a + 1, c = b + columns + 1, d = c - 1;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  }
  mesh.triangles.resize(std::min<std::size_t>(mesh.triangles.size(), triangles));
  return mesh;
}

/// Points of a ring around the hub, or anywhere.
Vector3d rim_point(Choices& choices, bool in_ring, unsigned i, unsigned count) {
  if (!in_ring) return choices.point();
  const double angle = 2 * std::numbers::pi * i / count;
  return {std::cos(angle), std::sin(angle), 0};
}

TriangleMesh hub(Choices& choices, unsigned triangles) {
  enum Kind { ClosedFan, OpenFan, Star, AroundAnEdge };
  const unsigned kind = choices.below(4);
  const bool in_ring = choices.below(2) == 0;
  TriangleMesh mesh;
  const std::uint32_t centre = add_vertex(mesh, choices.point());
  const std::uint32_t end = kind == AroundAnEdge ? add_vertex(mesh, choices.point()) : centre;
  const unsigned rim = kind == Star ? 2 * triangles : kind == OpenFan ? triangles + 1 : triangles;
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (unsigned i = 0; i < rim; ++i) add_vertex(mesh, rim_point(choices, in_ring, i, rim));
  for (unsigned i = 0; i < triangles; ++i) {
    const std::uint32_t from = first + (kind == Star ? 2 * i : i);
    if (kind == AroundAnEdge)
      mesh.triangles.push_back({centre, end, from});
    else
      mesh.triangles.push_back({centre, from, first + (from + 1 - first) % rim});
  }
  return mesh;
}

TriangleMesh layers(Choices& choices, unsigned triangles) {
  const Vector3d corner = choices.point(), along = choices.point(), across = choices.point();
  const Vector3d step = small_factor(choices) * choices.point();
  TriangleMesh mesh;
  for (unsigned i = 0; i < triangles; ++i) {
    const double layer = choices.below(3);
    const auto corner_of_triangle = [&] {
      const double u = choices.below(9) / 4.0 - 1, v = choices.below(9) / 4.0 - 1;
      return add_vertex(mesh, corner + u * along + v * across + layer * step);
    };
    const std::uint32_t a = corner_of_triangle(), b = corner_of_triangle(), c = corner_of_triangle();
    mesh.triangles.push_back({a, b, c});
  }
  return mesh;
}

TriangleMesh sheets(Choices& choices, unsigned triangles) {
  const unsigned copies = 2 + choices.below(2);
  const TriangleMesh sheet = patch(choices, std::max(1U, triangles / copies));
  const Vector3d step = small_factor(choices) * choices.point();
  TriangleMesh mesh = moved(sheet, -step);
  for (unsigned i = 1; i < copies; ++i) mesh = both(mesh, moved(sheet, i == 1 ? step : Vector3d(3 * step)));
  return mesh;
}

TriangleMesh needle_stack(Choices& choices, unsigned triangles) {
  const Vector3d from = choices.point(), along = choices.point();
  const double thickness = small_factor(choices);
  TriangleMesh mesh;
  for (unsigned i = 0; i < triangles; ++i) {
    const Vector3d beside = thickness * choices.point();
    const bool starts_beside = choices.below(2) == 0;
    const std::uint32_t a = add_vertex(mesh, starts_beside ? Vector3d(from + beside) : from);
    const std::uint32_t b = add_vertex(mesh, from + along), c = add_vertex(mesh, from + along + beside);
    mesh.triangles.push_back({a, b, c});
  }
  return mesh;
}

}  // namespace

TriangleMesh unwelded(const TriangleMesh& mesh) {
  std::vector<std::array<Vector3d, 3>> triangles;
  for (const auto& [a, b, c] : mesh.triangles)
    triangles.push_back({mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]});
  return soup(triangles);
}

TriangleMesh with_seams(const TriangleMesh& mesh, Choices& choices) {
  TriangleMesh cut = mesh;
  for (Triangle& triangle : cut.triangles) {
    for (std::uint32_t& corner : triangle) {
      if (choices.below(3) != 0) continue;
      const Vector3d at = mesh.vertices[corner];
      corner = add_vertex(cut, at.unaryExpr([](double x) { return x == 0 ? -0.0 : x; }));
    }
  }
  return cut;
}

TriangleMesh hard_mesh(HardShape shape, Choices& choices, unsigned triangles) {
  const unsigned count = std::max(1U, triangles);
  switch (shape) {
    case HardShape::Unwelded:
      return unwelded(patch(choices, count));
    case HardShape::Hub:
      return choices.below(3) == 0 ? unwelded(hub(choices, count)) : hub(choices, count);
    case HardShape::Seams:
      return with_seams(patch(choices, count), choices);
    case HardShape::Layers:
      return layers(choices, count);
    case HardShape::Sheets:
      return sheets(choices, count);
    case HardShape::NeedleStack:
      break;
  }
  return needle_stack(choices, count);
}

}  // namespace meshbound::reference
