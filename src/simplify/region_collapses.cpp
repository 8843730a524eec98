// SPDX-License-Identifier: MIT
#include "simplify/region_collapses.h"

#include <algorithm>
#include <utility>

namespace meshbound {

RegionCollapses::RegionCollapses(DecimationState& state, const Split& split, Region& region, Proposer& proposer,
                                 ChangeProver* prover, Limits limits)
    : state_(state), split_(split), region_(region), proposer_(proposer), prover_(prover), limits_(std::move(limits)) {
  proposer_.enter(split, region, limits_.max_cost < HUGE_VALF ? Proposer::Looks::AtSamples : Proposer::Looks::Around);
  for_each_edge([&](Corner e) {
    ++edge_count_;
    if (is_open(e)) open_edges_.push_back(e);
  });
}

bool RegionCollapses::owns_vertex(std::uint32_t vertex) const { return split_.owns(region_.id, vertex); }

bool RegionCollapses::is_owned(Corner edge) const {
  return owns_vertex(mesh().start(edge)) && owns_vertex(mesh().end(edge));
}

bool RegionCollapses::owns_face(std::uint32_t face) const { return split_.owns_face(region_.id, face); }

bool RegionCollapses::is_open(Corner edge) const { return is_owned(edge) && state_.is_open(edge); }

bool RegionCollapses::make(Vec3 point) {
  proposer_.collapse(region_, point);
  if (prover_ != nullptr && !prover_->prove_or_undo(split_, region_, proposer_.changed_faces())) return false;
  proposer_.make_final(region_);
  if (limits_.made) limits_.made(kept());
  return true;
}

void RegionCollapses::note_edges_that_go() {
  edges_gone_.clear();
  for (const std::uint32_t face : proposer_.star().removed)
    for (Corner c = 3 * face; c < 3 * face + 3; ++c) edges_gone_.push_back(mesh().edge(c));
}

/// Whether faces around the edge cover an original together with faces of other regions: no change here can be proven.
bool RegionCollapses::shares_covers(Corner edge) const {
  if (split_.region_of.empty()) return false;
  const auto is_covered_here = [&](std::uint32_t original) {
    return is_covered_in(split_, region_.id, state_.cover, original);
  };
  const auto covers_alone = [&](Corner c) {
    return std::ranges::all_of(state_.cover.originals_of(c / 3), is_covered_here);
  };
  return !mesh().for_each_corner(mesh().start(edge), covers_alone) ||
         !mesh().for_each_corner(mesh().end(edge), covers_alone);
}

bool RegionCollapses::collapse(Corner edge, std::optional<Vec3> wanted) {
  if (!proposer_.is_inside(edge)) return false;
  if (prover_ != nullptr && shares_covers(edge)) return false;
  std::optional<Vec3> point = proposer_.placement(edge, limits_.share, wanted);
  const bool point_found = point.has_value();
  if (point_found) note_edges_that_go();
  for (; point; point = proposer_.next_placement(prover_->lost_point(), *point))
    if (make(*point)) return true;
  ++proposer_.counts.refused;
  if (point_found && prover_ != nullptr && prover_->met_seam()) return false;
  state_.refuse(edge, point_found ? 0 : proposer_.deviation());
  if (limits_.ends_at_refusal && (point_found || proposer_.refused_for_distance()) && limits_.ends_at_refusal())
    ended_ = true;
  return false;
}

/// Where a refusal ends the collapses, it must come at its turn.
bool RegionCollapses::is_refused_by(const EdgeCost& cost) const {
  return cost.refused_with && !limits_.ends_at_refusal;
}

bool RegionCollapses::refuses(Corner edge, const EdgeCost& cost) {
  if (!is_refused_by(cost)) return false;
  ++proposer_.counts.refused;
  state_.refuse(edge, *cost.refused_with);
  return true;
}

bool RegionCollapses::refuses_unseen(Corner edge) { return refuses(edge, edge_cost(state_, edge, limits_.share)); }

/// Most edges of a mesh that shrinks little never enter the queue.
void RegionCollapses::put(EdgeQueue& queue, Corner edge) {
  const EdgeCost cost = edge_cost(state_, edge, limits_.share);
  if (!is_refused_by(cost) && !(cost.cost > limits_.max_cost)) return queue.put(edge, cost.cost);
  queue.erase(edge);
  (void)refuses(edge, cost);
}

void RegionCollapses::collapse_all() {
  EdgeQueue queue(state_.notes);
  for (const Corner e : open_edges_) put(queue, e);
  while (!queue.empty() && !must_stop()) {
    if (!collapse(queue.pop())) continue;
    for (const Corner e : edges_gone_) queue.erase(e);
    mesh().for_each_edge(kept(), [&](Corner e) {
      if (is_owned(e)) put(queue, e);
    });
  }
}

}  // namespace meshbound
