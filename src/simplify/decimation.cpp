// SPDX-License-Identifier: MIT
#include "simplify/decimation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <tuple>
#include <utility>

#include "geometry/eigen_vec3.h"
#include "mesh/round_to_floats.h"
#include "meshbound/error.h"
#include "meshbound/mesh_summary.h"
#include "numeric/no_index.h"
#include "numeric/tasks.h"
#include "numeric/thread_count.h"
#include "simplify/mesh/edge_queue.h"
#include "simplify/mesh/manifold_soup.h"
#include "simplify/option_sizes.h"
#include "simplify/prune.h"

namespace meshbound {
namespace {

std::vector<Vec3> points_in_frame(const std::vector<Eigen::Vector3d>& vertices, const WorkingFrame& frame) {
  std::vector<Vec3> points;
  points.reserve(vertices.size());
  for (const Eigen::Vector3d& p : vertices) points.push_back(to_vec3(frame.to_frame(p)));
  return points;
}

/// The vertices of a mesh in this order.
std::vector<Vec3> points_in_frame(const std::vector<Eigen::Vector3d>& vertices, const std::vector<std::uint32_t>& order,
                                  const WorkingFrame& frame) {
  std::vector<Vec3> points;
  points.reserve(order.size());
  for (const std::uint32_t v : order) points.push_back(to_vec3(frame.to_frame(vertices[v])));
  return points;
}

MeshView view_of(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles) {
  return {reinterpret_cast<const double*>(points.data()), points.size(), sizeof(Vec3),
          reinterpret_cast<const std::uint32_t*>(triangles.data()), triangles.size()};
}

/// What samples may reach of the texture tolerance: between them the texture moves further, and what moves too far is
/// taken back. With 0.92 a run takes 4% longer and leaves 1.1% fewer faces, with 0.95 it takes 10% longer for 1.4%
/// fewer (six models at three tolerances).
constexpr double share_of_texture_tolerance = 0.88;

/// False at a border, and where a face has no area and so no normal.
bool is_feature(const ArrayMesh& mesh, Corner edge, double angle) {
  if (mesh.twin(edge) == no_index) return false;
  const auto normal = [&](std::uint32_t face) {
    const auto [a, b, c] = mesh.triangle(face);
    return cross(b - a, c - a);
  };
  const Vec3 a = normal(edge / 3), b = normal(mesh.twin(edge) / 3);
  if (squared_length(a) == 0 || squared_length(b) == 0) return false;
  return std::atan2(length(cross(a, b)), dot(a, b)) > angle;
}

}  // namespace

Decimation::Decimation(const TriangleMesh& original, const SimplifyOptions& options, const StopToken& stop,
                       const std::vector<bool>& at_rim)
    : Decimation(original, nullptr, options, stop, at_rim) {}

Decimation::Decimation(const TriangleMesh& original, const ProvenMesh& start, const SimplifyOptions& options,
                       const StopToken& stop, const std::vector<bool>& at_rim)
    : Decimation(original, &start, options, stop, at_rim) {}

Decimation::Decimation(const TriangleMesh& original, const ProvenMesh* start, const SimplifyOptions& options,
                       const StopToken& stop, const std::vector<bool>& at_rim)
    : start_(start),
      start_vertices_(start != nullptr ? start->mesh.vertices.size() : original.vertices.size()),
      order_(spatial_order(original, {options.threads, stop})),
      original_(original),
      options_(options),
      frame_(used_bounding_box(original_)),
      vertices_(points_in_frame(original.vertices, order_.vertex, frame_)),
      start_points_(start != nullptr ? points_in_frame(start->mesh.vertices, frame_) : std::vector<Vec3>()),
      at_start_point_(start_points(), first_of_start_),
      tree_(view_of(vertices_, order_.triangles), BvhOptions{options.threads, stop}) {
  for (std::uint32_t v = 0; v < vertices_.size(); ++v) largest_ = largest_.cwiseMax(in_original(v).cwiseAbs());
  if (options.precision == Precision::Single && largest_.maxCoeff() > std::numeric_limits<float>::max() / 2)
    throw InvalidInput("a coordinate is beyond the range of single precision: rescale the mesh, or keep doubles");
  stop.check();
  make_state(stop, at_rim);
}

namespace {

/// A number for each triangle, taken in this order: equal where the look that the caller gives, the material and the
/// texture coordinates of the corners, in any order, are. Empty where neither looks nor texture nor normals count.
std::vector<std::uint32_t> looks_of(const SimplifyOptions& options, std::span<const std::uint32_t> order) {
  using Look = std::tuple<std::uint32_t, std::uint32_t, std::array<std::array<double, 2>, 3>>;
  std::map<Look, std::uint32_t> number_of;
  std::vector<std::uint32_t> looks;
  if (options.normal_tolerance) looks.assign(order.size(), 0);
  if (!options.looks.empty()) {
    looks.clear();
    for (const std::uint32_t t : order) looks.push_back(options.looks[t]);
  }
  if (options.texture_coordinates.empty()) return looks;
  looks.clear();
  for (const std::uint32_t t : order) {
    Look look{options.looks.empty() ? 0 : options.looks[t], options.materials.empty() ? 0 : options.materials[t], {}};
    auto& corners = std::get<2>(look);
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector2d& uv = options.texture_coordinates[t][k];
      if (uv.allFinite()) corners[k] = {uv.x(), uv.y()};  // missing ones are not a number, which has no order
    }
    std::sort(corners.begin(), corners.end());
    looks.push_back(number_of.try_emplace(look, static_cast<std::uint32_t>(number_of.size())).first->second);
  }
  return looks;
}

/// Takes the faces and twins of `soup`.
ArrayMesh take_mesh(ManifoldSoup& soup, std::span<const Vec3> points) {
  std::vector<Vec3> positions;
  positions.reserve(soup.vertex_of.size());
  for (const std::uint32_t v : soup.vertex_of) positions.push_back(points[v]);
  return ArrayMesh(std::move(positions), std::move(soup.faces), std::move(soup.twin));
}

}  // namespace

void Decimation::make_state(const StopToken& stop, const std::vector<bool>& at_rim) {
  check_sizes(options_, start_vertices_, original_.triangles.size());
  std::vector<TriangleNeighbours> neighbours = edge_neighbours(tree_, vertices_, order_.triangles, threads());
  stop.check();
  ManifoldSoup soup;
  ArrayMesh mesh;
  std::optional<ClusteredOriginal> clustered;
  with_team(threads(), [&] {
    do_both(
        [&] {
          soup = soup_of_start(neighbours, at_rim);
          mesh = take_mesh(soup, start_points());
        },
        [&] {
          clustered.emplace(OriginalSoup{vertices_, order_.triangles, neighbours});
        });
  });
  stop.check();
  dropped_triangles_ = soup.dropped_triangles;
  split_ = soup.split;
  OriginalOfDecimation original{vertices_, order_.triangles, tree_, std::move(neighbours), *std::move(clustered)};
  if (start_ != nullptr)
    go_on_from_start(std::move(original), std::move(soup), std::move(mesh));
  else
    start_as_original(std::move(original), std::move(soup), std::move(mesh));
  stop.check();
  if (keeps_sides() || split_) note_turned_faces();
  if (has_lines()) set_lines();
  if (!options_.texture_coordinates.empty()) set_texture();
  if (options_.normal_tolerance) set_turns();
  if (bounds_appearance()) state_->proven_changes.emplace(state_->mesh.vertex_count());
  state_->keeps_positions = options_.placements == CollapsePlacements::Subset;
  state_->lock(locked());
  locked_vertices_ = static_cast<std::size_t>(std::count(state_->locked.begin(), state_->locked.end(), 1));
  if (!options_.face_tolerances.empty()) {
    std::vector<Eigen::AlignedBox3d> boxes(order_.triangles.size());
    for (std::size_t t = 0; t < boxes.size(); ++t)
      for (const std::uint32_t v : order_.triangles[t]) boxes[t].extend(frame_.to_frame(in_original(v)));
    state_->local.emplace(std::move(boxes), limits_in_frame());
  }
  threads_.emplace(*state_, threads());
}

/// Indices of the original's triangles here, by the caller's.
std::vector<std::uint32_t> Decimation::index_of_caller_triangle() const {
  std::vector<std::uint32_t> index(order_.triangle.size());
  for (std::uint32_t t = 0; t < index.size(); ++t) index[order_.triangle[t]] = t;
  return index;
}

ManifoldSoup Decimation::soup_of_start(std::span<const TriangleNeighbours> neighbours,
                                       const std::vector<bool>& at_rim) {
  std::vector<bool> at_rim_here(at_rim.empty() ? 0 : start_points().size());  // by the vertex numbers here
  for (std::uint32_t v = 0; v < at_rim_here.size(); ++v) at_rim_here[v] = at_rim[caller_vertex(v)];
  std::vector<std::uint32_t> first = std::exchange(first_of_start_, {});
  const MeshView soup = view_of(start_points(), start_triangles());
  if (start_ != nullptr) {  // where solids that touch have come to share a triangle, each needs its own
    const std::vector<std::uint32_t> keeps_backs(start_triangles().size(), 0);
    return manifold_soup(soup, std::move(first), {}, keeps_backs, {}, at_rim_here);
  }
  return manifold_soup(soup, std::move(first), neighbours, looks_of(options_, order_.triangle), order_.triangle,
                       at_rim_here);
}

void Decimation::start_as_original(OriginalOfDecimation original, ManifoldSoup soup, ArrayMesh mesh) {
  state_.emplace(std::move(original), std::move(mesh), std::move(soup.vertex_of), std::move(soup.triangle_of),
                 threads());
  const std::vector<std::uint32_t>& triangles = state_->source_triangle;
  for (const auto& [triangle, of] : soup.repetitions) {
    const auto face =
        static_cast<std::uint32_t>(std::lower_bound(triangles.begin(), triangles.end(), of) - triangles.begin());
    state_->cover.assign(triangle, {&face, 1});
  }
}

void Decimation::go_on_from_start(OriginalOfDecimation original, ManifoldSoup soup, ArrayMesh mesh) {
  std::vector<std::uint32_t> face(start_->mesh.triangles.size(), no_index);  // by triangle of the start
  for (std::uint32_t f = 0; f < soup.triangle_of.size(); ++f) face[soup.triangle_of[f]] = f;
  const std::vector<std::uint32_t> index = index_of_caller_triangle();
  std::vector<std::uint32_t> near;
  for (const std::uint32_t t : soup.triangle_of) near.push_back(index[start_->near[t]]);
  CoverAssignment cover(index.size());
  std::vector<std::uint32_t> faces;
  for (std::uint32_t t = 0; t < index.size(); ++t) {
    faces.clear();
    for (const std::uint32_t of_start : start_->cover[t]) faces.push_back(face[of_start]);
    // A face that was dropped lies on others, but a cover with it has to be proven again.
    if (std::find(faces.begin(), faces.end(), no_index) == faces.end()) cover.assign(index[t], faces);
  }
  state_.emplace(std::move(original), std::move(mesh), std::move(soup.vertex_of), std::move(soup.triangle_of),
                 std::move(near), std::move(cover), threads());
  if (start_->is_covered.empty()) return;
  state_->is_kept.resize(index.size());
  for (std::uint32_t t = 0; t < index.size(); ++t) state_->is_kept[index[t]] = start_->is_covered[t];
}

/// The first vertex of the start, by index, at this position.
std::optional<std::uint32_t> Decimation::first_at(Vec3 p) const {
  const std::uint32_t first = at_start_point_.find(p);
  return first == no_index ? std::nullopt : std::optional(first);
}

/// By vertex of the mesh: several vertices of the original, at one position, may have become one, or one several.
std::vector<std::uint8_t> Decimation::locked() const {
  const ArrayMesh& mesh = state_->mesh;
  std::vector<std::uint8_t> locked(mesh.vertex_count(), 0);
  if (!options_.locked_vertices.empty()) {
    std::vector<std::uint8_t> locked_at(start_points().size(), 0);  // by first vertex at the position
    for (std::uint32_t v = 0; v < start_points().size(); ++v)
      if (options_.locked_vertices[caller_vertex(v)]) locked_at[*first_at(start_points()[v])] = 1;
    for (std::uint32_t v = 0; v < locked.size(); ++v) locked[v] = locked_at[*first_at(mesh.position(v))];
  }
  lock_features(locked);
  if (start_ != nullptr) lock_cuts(locked);
  return locked;
}

/// Locks both ends of edges that the manifold was cut along, for their faces could not be paired. The start has come of
/// a decimation that kept it closed there, so neither side may leave the other.
void Decimation::lock_cuts(std::vector<std::uint8_t>& locked) const {
  const ArrayMesh& mesh = state_->mesh;
  std::vector<std::tuple<std::uint32_t, std::uint32_t, Corner>> borders;  // by the first vertices at their ends
  for (Corner c = 0; c < 3 * mesh.face_count(); ++c) {
    if (mesh.twin(c) != no_index) continue;
    const std::uint32_t p = *first_at(mesh.position(mesh.start(c))), q = *first_at(mesh.position(mesh.end(c)));
    borders.emplace_back(std::min(p, q), std::max(p, q), c);
  }
  std::sort(borders.begin(), borders.end());
  for (std::size_t i = 1; i < borders.size(); ++i) {
    const auto& [p, q, c] = borders[i];
    const auto& [p_before, q_before, before] = borders[i - 1];
    if (p != p_before || q != q_before) continue;
    for (const Corner side : {c, before}) locked[mesh.start(side)] = locked[mesh.end(side)] = 1;
  }
}

bool Decimation::take_back(std::span<const Refuted> refuted) {
  if (below_rounding_) return false;  // nothing was collapsed: what was measured is the original
  const std::vector<std::uint32_t> faces = faces_in_order();
  const std::vector<std::uint32_t> index = index_of_caller_triangle();
  std::vector<Refuted> here;
  for (const Refuted& r : refuted) {
    const bool has_face = r.face < faces.size();  // those after them are triangles of the original
    here.push_back(
        {r.original == no_index ? no_index : index[r.original], has_face ? faces[r.face] : no_index, r.coordinate});
  }
  return meshbound::take_back(*state_, here, *threads_);
}

void Decimation::lock_features(std::vector<std::uint8_t>& locked) const {
  const ArrayMesh& mesh = state_->mesh;
  const bool locks_creases = options_.feature_angle && !has_lines();
  if (!locks_creases && !options_.preserve_boundary) return;
  for (Corner c = 0; c < 3 * mesh.face_count(); ++c) {
    const bool is_border = mesh.twin(c) == no_index;
    if (is_border ? !options_.preserve_boundary : !locks_creases || !is_feature(mesh, c, *options_.feature_angle))
      continue;
    locked[mesh.start(c)] = locked[mesh.end(c)] = 1;
  }
}

/// By corner of the mesh: whether an option makes a line of the edge that starts there.
std::vector<std::uint8_t> Decimation::marked_edges() const {
  const ArrayMesh& mesh = state_->mesh;
  std::vector<std::uint32_t> index(start_vertices_, no_index);  // of the original, by vertex of the input
  for (std::uint32_t v = 0; v < order_.vertex.size(); ++v) index[order_.vertex[v]] = v;
  std::set<Edge> wanted;  // by first vertices at their positions
  for (const auto& [a, b] : options_.feature_edges) {
    if (index[a] == no_index || index[b] == no_index) continue;
    const std::uint32_t p = *first_at(vertices_[index[a]]), q = *first_at(vertices_[index[b]]);
    wanted.insert({std::min(p, q), std::max(p, q)});
  }
  std::vector<std::uint32_t> first(wanted.empty() ? 0 : mesh.vertex_count());  // at the position, by vertex
  for (std::uint32_t v = 0; v < first.size(); ++v) first[v] = *first_at(mesh.position(v));
  std::vector<std::uint8_t> marked(3 * mesh.face_count(), 0);
  for (Corner c = 0; c < marked.size(); ++c) {
    if (options_.feature_angle && is_feature(mesh, c, *options_.feature_angle)) marked[c] = 1;
    if (is_seam(c)) marked[c] = 1;
    if (wanted.empty()) continue;
    const std::uint32_t p = first[mesh.start(c)], q = first[mesh.end(c)];
    if (wanted.contains({std::min(p, q), std::max(p, q)})) marked[c] = 1;
  }
  return marked;
}

/// Whether texture coordinates, materials or the side that shows differ between the two faces of an edge, or the
/// texture is folded there: what lies beside a fold in the texture would be covered no more where the fold moves.
bool Decimation::is_seam(Corner edge) const {
  const ArrayMesh& mesh = state_->mesh;
  const Corner twin = mesh.twin(edge);
  if (twin == no_index) return false;
  if (keeps_sides() && is_turned_over_[edge / 3] != is_turned_over_[twin / 3]) return true;
  if (options_.texture_coordinates.empty()) return false;
  const auto triangle = [&](Corner c) { return order_.triangle[state_->source_triangle[c / 3]]; };
  if (!options_.materials.empty() && options_.materials[triangle(edge)] != options_.materials[triangle(twin)])
    return true;
  const auto at = [&](Corner face, std::uint32_t vertex) {
    const std::uint32_t t = state_->source_triangle[face / 3];
    std::size_t k = 0;
    while (k < 2 && !same_position(vertices_[order_.triangles[t][k]], mesh.position(vertex))) ++k;
    return options_.texture_coordinates[order_.triangle[t]][k];
  };
  const auto differ = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a != b && (a.allFinite() || b.allFinite());
  };
  const std::uint32_t start = mesh.start(edge), end = mesh.end(edge);
  if (differ(at(edge, start), at(twin, start)) || differ(at(edge, end), at(twin, end))) return true;
  const Eigen::Vector2d from = at(edge, start), way = at(edge, end) - from;
  const auto doubled_area = [&](Corner side) {
    const Eigen::Vector2d to = at(side, mesh.apex(side)) - from;
    return way.x() * to.y() - way.y() * to.x();
  };
  const double left = doubled_area(edge), right = doubled_area(twin);
  return (left > 0 && right > 0) || (left < 0 && right < 0);
}

int Decimation::threads() const { return thread_count(options_.threads); }

void Decimation::set_turns() {
  const bool is_chain = std::isnan(options_.tolerance);  // whose tolerances are asked for one by one
  const double reach = is_chain ? std::numeric_limits<double>::infinity() : frame_.length_to_frame(options_.tolerance);
  state_->turns.emplace(state_->mesh, is_turned_over_, FaceTurns::Limits{*options_.normal_tolerance, reach, threads()});
}

void Decimation::set_texture() {
  std::vector<CornerCoordinates> coordinates;
  std::vector<std::uint32_t> materials;
  coordinates.reserve(order_.triangle.size());
  for (const std::uint32_t t : order_.triangle) {
    coordinates.push_back(options_.texture_coordinates[t]);
    if (!options_.materials.empty()) materials.push_back(options_.materials[t]);
  }
  state_->texture.emplace(Atlas(vertices_, order_.triangles, std::move(coordinates), std::move(materials)),
                          state_->mesh, state_->lines, state_->source_triangle, vertices_, order_.triangles,
                          frame_.length_to_frame(options_.texture_tolerance));
  set_texture_tolerance(options_.texture_tolerance);
  state_->reset_quadrics(threads());
}

void Decimation::set_texture_tolerance(double tolerance) {
  state_->texture->limit = share_of_texture_tolerance * frame_.length_to_frame(tolerance);
}

void Decimation::note_turned_faces() {
  const ArrayMesh& mesh = state_->mesh;
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {  // one that is turned over keeps its first corner
    const Vec3 second = start_points()[start_triangles()[state_->source_triangle[f]][1]];
    is_turned_over_.push_back(same_position(mesh.position(mesh.start(3 * f + 1)), second) ? 0 : 1);
  }
  has_turned_faces_ = std::find(is_turned_over_.begin(), is_turned_over_.end(), 1) != is_turned_over_.end();
}

void Decimation::set_lines() {
  DecimationState& state = *state_;
  state.lines = FeatureLines(state.mesh, marked_edges());
  if (options_.line_tolerance)
    state.line_tolerance =
        std::max(0.0, frame_.length_to_frame(*options_.line_tolerance) - room(*options_.line_tolerance));
  for (Corner c = 0; c < 3 * state.mesh.face_count(); ++c) {
    if (state.mesh.edge(c) == c && state.lines.is_line(state.mesh, c))
      lines_.push_back({source_of(state.mesh.start(c)), source_of(state.mesh.end(c))});
  }
}

/// The vertex of the start that a vertex of the mesh comes from, or where it stands if it stands at vertices only or is
/// locked: another vertex may have gone there and kept its number.
std::uint32_t Decimation::source_of(std::uint32_t vertex) const {
  const bool is_at_start = state_->keeps_positions || state_->locked[vertex] != 0;
  return caller_vertex(is_at_start ? *first_at(state_->mesh.position(vertex)) : state_->source_vertex[vertex]);
}

std::vector<double> Decimation::limits_in_frame() const {
  std::vector<double> limits;
  const bool is_chain = std::isnan(options_.tolerance);  // the tolerances that it is asked for are not known yet
  const double lost = room(is_chain ? largest_.maxCoeff() : options_.tolerance);
  for (const std::uint32_t t : order_.triangle) {
    const double tolerance = options_.face_tolerances[t];
    limits.push_back(tolerance > 0 ? std::max(0.0, frame_.length_to_frame(tolerance) - lost) : tolerance);
  }
  return limits;
}

namespace {

/// Half the distance between the floats around a number of this magnitude or a smaller one: rounding such a number to
/// the nearest float moves it by no more. A float has 24 bits and none below 2^-149.
double half_float_step(double magnitude) {
  int exponent = 0;  // magnitude < 2^exponent
  std::frexp(magnitude, &exponent);
  return std::ldexp(1.0, std::max(exponent - 25, -150));
}

}  // namespace

/// How far rounding to floats may move a vertex of the result that lies within `reach` of the original, model units.
/// Each of its coordinates is then at most the largest one of the original on that axis plus `reach`, so that rounding
/// changes it by half a float step at that magnitude; the steps of the axes may differ much, as those of terrain in UTM
/// do. Where vertices stand at those of the start only, what these and the original move by is known exactly.
double Decimation::rounding_of_output(double reach) const {
  if (options_.precision == Precision::Double) return 0;
  constexpr double rounded_up = 1 + 0x1p-50;  // for the length itself
  double moved = 0;
  if (options_.placements == CollapsePlacements::Subset) {
    const auto include = [&](const Eigen::Vector3d& p) { moved = std::max(moved, (as_written(p) - p).norm()); };
    for (std::uint32_t v = 0; v < vertices_.size(); ++v) include(in_original(v));
    if (start_ != nullptr) std::for_each(start_->mesh.vertices.begin(), start_->mesh.vertices.end(), include);
  } else {
    const auto half_step = [&](double largest) { return half_float_step(largest + reach); };
    moved = largest_.unaryExpr(half_step).norm();
  }
  return rounded_up * moved;
}

/// What rounding takes of a tolerance for vertices within `reach` of the original, in units of the frame: the ways into
/// and out of the frame, of the original and of the result, and the output format.
double Decimation::room(double reach) const {
  return 4 * frame_.rounding() + frame_.length_to_frame(rounding_of_output(reach));
}

EndedBy Decimation::run(double tolerance, std::size_t target_faces, const StopToken& stop) {
  const double framed = frame_.length_to_frame(tolerance), lost = room(tolerance);
  // Proofs need some room of their own, about as much as the frame does.
  const double of_proofs = 4 * frame_.rounding();
  below_rounding_ = !(framed > lost + of_proofs);
  if (below_rounding_) return EndedBy::Rounding;
  DecimationGoal goal;
  goal.tolerance = framed - lost;
  goal.target_faces = target_faces - std::min(target_faces, state_->kept.size());  // those kept count as well
  goal.on_exceed = options_.on_exceed;
  goal.effort = options_.effort;
  goal.stop = stop;
  goal.driver = options_.driver.get();
  if (options_.progress) {
    goal.progress = [&](std::size_t faces) {
      // Most runs end at a small share of the faces and spend their time on the way there.
      options_.progress(1 - static_cast<double>(faces) / static_cast<double>(order_.triangles.size()));
    };
  }
  if (state_->samples.size() == 0) state_->set_samples(goal.tolerance, threads());
  const auto prune_components = [&] {
    if (!options_.prune) return;
    const Pruned pruned = prune(*state_, goal.tolerance, target_faces, options_.preserve_boundary, threads_->workers);
    pruned_components_ += pruned.components;
    pruned_faces_ += pruned.faces;
  };
  prune_components();
  const EndedBy ended_by = decimate(*state_, goal, *threads_);
  if (ended_by == EndedBy::NothingFits) prune_components();
  return ended_by;
}

/// Where a vertex of the mesh is. One that never moved, or went to where another one was, gets the coordinates of the
/// start to the bit: the way into the frame and back may round.
Eigen::Vector3d Decimation::in_model(std::uint32_t vertex) const {
  const Vec3 p = state_->mesh.position(vertex);
  const std::uint32_t source = state_->source_vertex[vertex];
  const std::optional<std::uint32_t> start = same_position(p, start_points()[source]) ? source : first_at(p);
  if (!start) return as_written(frame_.to_model({p.x, p.y, p.z}));
  return as_written(start_ != nullptr ? start_->mesh.vertices[*start] : in_original(*start));
}

Eigen::Vector3d Decimation::as_written(const Eigen::Vector3d& point) const {
  return options_.precision == Precision::Single ? rounded_to_float(point) : point;
}

}  // namespace meshbound
