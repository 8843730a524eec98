// SPDX-License-Identifier: MIT
#include "simplify/mesh/feature_lines.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/position_table.h"
#include "geometry/segment.h"
#include "numeric/no_index.h"

namespace meshbound {
namespace {

/// The corners across the other edges of the two faces that a collapse removes, those of one face next to each other.
std::array<Corner, 4> outer_corners(const ArrayMesh& mesh, Corner edge) {
  const Corner other = mesh.twin(edge);
  std::array<Corner, 4> outer = {mesh.twin(next_corner(edge)), mesh.twin(previous_corner(edge)), no_index, no_index};
  if (other != no_index) outer[2] = mesh.twin(next_corner(other)), outer[3] = mesh.twin(previous_corner(other));
  return outer;
}

}  // namespace

FeatureLines::FeatureLines(const ArrayMesh& start, std::vector<std::uint8_t> is_marked)
    : is_marked_(std::move(is_marked)),
      at_(start.vertex_count(), no_index),
      neighbours_(start.vertex_count(), {no_index, no_index}) {
  std::vector<std::uint32_t> count(start.vertex_count(), 0);
  for (Corner c = 0; c < 3 * start.face_count(); ++c) {
    if (start.edge(c) != c || !is_line(start, c)) continue;
    for (const auto& [v, other] : {std::pair(start.start(c), start.end(c)), std::pair(start.end(c), start.start(c))}) {
      at_[v] = v;
      if (count[v] < 2) neighbours_[v][count[v]] = other;
      ++count[v];
    }
  }
  position_.reserve(start.vertex_count());
  for (std::uint32_t v = 0; v < start.vertex_count(); ++v) {
    position_.push_back(start.position(v));
    if (count[v] != 2) neighbours_[v] = {no_index, no_index};
  }
}

/// The vertex at the other line edge of a vertex inside a line, one of whose line edges is `edge`.
std::uint32_t FeatureLines::other_neighbour(const ArrayMesh& mesh, std::uint32_t vertex, Corner edge) const {
  std::uint32_t found = no_index;
  mesh.for_each_corner(vertex, [&](Corner c) {
    for (const Corner side : {c, previous_corner(c)}) {
      if (mesh.edge(side) == mesh.edge(edge) || !is_line(mesh, side)) continue;
      found = mesh.start(side) == vertex ? mesh.end(side) : mesh.start(side);
    }
    return found == no_index;
  });
  return found;
}

OnLines FeatureLines::allowed(const ArrayMesh& mesh, Corner edge) const {
  const std::uint32_t start = mesh.start(edge), end = mesh.end(edge);
  if (!is_on_line(start)) return is_on_line(end) ? OnLines::AtEnd : OnLines::Free;
  if (!is_on_line(end)) return OnLines::AtStart;
  if (!is_line(mesh, edge)) return OnLines::Refused;
  for (const Corner c : {edge, mesh.twin(edge)})  // of a face whose edges are all lines, two would become one
    if (c != no_index && is_line(mesh, next_corner(c)) && is_line(mesh, previous_corner(c))) return OnLines::Refused;
  if (is_inside_line(start)) return is_inside_line(end) ? OnLines::AtEitherEnd : OnLines::AtEnd;
  return is_inside_line(end) ? OnLines::AtStart : OnLines::Refused;
}

/// Visits the positions of a line of the start mesh after `from` until it comes to `first` or `second`, and returns
/// which. `no_index` where the line ends before that.
template <class Visit>
std::uint32_t FeatureLines::walk(std::uint32_t from, std::size_t direction, std::uint32_t first, std::uint32_t second,
                                 const Visit& visit) const {
  std::uint32_t before = from, at = neighbours_[from][direction];
  while (at != first && at != second) {
    if (at == no_index || at == from) return no_index;
    visit(position_[at]);
    const auto& next = neighbours_[at];
    const std::uint32_t following = next[0] == before ? next[1] : next[0];
    before = at;
    at = following;
  }
  return at;
}

double FeatureLines::squared_deviation(const ArrayMesh& mesh, Corner edge, bool to_start) const {
  const std::uint32_t stays = to_start ? mesh.start(edge) : mesh.end(edge);
  const std::uint32_t leaves = to_start ? mesh.end(edge) : mesh.start(edge);
  const std::uint32_t other = other_neighbour(mesh, leaves, edge);
  if (other == no_index) return HUGE_VAL;
  const std::uint32_t from = at_[stays], to = at_[other], middle = at_[leaves];
  double largest = squared_distance_to_segment(position_[middle], position_[from], position_[to]);
  const auto measure = [&](Vec3 p) {
    largest = std::max(largest, squared_distance_to_segment(p, position_[from], position_[to]));
  };
  const std::uint32_t one = walk(middle, 0, from, to, measure), two = walk(middle, 1, from, to, measure);
  return (one == from && two == to) || (one == to && two == from) ? largest : HUGE_VAL;
}

FeatureLines::Before FeatureLines::before(const ArrayMesh& mesh, Corner edge) const {
  if (empty()) return {};
  Before before{at_[mesh.start(edge)], 0};
  const auto outer = outer_corners(mesh, edge);
  for (std::size_t i = 0; i < outer.size(); ++i)
    if (outer[i] != no_index && is_marked_[outer[i]] != 0) before.marks |= static_cast<std::uint8_t>(1U << i);
  return before;
}

void FeatureLines::collapse(const ArrayMesh& mesh, Corner edge, Vec3 point) {
  if (empty()) return;
  const std::uint32_t kept = mesh.start(edge), gone = mesh.end(edge);
  if (at_[gone] != no_index && (at_[kept] == no_index || same_position(point, position_[at_[gone]])))
    at_[kept] = at_[gone];
  const auto outer = outer_corners(mesh, edge);
  for (std::size_t side = 0; side < outer.size(); side += 2) {
    const Corner c = outer[side], d = outer[side + 1];
    const bool merged = (c != no_index && is_line(mesh, c)) || (d != no_index && is_line(mesh, d));
    for (const Corner corner : {c, d})
      if (corner != no_index) is_marked_[corner] = merged ? 1 : 0;
  }
}

void FeatureLines::undo_collapse(const ArrayMesh& mesh, Corner edge, const Before& before) {
  if (empty()) return;
  at_[mesh.start(edge)] = before.at;
  const auto outer = outer_corners(mesh, edge);
  for (std::size_t i = 0; i < outer.size(); ++i)
    if (outer[i] != no_index) is_marked_[outer[i]] = before.marks >> i & 1U;
}

}  // namespace meshbound
