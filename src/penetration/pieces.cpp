// SPDX-License-Identifier: MIT
#include "penetration/pieces.h"

#include <algorithm>

#include "penetration/parity.h"
#include "penetration/piece_plane.h"

namespace meshbound {

void Pieces::find(PlacedPair& pair, CrossingCurves& curves) {
  pair_ = &pair;
  curves_ = &curves;
  pieces.clear();
  cycles.clear();
  corners.clear();
  shells.clear();
  faces.clear();
  for (std::uint32_t side = 0; side < 2; ++side) {
    traced_[side].assign(curves.segments.size(), 0);
    at_edges_[side].clear(pair.model(side).triangles.size());
    whole_[side].clear(pair.model(side).triangles.size());
    open_.clear();
    for (const std::uint32_t triangle : curves.crossed[side]) trace(side, triangle);
    flood(side);
    flood_uncut_components(side);
    for (const std::uint32_t triangle : curves.crossed[side]) settle_loops(side, triangle);
  }
  join_along_curves();
}

std::span<const std::span<const PieceCorner>> Pieces::border_of(const Piece& piece) {
  border_.clear();
  if (piece.outer != no_index) {
    border_.push_back(corners_of(cycles[piece.outer]));
  } else {
    const Triangle& t = pair_->model(piece.side).triangles[piece.triangle];
    for (std::size_t k = 0; k < 3; ++k) whole_triangle_[k] = {PieceCorner::Kind::Vertex, t[k]};
    border_.push_back(whole_triangle_);
  }
  for (std::uint32_t hole = piece.holes; hole != no_index; hole = cycles[hole].next_hole)
    border_.push_back(corners_of(cycles[hole]));
  return border_;
}

/// Finds all cycles of a crossed triangle, and the pieces of those that reach its border.
void Pieces::trace(std::uint32_t side, std::uint32_t triangle) {
  at_edges_[side].set(triangle, {no_index, no_index, no_index});
  for (const std::uint32_t segment : curves_->segments_in(side, triangle))
    if (traced_[side][segment] == 0) trace_cycle(side, triangle, segment);
}

void Pieces::trace_cycle(std::uint32_t side, std::uint32_t triangle, std::uint32_t segment) {
  const auto cycle = static_cast<std::uint32_t>(cycles.size());
  cycles.push_back({static_cast<std::uint32_t>(corners.size()), 0, no_index, no_index, false});
  const std::uint32_t first = segment;
  std::uint32_t piece = no_index;
  do {
    pair_->count_step();
    traced_[side][segment] = 1;
    const std::uint32_t begin = curves_->segments[segment].begin(side), end = curves_->segments[segment].end(side);
    corners.push_back({PieceCorner::Kind::Node, begin});
    CurveNode& last = curves_->nodes[end];
    if (last.side != side) {
      last.cycle[2] = cycle;
      segment = last.next[2];
      continue;
    }
    if (piece == no_index) piece = cycles[cycle].piece = add_piece(side, triangle, cycle);
    corners.push_back({PieceCorner::Kind::Node, end});
    last.cycle[slot_at_edge(pair_->model(side), last, triangle)] = cycle;
    CurveNode& next = curves_->nodes[walk_border(side, triangle, end, cycle)];
    const std::size_t slot = slot_at_edge(pair_->model(side), next, triangle);
    next.cycle[slot] = cycle;
    segment = next.next[slot];
  } while (segment != first);
  cycles[cycle].end = static_cast<std::uint32_t>(corners.size());
  cycles[cycle].on_border = piece != no_index;
}

/// Walks counter-clockwise along the border from a node to the next one, which it returns; adds the corners between
/// them.
std::uint32_t Pieces::walk_border(std::uint32_t side, std::uint32_t triangle, std::uint32_t node, std::uint32_t cycle) {
  const ClosedModel::Data& model = pair_->model(side);
  const auto runs_along = [&](std::uint32_t edge) { return model.edges[edge].triangle[0] == triangle; };
  std::uint32_t edge = curves_->nodes[node].edge;
  std::size_t k = 0;
  while (model.edges_of[triangle][k] != edge) ++k;
  const std::span<const std::uint32_t> on_edge = curves_->nodes_on(side, edge);
  const std::uint32_t rank = curves_->nodes[node].rank;
  if (runs_along(edge) ? rank + 1 < on_edge.size() : rank > 0) return on_edge[runs_along(edge) ? rank + 1 : rank - 1];
  for (;;) {
    k = next_corner(k);
    corners.push_back({PieceCorner::Kind::Vertex, model.triangles[triangle][k]});
    edge = model.edges_of[triangle][k];
    const std::span<const std::uint32_t> nodes = curves_->nodes_on(side, edge);
    if (!nodes.empty()) return runs_along(edge) ? nodes.front() : nodes.back();
    at_edges_[side][triangle][k] = cycles[cycle].piece;
  }
}

std::uint32_t Pieces::add_piece(std::uint32_t side, std::uint32_t triangle, std::uint32_t outer) {
  const auto piece = static_cast<std::uint32_t>(pieces.size());
  pieces.push_back({side, triangle, outer, no_index});
  shells.add();
  faces.add();
  open_.push_back(piece);
  return piece;
}

/// The piece of a triangle whose whole border is inside the other model.
std::uint32_t Pieces::whole_piece(std::uint32_t side, std::uint32_t triangle) {
  const std::uint32_t piece = add_piece(side, triangle, no_index);
  whole_[side].set(triangle, piece);
  if (at_edges_[side].has(triangle)) at_edges_[side][triangle] = {piece, piece, piece};
  return piece;
}

/// Floods from all open pieces across edges without nodes, which are inside over their whole length.
void Pieces::flood(std::uint32_t side) {
  while (!open_.empty()) {
    const std::uint32_t piece = open_.back();
    open_.pop_back();
    const std::uint32_t triangle = pieces[piece].triangle;
    for (std::size_t k = 0; k < 3; ++k)
      if (pieces[piece].outer == no_index || at_edges_[side][triangle][k] == piece) flood_across(side, piece, k);
  }
}

void Pieces::flood_across(std::uint32_t side, std::uint32_t piece, std::size_t k) {
  const ClosedModel::Data& model = pair_->model(side);
  const std::uint32_t triangle = pieces[piece].triangle, next = model.across(triangle, k);
  std::uint32_t found = whole_[side].has(next) ? whole_[side][next] : no_index;
  if (found == no_index && at_edges_[side].has(next)) {
    const std::uint32_t edge = model.edges_of[triangle][k];
    for (std::size_t j = 0; j < 3; ++j)
      if (model.edges_of[next][j] == edge) found = at_edges_[side][next][j];
  }
  // A triangle that no curve crosses, or one crossed by loops that stay off its border.
  if (found == no_index) found = whole_piece(side, next);
  unite(piece, found, model.edges[model.edges_of[triangle][k]]);
}

/// Joins two pieces of one side that meet along an edge.
void Pieces::unite(std::uint32_t piece, std::uint32_t next, const ModelEdge& edge) {
  const ClosedModel::Data& model = pair_->model(pieces[piece].side);
  shells.unite(piece, next);
  if (model.is_within_plane(edge)) faces.unite(piece, next);
}

/// Components without a node on any edge: but for loops within triangles, each is inside as a whole or not at all.
void Pieces::flood_uncut_components(std::uint32_t side) {
  const ClosedModel::Data& model = pair_->model(side);
  std::vector<bool> is_cut(model.components.size(), false);
  for (const CurveNode& node : curves_->nodes)
    if (node.side == side) is_cut[model.component_of[model.edges[node.edge].triangle[0]]] = true;
  for (std::uint32_t i = 0; i < model.components.size(); ++i) {
    if (is_cut[i] || !may_be_inside(*pair_, side, i)) continue;
    const std::uint32_t triangle = model.components[i].triangle;
    if (!is_inside(*pair_, {side, model.triangles[triangle][0]})) continue;
    whole_piece(side, triangle);
    flood(side);
  }
}

/// Turns the cycles of a triangle that stay off its border into pieces or into holes of pieces.
void Pieces::settle_loops(std::uint32_t side, std::uint32_t triangle) {
  loops_.clear();
  bool has_piece = whole_[side].has(triangle);
  for (const std::uint32_t segment : curves_->segments_in(side, triangle)) {
    const std::uint32_t cycle = curves_->nodes[curves_->segments[segment].begin(side)].cycle[2];
    const CurveNode& begin = curves_->nodes[curves_->segments[segment].begin(side)];
    if (begin.side == side) {
      has_piece = true;
    } else if (!cycles[cycle].on_border && cycles[cycle].piece == no_index &&
               std::find(loops_.begin(), loops_.end(), cycle) == loops_.end()) {
      loops_.push_back(cycle);
    }
  }
  if (loops_.empty()) return;
  const PiecePlane plane(*pair_, *curves_, side, triangle);
  std::vector<std::uint32_t> holes;
  for (const std::uint32_t loop : loops_) {
    const std::span<const PieceCorner> border = corners_of(cycles[loop]);
    const int turn = plane.area_sign({&border, 1});
    // A loop without area encloses points of neither side: it is a hole if there is a piece around it.
    if (turn > 0 || (turn == 0 && !has_piece)) {
      cycles[loop].piece = add_piece(side, triangle, loop);
    } else {
      holes.push_back(loop);
    }
  }
  open_.clear();
  for (const std::uint32_t hole : holes) {
    const std::uint32_t piece = piece_around(hole, side, triangle);
    cycles[hole].piece = piece;
    cycles[hole].next_hole = pieces[piece].holes;
    pieces[piece].holes = hole;
  }
}

/// The piece of a triangle that a hole is in: among the pieces whose outer cycle is around the hole, the one with the
/// least area.
std::uint32_t Pieces::piece_around(std::uint32_t hole, std::uint32_t side, std::uint32_t triangle) {
  std::vector<std::uint32_t> candidates;
  for (std::uint32_t piece = static_cast<std::uint32_t>(pieces.size()); piece-- > 0;)
    if (pieces[piece].side == side && pieces[piece].triangle == triangle) candidates.push_back(piece);
  if (candidates.size() == 1) return candidates[0];
  const PiecePlane plane(*pair_, *curves_, side, triangle);
  std::uint32_t best = candidates.back();
  double least = 2;  // local areas are below 2
  for (const std::uint32_t piece : candidates) {
    const std::uint32_t outer = pieces[piece].outer;
    if (outer == no_index) continue;
    const double area = plane.area(corners_of(cycles[outer]));
    if (area < least && plane.is_around(corners_of(cycles[outer]), corners_of(cycles[hole])))
      best = piece, least = area;
  }
  if (least == 2 && whole_[side].has(triangle)) return whole_[side][triangle];
  return best;
}

void Pieces::join_along_curves() {
  for (const CurveNode& node : curves_->nodes) {
    const std::uint32_t piece = cycles[node.cycle[0]].piece;
    unite(piece, cycles[node.cycle[1]].piece, pair_->model(node.side).edges[node.edge]);
    shells.unite(piece, cycles[node.cycle[2]].piece);
  }
}

}  // namespace meshbound
