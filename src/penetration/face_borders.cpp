// SPDX-License-Identifier: MIT
#include "penetration/face_borders.h"

namespace meshbound {

void FaceBorders::begin(const PlacedPair& pair, const CrossingCurves& curves, Pieces& pieces) {
  pair_ = &pair;
  curves_ = &curves;
  pieces_ = &pieces;
  for (std::uint32_t side = 0; side < 2; ++side) {
    traced_segments_[side].assign(curves.segments.size(), 0);
    traced_edges_[side].clear(pair.model(side).triangles.size());
  }
}

std::span<const std::span<const PieceCorner>> FaceBorders::trace(std::span<const std::uint32_t> face) {
  corners_.clear();
  planes_.clear();
  ends_.clear();
  side_ = pieces_->pieces[face[0]].side;
  model_ = &pair_->model(side_);
  for (const std::uint32_t index : face) {
    const Piece& piece = pieces_->pieces[index];
    for (const std::span<const PieceCorner> cycle : pieces_->border_of(piece)) trace_from(cycle, piece.triangle);
  }
  lines_.clear();
  std::size_t begin = 0;
  for (const std::size_t end : ends_) {
    lines_.push_back(std::span(corners_).subspan(begin, end - begin));
    begin = end;
  }
  return lines_;
}

/// Traces the lines that a cycle of a piece has a part in. Those through a node have a segment; the others, an edge
/// between two vertices.
void FaceBorders::trace_from(std::span<const PieceCorner> cycle, std::uint32_t triangle) {
  for (std::size_t i = 0; i < cycle.size(); ++i) {
    const PieceCorner corner = cycle[i], next = cycle[i + 1 < cycle.size() ? i + 1 : 0];
    Stretch stretch;
    if (corner.kind == PieceCorner::Kind::Node) {
      const CurveNode& node = curves_->nodes[corner.index];
      stretch.segment = node.next[node.side == side_ ? slot_at_edge(*model_, node, triangle) : 2];
      if (stretch.segment == no_index) continue;
    } else {
      if (next.kind != PieceCorner::Kind::Vertex) continue;
      stretch.triangle = triangle;
      while (model_->triangles[triangle][stretch.k] != corner.index) ++stretch.k;
      if (model_->is_within_plane(edge(triangle, stretch.k))) continue;
    }
    if (!is_traced(stretch)) trace_line(stretch);
  }
}

bool FaceBorders::is_traced(const Stretch& stretch) const {
  if (stretch.segment != no_index) return traced_segments_[side_][stretch.segment] != 0;
  return traced_edges_[side_].has(stretch.triangle) && traced_edges_[side_][stretch.triangle][stretch.k];
}

void FaceBorders::trace_line(const Stretch& first) {
  const std::size_t begin = corners_.size();
  Stretch stretch = first;
  do stretch = follow(stretch);
  while (stretch != first);
  end_line(begin);
}

/// Adds the corners from the beginning of a stretch to that of the next one, which it returns.
FaceBorders::Stretch FaceBorders::follow(const Stretch& stretch) {
  if (stretch.segment == no_index) {
    const auto [segment, triangle, k] = stretch;
    if (!traced_edges_[side_].has(triangle)) traced_edges_[side_].set(triangle, {});
    traced_edges_[side_][triangle][k] = true;
    add({PieceCorner::Kind::Vertex, model_->triangles[triangle][k]}, side_, model_->across(triangle, k));
    return along_edge(triangle, k, no_index);
  }
  traced_segments_[side_][stretch.segment] = 1;
  const CurveSegment& segment = curves_->segments[stretch.segment];
  add({PieceCorner::Kind::Node, segment.begin(side_)}, 1 - side_, segment.triangles[1 - side_]);
  const std::uint32_t end = segment.end(side_), triangle = segment.triangles[side_];
  const CurveNode& node = curves_->nodes[end];
  if (node.side != side_) return {.segment = node.next[2]};
  const std::size_t slot = slot_at_edge(*model_, node, triangle);
  if (model_->is_within_plane(model_->edges[node.edge])) return {.segment = node.next[1 - slot]};
  add({PieceCorner::Kind::Node, end}, side_, model_->edges[node.edge].triangle[1 - slot]);
  return along_edge(triangle, index_of(node.edge, triangle), node.rank);
}

/// The stretch that begins where one along edge k of a triangle ends: at the next node after the one of rank `after`,
/// or the first one if that is `no_index`; else at the vertex where the edge ends.
FaceBorders::Stretch FaceBorders::along_edge(std::uint32_t triangle, std::size_t k, std::uint32_t after) const {
  const std::span<const std::uint32_t> nodes = curves_->nodes_on(side_, model_->edges_of[triangle][k]);
  const std::size_t slot = edge(triangle, k).triangle[0] == triangle ? 0 : 1;
  const std::size_t passed = after == no_index ? 0 : 1 + (slot == 0 ? after : nodes.size() - 1 - after);
  if (passed < nodes.size())
    return {.segment = curves_->nodes[nodes[slot == 0 ? passed : nodes.size() - 1 - passed]].next[slot]};
  k = next_corner(k);
  while (model_->is_within_plane(edge(triangle, k))) {
    const std::uint32_t within = model_->edges_of[triangle][k];
    triangle = model_->across(triangle, k);
    k = next_corner(index_of(within, triangle));
  }
  return {no_index, triangle, k};
}

std::size_t FaceBorders::index_of(std::uint32_t edge, std::uint32_t triangle) const {
  std::size_t k = 0;
  while (model_->edges_of[triangle][k] != edge) ++k;
  return k;
}

const ModelEdge& FaceBorders::edge(std::uint32_t triangle, std::size_t k) const {
  return model_->edges[model_->edges_of[triangle][k]];
}

/// Adds a corner; the stretch after it lies in the plane of a triangle of `side`.
void FaceBorders::add(PieceCorner corner, std::uint32_t side, std::uint32_t triangle) {
  corners_.push_back(corner);
  planes_.push_back({side, pair_->model(side).plane_of[triangle]});
}

/// Takes out the corners of the last line where it goes straight on.
void FaceBorders::end_line(std::size_t begin) {
  std::size_t kept = begin;
  auto before = planes_.back();
  for (std::size_t i = begin; i < corners_.size(); ++i) {
    const auto plane = planes_[i];
    if (plane != before) corners_[kept++] = corners_[i];
    before = plane;
  }
  if (kept < begin + 3) kept = begin;
  corners_.resize(kept);
  planes_.resize(kept);
  if (kept > begin) ends_.push_back(kept);
}

}  // namespace meshbound
