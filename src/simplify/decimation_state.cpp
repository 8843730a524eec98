// SPDX-License-Identifier: MIT
#include "simplify/decimation_state.h"

#include <algorithm>
#include <cmath>

#include "numeric/rounding.h"
#include "simplify/cover/forward_cover.h"
#include "simplify/faults.h"
#include "simplify/mesh/edge_queue.h"

namespace meshbound {

double internal::proof_fault = 1;

namespace {

/// Points between the ends of one edge: more cost more time than they save.
constexpr double max_between = 7;

/// What is left of the tolerance is room in which the measurement of the finished mesh can decide without refining to
/// the last digit: it accepts an upper bound of the whole tolerance.
constexpr double proven_share = 1 - 1e-4;

/// Faces whose normals are further apart meet in a crease: 20 degrees.
constexpr double max_cosine_of_crease = 0.94;

bool is_border_or_crease(const ArrayMesh& mesh, Corner edge) {
  if (mesh.twin(edge) == ArrayMesh::none) return true;
  const auto normal = [&](std::uint32_t face) {
    const auto [a, b, c] = mesh.triangle(face);
    return cross(b - a, c - a);
  };
  const Vec3 m = normal(edge / 3), n = normal(mesh.twin(edge) / 3);
  return dot(m, n) < max_cosine_of_crease * std::sqrt(squared_length(m) * squared_length(n));
}

}  // namespace

Samples::Samples(const std::vector<Vec3>& vertices, const std::vector<std::array<std::uint32_t, 3>>& triangles,
                 const ArrayMesh& mesh, const std::vector<std::uint32_t>& triangle_of_face,
                 const std::vector<std::uint32_t>& vertex_of_vertex, double spacing)
    : samples_(vertices.size()), triangle_near_(vertices.size(), 0), first_(mesh.face_count(), none) {
  for (std::size_t v = 0; v < vertices.size(); ++v) samples_[v].at = vertices[v];
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    for (const std::uint32_t v : triangles[triangle_of_face[f]]) {
      if (samples_[v].face != none) continue;
      triangle_near_[v] = triangle_of_face[f];
      give_to(v, f);
    }
  }
  for (Corner c = 0; c < 3 * mesh.face_count(); ++c) {
    if (mesh.edge(c) != c) continue;
    const std::uint32_t mark = is_border_or_crease(mesh, c) ? at_edge : 0;
    for (const std::uint32_t v : {mesh.start(c), mesh.end(c)}) triangle_near_[vertex_of_vertex[v]] |= mark;
    const Vec3 p = mesh.position(mesh.start(c)), q = mesh.position(mesh.end(c));
    const double count = std::min(std::floor(length(q - p) / spacing), max_between);
    for (int k = 1; k <= count; ++k) {
      samples_.push_back({p + (k / (count + 1)) * (q - p), none, none});
      triangle_near_.push_back(triangle_of_face[c / 3] | mark);
      give_to(static_cast<std::uint32_t>(samples_.size() - 1), c / 3);
    }
  }
}

DecimationState::DecimationState(const std::vector<Vec3>& original_vertices,
                                 const std::vector<std::array<std::uint32_t, 3>>& original_triangles,
                                 const Bvh& original_tree, ArrayMesh start, std::vector<std::uint32_t> vertex_of_vertex,
                                 std::vector<std::uint32_t> triangle_of_face)
    : vertices(original_vertices),
      triangles(original_triangles),
      tree(original_tree),
      mesh(std::move(start)),
      faces(mesh.face_count()),
      source_vertex(std::move(vertex_of_vertex)),
      source_triangle(std::move(triangle_of_face)),
      locked(mesh.vertex_count(), 0),
      quadrics(vertex_quadrics(mesh)),
      share(mesh.vertex_count(), 1),
      stamp(mesh.face_count(), 0),
      touched(mesh.vertex_count(), 0),
      refused_at(3 * mesh.face_count(), 0),
      hope(3 * mesh.face_count(), Hope::WithMoreTolerance),
      index_in_queue(3 * mesh.face_count(), EdgeQueue::absent),
      cover(triangles.size()),
      nearest(source_triangle) {
  for (const Vec3 p : vertices) magnitude = std::max({magnitude, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) cover.assign(source_triangle[f], std::span(&f, 1));
}

void DecimationState::grow_tolerance(double to) {
  if (to == tolerance) return;
  tolerance = to;
  limit = provable(to);
  line_limit = provable(std::min(line_tolerance, to));
  std::fill(refused_at.begin(), refused_at.end(), 0);
  std::fill(share.begin(), share.end(), 1.0F);
}

/// What must be proven in doubles so that `value` holds in real arithmetic.
double DecimationState::provable(double value) const {
  // New vertices lie within the tolerance of old ones. The slack of a distance, and of the cuts above a piece:
  const double size = magnitude + tolerance;
  const double slack = CandidateFaces::rounding_slack(size) + ForwardCover::deepest_cut * cut_error * size;
  return internal::proof_fault * (value * proven_share * (1 - 2 * CandidateFaces::plane_slack) - slack);
}

double DecimationState::limit_around(const std::array<Vec3, 3>& corners) const {
  if (!local) return limit;
  Eigen::AlignedBox3d box;
  for (const Vec3 p : corners) box.extend(Eigen::Vector3d(p.x, p.y, p.z));
  return provable(local->sufficient_around(box, tolerance));
}

}  // namespace meshbound
