// SPDX-License-Identifier: MIT
#include "texture/triangle_bounds.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "geometry/same_triangles.h"
#include "numeric/no_index.h"
#include "simplify/cover/box_tree.h"
#include "texture/charts.h"

namespace meshbound {
namespace {

/// Triangles by their positions, texture coordinates and material.
using Triangles = SameTriangles<6>;

Triangles::Corners content(const TexturedTriangle& t) {
  Triangles::Corners corners;
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector3d& p = t.corners[k];
    const Eigen::Vector2d& uv = t.coordinates[k];
    corners[k] = {uv.x(), uv.y(), p.x(), p.y(), p.z(), static_cast<double>(t.material)};
  }
  return corners;
}

Triangles table_of(const TexturedMesh& mesh) {
  std::vector<Triangles::Corners> contents;
  contents.reserve(mesh.triangles.size());
  for (const TexturedTriangle& t : mesh.triangles) contents.push_back(content(t));
  return Triangles(std::move(contents));
}

/// The boxes, in the texture, of the triangles that only one of two meshes has.
BoxTree changed_boxes(const TexturedMesh& b, const TexturedMesh& new_b, const Triangles& of_new_b) {
  std::vector<Eigen::AlignedBox3d> boxes;
  if (b == new_b) return BoxTree(boxes);
  const auto add = [&](const TexturedMesh& of, const Triangles& others) {
    for (const TexturedTriangle& t : of.triangles)
      if (!others.has(content(t))) boxes.push_back(box_in_texture(t));
  };
  add(b, of_new_b);
  add(new_b, table_of(b));
  return BoxTree(boxes);
}

TriangleBounds bounds_of_equal(const TexturedMesh& a, const Triangles& of_b) {
  TriangleBounds bounds;
  bounds.uncovered.resize(a.triangles.size());
  for (const TexturedTriangle& t : a.triangles) bounds.upper.push_back(of_b.has(content(t)) ? 0 : HUGE_VAL);
  return bounds;
}

}  // namespace

TriangleBounds bounds_of_equal(const TexturedMesh& a, const TexturedMesh& b) { return bounds_of_equal(a, table_of(b)); }

TriangleBounds bounds_left(const TriangleBounds& known, const TexturedMesh& a, const TexturedMesh& b,
                           const TexturedMesh& new_a, const TexturedMesh& new_b) {
  const Triangles of_new_b = table_of(new_b);
  std::optional<Triangles> before;  // those of A, where the new ones are others
  if (!(a == new_a)) before.emplace(table_of(a));
  TriangleBounds left = bounds_of_equal(new_a, of_new_b);
  const BoxTree changed = changed_boxes(b, new_b, of_new_b);
  std::vector<std::uint32_t> met;
  for (std::size_t i = 0; i < new_a.triangles.size(); ++i) {
    if (left.upper[i] == 0) continue;
    const std::size_t same = before ? before->find(content(new_a.triangles[i])) : i;
    if (same == no_index) continue;
    met.clear();
    changed.find(box_in_texture(new_a.triangles[i]), met);
    if (!met.empty()) continue;
    left.upper[i] = known.upper[same];
    left.uncovered[i] = known.uncovered[same];
  }
  return left;
}

}  // namespace meshbound
