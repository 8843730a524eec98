// SPDX-License-Identifier: MIT
#include "simplify/decimation_state.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "geometry/boxes.h"
#include "geometry/position_table.h"
#include "numeric/no_index.h"
#include "numeric/rounding.h"
#include "numeric/tasks.h"
#include "simplify/cover/forward_cover.h"
#include "simplify/faults.h"

namespace meshbound {

double internal::proof_fault = 1;

namespace {

/// What is left of the tolerance is room in which the measurement of the finished mesh can decide without refining to
/// the last digit: it accepts an upper bound of the whole tolerance.
constexpr double proven_share = 1 - 1e-4;

/// One sample may represent two if the original rises by no more than this between them, in tolerances.
constexpr double max_deviation_of_pair = 0.1;

/// Vertices of the original that follow one another, of which one represents the others where it can: where a mesh has
/// been simplified before, a face may have thousands of them.
constexpr std::uint32_t max_followers = 7;

/// Faces whose normals are further apart meet in a crease: 20 degrees.
constexpr double max_cosine_of_crease = 0.94;

/// A normal of any length.
Vec3 normal_of(const TriangleCorners& t) { return cross(t[1] - t[0], t[2] - t[0]); }

/// Between two triangles with these normals that run along their common edge in opposite directions.
bool is_crease(Vec3 m, Vec3 n) {
  constexpr double max_squared_cosine = max_cosine_of_crease * max_cosine_of_crease;
  const double product = dot(m, n);
  return product < 0 || product * product < max_squared_cosine * (squared_length(m) * squared_length(n));
}

/// How many points between two ends leave no more than `spacing` between them, up to a limit; none where a coordinate
/// is no number.
int points_between(Vec3 p, Vec3 q, double spacing) {
  const double squared = squared_length(q - p);
  int count = 0;
  for (int k = 1; k <= Samples::max_between; ++k) count += squared >= k * k * (spacing * spacing) ? 1 : 0;
  return count;
}

/// Which corner of a triangle has this position, as one of them does.
std::size_t corner_at(const std::vector<Vec3>& vertices, const Triangle& triangle, Vec3 p) {
  std::size_t k = 0;
  while (k < 2 && !same_position(vertices[triangle[k]], p)) ++k;
  return k;
}

constexpr std::size_t grain = 4096;  ///< faces that a thread takes at once

/// What an edge is sampled by.
struct EdgeToSample {
  bool is_sharp = false;  ///< a border or a crease
  std::uint8_t points_between = 0;
};

struct EdgesToSample {
  std::vector<EdgeToSample> edges;         ///< by corner of the mesh; at all but one of an edge nothing
  std::vector<std::size_t> points_before;  ///< how many points the edges before every `grain` faces have, and all
};

EdgesToSample edges_to_sample(const ArrayMesh& mesh, double spacing, int threads) {
  std::vector<Vec3> normals(mesh.face_count());
  std::vector<EdgeToSample> edges(3 * mesh.face_count());
  std::vector<std::size_t> points(mesh.face_count() / grain + 2, 0);
  const auto look_at = [&](Corner c) {
    if (mesh.edge(c) != c) return;
    const Corner twin = mesh.twin(c);
    const bool is_sharp = twin == no_index || is_crease(normals[c / 3], normals[twin / 3]);
    const int between = points_between(mesh.position(mesh.start(c)), mesh.position(mesh.end(c)), spacing);
    edges[c] = {is_sharp, static_cast<std::uint8_t>(between)};
  };
  with_team(threads, [&] {
    for_each_range(mesh.face_count(), grain, [&](std::size_t begin, std::size_t end) {
      for (auto f = static_cast<std::uint32_t>(begin); f < end; ++f) normals[f] = normal_of(mesh.triangle(f));
    });
    for_each_range(mesh.face_count(), grain, [&](std::size_t begin, std::size_t end) {
      std::size_t count = 0;
      for (auto c = static_cast<Corner>(3 * begin); c < 3 * end; ++c) look_at(c), count += edges[c].points_between;
      points[begin / grain + 1] = count;
    });
  });
  std::partial_sum(points.begin(), points.end(), points.begin());
  return {std::move(edges), std::move(points)};
}

/// At the edge of original t to the one `across` it.
bool is_border_or_crease(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles, std::uint32_t t,
                         std::uint32_t across) {
  const auto normal = [&](std::uint32_t of) {
    const auto& [a, b, c] = triangles[of];
    return normal_of({vertices[a], vertices[b], vertices[c]});
  };
  return across == no_index || is_crease(normal(t), normal(across));
}

}  // namespace

Samples::Samples(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles, const ArrayMesh& mesh,
                 const std::vector<std::uint32_t>& triangle_of_face, const std::vector<std::uint32_t>& source_vertices,
                 double spacing, int threads)
    : Samples(vertices, triangles, mesh.face_count()) {
  const EdgesToSample sampled = edges_to_sample(mesh, spacing, threads);
  const auto& edges = sampled.edges;
  const auto& points_before = sampled.points_before;
  samples_.resize(vertices.size() + points_before.back());
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    const std::uint32_t t = triangle_of_face[f];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = triangles[t][k];
      if (samples_[v].face != no_index) continue;
      set_place(v, t, k);
      give_to(v, f);
    }
  }
  for (Corner c = 0; c < edges.size(); ++c) {
    if (!edges[c].is_sharp) continue;
    for (const std::uint32_t v : {mesh.start(c), mesh.end(c)})
      samples_[source_vertices[v]].triangle_and_mark |= at_edge;
  }
  const auto add_points = [&](Corner c, std::size_t first) {
    const std::uint32_t t = triangle_of_face[c / 3], mark = edges[c].is_sharp ? at_edge : 0;
    const auto corner = [&](std::uint32_t v) { return corner_at(vertices, triangles[t], mesh.position(v)); };
    put_between(first, corner(mesh.start(c)), corner(mesh.end(c)), edges[c].points_between, t | mark,
                [&](Vec3) { return c / 3; });
  };
  with_team(threads, [&] {
    for_each_range(mesh.face_count(), grain, [&](std::size_t begin, std::size_t end) {
      std::size_t number = vertices.size() + points_before[begin / grain];
      for (auto c = static_cast<Corner>(3 * begin); c < 3 * end; number += edges[c++].points_between)
        if (edges[c].points_between > 0) add_points(c, number);
    });
  });
}

template <class FaceAt>
void Samples::put_between(std::size_t first, std::size_t from, std::size_t to, int count,
                          std::uint32_t triangle_and_mark, const FaceAt& face_at) {
  for (int k = 1; k <= count; ++k) {
    const auto number = static_cast<std::uint32_t>(first) + static_cast<std::uint32_t>(k - 1);
    samples_[number].triangle_and_mark = triangle_and_mark;
    samples_[number].place = {static_cast<std::uint8_t>(from), static_cast<std::uint8_t>(to),
                              static_cast<std::uint8_t>(share_of(k, count))};
    give_to(number, face_at(at(number)));
  }
}

Samples::Samples(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles, const ArrayMesh& mesh,
                 const std::vector<TriangleNeighbours>& neighbours, const CoverAssignment& cover, double tolerance)
    : Samples(vertices, triangles, mesh.face_count()) {
  const auto nearest_face = [&](std::uint32_t original, Vec3 p) {
    const auto faces = cover.faces_of(original);
    return *std::min_element(faces.begin(), faces.end(), [&](std::uint32_t f, std::uint32_t g) {
      return squared_distance(mesh.triangle(f), p) < squared_distance(mesh.triangle(g), p);
    });
  };
  const double spacing = DecimationState::spacing_of_samples * tolerance;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    if (cover.faces_of(t).empty()) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t l = (k + 1) % 3;
      const std::uint32_t v = triangles[t][k], w = triangles[t][l], across = neighbours[t][k];
      if (samples_[v].face == no_index) {
        set_place(v, t, k);
        samples_[v].face = nearest_face(t, vertices[v]);
      }
      if (across != no_index && across < t) continue;
      const std::uint32_t mark = is_border_or_crease(vertices, triangles, t, across) ? at_edge : 0;
      samples_[v].triangle_and_mark |= mark, samples_[w].triangle_and_mark |= mark;
      const int count = points_between(vertices[v], vertices[w], spacing);
      const std::size_t first = samples_.size();
      samples_.resize(first + static_cast<std::size_t>(count));
      put_between(first, k, l, count, t | mark, [&](Vec3 p) { return nearest_face(t, p); });
    }
  }
  std::uint32_t leader = no_index, followers = 0;
  for (std::uint32_t v = 0; v < vertices.size(); ++v) {
    if (samples_[v].face == no_index) continue;
    if (leader != no_index && followers < max_followers && samples_[v].face == samples_[leader].face &&
        around(leader, tolerance).are_alike(around(v, tolerance))) {
      go_with(v, leader);
      ++followers;
      continue;
    }
    give_to(v, samples_[v].face);
    leader = v, followers = 0;
  }
}

Samples::Surroundings Samples::around(std::uint32_t sample, double tolerance) const {
  const auto& [i, j, k] = triangles_[triangle_near(sample)];
  const Vec3 normal = cross(vertices_[j] - vertices_[i], vertices_[k] - vertices_[i]);
  const double max_height = max_deviation_of_pair * tolerance;
  return {at(sample), normal, is_at_edge(sample) ? -1 : max_height * max_height * squared_length(normal)};
}

void EditLog::append(const EditLog& other) {
  edits.insert(edits.end(), other.edits.begin(), other.edits.end());
  lines.insert(lines.end(), other.lines.begin(), other.lines.end());
  for (const std::size_t end : other.textures_end) textures_end.push_back(textures.size() + end);
  textures.insert(textures.end(), other.textures.begin(), other.textures.end());
}

void note(LastChanges& last, const ArrayMesh& mesh, Edit& edit, std::uint32_t number) {
  if (edit.kind == Edit::Kind::Flip) return;
  edit.before[0] = last.set(mesh.start(edit.edge), number);
  if (edit.kind == Edit::Kind::Collapse) edit.before[1] = last.set(mesh.end(edit.edge), number);
}

void take_back(LastChanges& last, const ArrayMesh& mesh, const Edit& edit) {
  if (edit.kind == Edit::Kind::Flip) return;
  last.set(mesh.start(edit.edge), edit.before[0]);
  if (edit.kind == Edit::Kind::Collapse) last.set(mesh.end(edit.edge), edit.before[1]);
}

void ProvenChanges::add(const ArrayMesh& mesh, const EditLog& proven) {
  EditLog& log = logs.front();
  std::uint32_t number = log.last_number();
  log.append(proven);
  for (Edit& edit : std::span(log.edits).last(proven.edits.size())) {
    ++number;
    if (edit.edge != no_index) note(last, mesh, edit, number);
  }
}

OriginalOfDecimation original_of_decimation(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles,
                                            const Bvh& tree) {
  std::vector<TriangleNeighbours> neighbours = edge_neighbours(tree, vertices, triangles);
  ClusteredOriginal clustered({vertices, triangles, neighbours});
  return {vertices, triangles, tree, std::move(neighbours), std::move(clustered)};
}

DecimationState::DecimationState(OriginalOfDecimation original, ArrayMesh start,
                                 std::vector<std::uint32_t> source_vertices,
                                 std::vector<std::uint32_t> triangle_of_face, std::vector<std::uint32_t> near,
                                 CoverAssignment cover_of, int threads)
    : vertices(original.vertices),
      triangles(original.triangles),
      tree(original.tree),
      neighbours(std::move(original.neighbours)),
      clustered(std::move(original.clustered)),
      mesh(std::move(start)),
      faces(mesh.face_count()),
      source_vertex(std::move(source_vertices)),
      source_triangle(std::move(triangle_of_face)),
      locked(mesh.vertex_count(), 0),
      is_fixed(mesh.face_count(), 0),
      quadrics(vertex_quadrics(mesh, PlaneWeights::Equal, threads)),
      share(mesh.vertex_count(), 1),
      last_changes(mesh.vertex_count()),
      notes(3 * mesh.face_count()),
      has_refused(mesh.vertex_count(), 0),
      starts_as_original(false),
      cover(std::move(cover_of)),
      nearest(std::move(near)) {
  for (const Vec3 p : vertices) magnitude = std::max({magnitude, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
}

DecimationState::DecimationState(OriginalOfDecimation original, ArrayMesh start,
                                 std::vector<std::uint32_t> source_vertices,
                                 std::vector<std::uint32_t> triangle_of_face, int threads)
    : DecimationState(std::move(original), std::move(start), std::move(source_vertices), triangle_of_face,
                      triangle_of_face, CoverAssignment(original.triangles.size()), threads) {
  starts_as_original = true;
  cover.reserve_faces(faces);
  with_team(threads, [&] {
    for_each_range(faces, grain, [&](std::size_t begin, std::size_t end) {
      for (auto f = static_cast<std::uint32_t>(begin); f < end; ++f) cover.assign(source_triangle[f], std::span(&f, 1));
    });
  });
}

void DecimationState::lock(std::vector<std::uint8_t> vertices_locked) {
  locked = std::move(vertices_locked);
  for (std::uint32_t f = 0; f < is_fixed.size(); ++f) {
    const Triangle corners = mesh.corners(f);
    is_fixed[f] = std::all_of(corners.begin(), corners.end(), [&](std::uint32_t v) { return locked[v] != 0; }) ? 1 : 0;
  }
}

void DecimationState::reset_quadrics(int threads) {
  quadrics = vertex_quadrics(mesh, texture ? PlaneWeights::Area : PlaneWeights::Equal, threads, std::move(quadrics));
}

void DecimationState::set_samples(double for_tolerance, int threads) {
  const double spacing = spacing_of_samples * for_tolerance;
  samples = starts_as_original ? Samples(vertices, triangles, mesh, source_triangle, source_vertex, spacing, threads)
                               : Samples(vertices, triangles, mesh, neighbours, cover, for_tolerance);
}

void DecimationState::refuse_all() {
  notes.refuse_all();
  std::fill(has_refused.begin(), has_refused.end(), 1);
}

void DecimationState::keep(std::uint32_t original) {
  is_kept.resize(triangles.size(), 0);
  is_kept[original] = 1;
  kept.push_back(original);
}

bool DecimationState::has_equal_corners(std::uint32_t t) const {
  const auto [a, b, c] = original(t);
  return same_position(a, b) || same_position(b, c) || same_position(c, a);
}

void DecimationState::grow_tolerance(double to) {
  if (to == tolerance) return;
  const auto scale = static_cast<float>(tolerance / to);
  for (Corner e = 0; e < notes.size(); ++e) {
    if (!notes.is_refused(e)) continue;
    notes.refuse(e, scale * notes.deviation(e));
    notes.reopen(e);
  }
  tolerance = to;
  limit = provable(to);
  line_limit = provable(std::min(line_tolerance, to));
  std::fill(share.begin(), share.end(), 1.0F);
}

/// What must be proven in doubles so that `value` holds in real arithmetic.
double DecimationState::provable(double value) const {
  // New vertices lie within the tolerance of old ones. The slack of a distance, and of the cuts above a piece:
  const double size = magnitude + tolerance;
  const double slack = CandidateFaces::rounding_slack(size) + ForwardCover::deepest_cut * cut_error * size;
  return internal::proof_fault * (value * proven_share * (1 - 2 * CandidateFaces::plane_slack) - slack);
}

double DecimationState::limit_around(const TriangleCorners& corners) const {
  if (!local) return limit;
  return provable(local->sufficient_around(box_of(corners), tolerance));
}

}  // namespace meshbound
