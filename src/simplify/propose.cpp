// SPDX-License-Identifier: MIT
#include "simplify/propose.h"

#include <algorithm>
#include <cmath>

#include "simplify/minimax_step.h"
#include "simplify/repair.h"

namespace meshbound {
namespace {

/// Placements are moved to where the largest sampled distance is least at most this often.
constexpr int max_minimax_steps = 3;

/// One sample in this many tells for most edges that there is nothing to gain.
constexpr std::size_t coarseness = 6;

/// Two faces that stay have three vertices in common: they are the others of a tetrahedron.
bool is_tetrahedron(const ArrayMesh& mesh, const std::vector<Corner>& moved) {
  return moved.size() == 2 && mesh.twin(next_corner(moved[0])) == next_corner(moved[1]);
}

/// The link condition: what the ends have in common are the apexes of their faces, and the surface stays a manifold.
bool keeps_manifold(const ArrayMesh& mesh, Corner edge, const std::vector<std::uint32_t>& around_kept,
                    const std::vector<std::uint32_t>& around_gone) {
  const Corner other = mesh.twin(edge);
  const auto is_loose = [&](Corner c) {
    return mesh.twin(next_corner(c)) == ArrayMesh::none && mesh.twin(previous_corner(c)) == ArrayMesh::none;
  };
  if (is_loose(edge) || (other != ArrayMesh::none && is_loose(other))) return false;
  std::size_t common = 0;
  for (const std::uint32_t v : around_gone)
    common += static_cast<std::size_t>(std::count(around_kept.begin(), around_kept.end(), v));
  if (common != (other == ArrayMesh::none ? 1 : 2)) return false;
  if (other == ArrayMesh::none) return true;
  if (mesh.apex(edge) == mesh.apex(other)) return false;
  return !(mesh.is_border(mesh.start(edge)) && mesh.is_border(mesh.end(edge)));
}

}  // namespace

bool EdgeStar::gather(const ArrayMesh& mesh, Corner of) {
  edge = of;
  kept = mesh.start(edge), gone = mesh.end(edge);
  const std::uint32_t face = edge / 3, across = mesh.twin(edge) == ArrayMesh::none ? face : mesh.twin(edge) / 3;
  moved.clear();
  removed.clear();
  removed.push_back(face);
  if (across != face) removed.push_back(across);
  for (auto* ring : {&around_kept_, &around_gone_}) ring->clear();
  const auto visit = [&](std::uint32_t v, std::vector<std::uint32_t>& ring) {
    return mesh.for_each_corner(v, [&](Corner c) {
      ring.push_back(mesh.end(c));
      if (mesh.twin(previous_corner(c)) == ArrayMesh::none) ring.push_back(mesh.apex(c));
      if (c / 3 != face && c / 3 != across) moved.push_back(c);
      return moved.size() <= max_faces;
    });
  };
  if (!visit(kept, around_kept_) || !visit(gone, around_gone_) || moved.empty() || is_tetrahedron(mesh, moved))
    return false;
  return keeps_manifold(mesh, edge, around_kept_, around_gone_);
}

Proposer::Proposer(DecimationState& state) : state_(state), samples_(state) {}

void Proposer::gather_samples() {
  gathered_ = true;
  samples_.begin(origin_);
  taken_ = star_.removed;
  numbers_.clear();
  beside_.clear();
  for (const Corner c : star_.moved) {
    taken_.push_back(c / 3);
    numbers_.push_back(c / 3);
    const Corner across = state_.mesh.twin(next_corner(c));
    if (across != ArrayMesh::none && owns(across / 3)) beside_.push_back(across / 3);
  }
  for (const std::uint32_t face : taken_) samples_.add_face(face);
}

/// The faces that stay, with the point as their first corner. False where one is folded.
bool Proposer::set_faces(Vec3 point) {
  faces_.clear();
  for (std::size_t i = 0; i < star_.moved.size(); ++i) {
    const Corner c = star_.moved[i];
    const Vec3 q = state_.mesh.position(state_.mesh.end(c)), r = state_.mesh.position(state_.mesh.apex(c));
    if (!before_[i].allows({point, q, r})) return false;
    faces_.emplace_back(point - origin_, q - origin_, r - origin_);
  }
  return true;
}

bool Proposer::owns(std::uint32_t face) const {
  if (split_->region_of.empty()) return true;
  const auto corners = state_.mesh.corners(face);
  return std::all_of(corners.begin(), corners.end(), [&](std::uint32_t v) { return split_->owns(region_, v); });
}

bool Proposer::fits(Vec3 point, double limit) {
  if (!set_faces(point)) {
    ++counts.folded;
    return false;
  }
  if (!gathered_) gather_samples();
  if (!samples_.hold(faces_, beside_, limit)) return false;
  if (samples_.is_near_original(point, limit)) return true;
  ++counts.stray;
  return false;
}

std::optional<Vec3> Proposer::placement(const Split& split, const Region& region, Corner edge, double share) {
  split_ = &split, region_ = region.id;
  ++counts.tried;
  const ArrayMesh& mesh = state_.mesh;
  if (!star_.gather(mesh, edge)) {
    ++counts.by_topology;
    return std::nullopt;
  }
  const std::uint32_t kept = star_.kept, gone = star_.gone;
  if (is_locked(kept) && is_locked(gone)) return std::nullopt;
  const Vec3 p = mesh.position(kept), q = mesh.position(gone);
  origin_ = p;
  before_.clear();
  for (const Corner c : star_.moved)
    before_.emplace_back(
        GuardedFace({mesh.position(mesh.start(c)), mesh.position(mesh.end(c)), mesh.position(mesh.apex(c))}));
  lowered_ = false;
  const double limit = limit_ =
      state_.limit * std::min({share, double{state_.share[kept]}, double{state_.share[gone]}});
  gathered_ = false;
  if (is_locked(kept) || is_locked(gone)) {
    const Vec3 fixed = is_locked(kept) ? p : q;
    return fits(fixed, limit) ? std::optional(fixed) : std::nullopt;
  }
  const Vec3 wanted = best_placement(state_.quadrics[kept], state_.quadrics[gone], p, q).point;
  if (fits(wanted, limit)) {
    ++counts.by_cost;
    return wanted;
  }
  if (const auto lower = minimax(wanted, limit)) return lower;
  for (const Vec3 end : {p, q}) {
    if (!hopeless_ && fits(end, limit)) return end;
  }
  return std::nullopt;
}

std::optional<Vec3> Proposer::lower_placement(Vec3 than) {
  if (lowered_ || is_locked(star_.kept) || is_locked(star_.gone)) return std::nullopt;
  // Beyond what keeps from moving any further.
  return minimax(than, 0.8 * limit_);
}

/// From a placement to where the largest distance is least.
std::optional<Vec3> Proposer::minimax(Vec3 point, double limit) {
  hopeless_ = false;
  lowered_ = true;
  if (!set_faces(point)) {
    point = 0.5 * (state_.mesh.position(star_.kept) + state_.mesh.position(star_.gone));
    if (!set_faces(point)) return std::nullopt;
  }
  if (!gathered_) gather_samples();
  const SamplePoints& points = samples_.points();
  if (points.blocks.empty()) return std::nullopt;
  const auto by_limit = static_cast<float>(1 / limit);
  if (points.blocks.size() > 2 * coarseness) {
    few_.blocks.clear();
    for (std::size_t b = 0; b < points.blocks.size(); b += coarseness) few_.blocks.push_back(points.blocks[b]);
    height_kernel_.linearise(few_, faces_, by_limit, heights_);
    if (minimax_step(heights_, height_kernel_).there > hopeless_height) {
      hopeless_ = true;
      ++counts.hopeless;
      return std::nullopt;
    }
  }
  for (int k = 0; k < max_minimax_steps; ++k) {
    height_kernel_.linearise(points, faces_, by_limit, heights_);
    const MinimaxStep step = minimax_step(heights_, height_kernel_);
    if (step.there > hopeless_height) {
      hopeless_ = true;
      ++counts.hopeless;
      return std::nullopt;
    }
    point = point + limit * Vec3{step.move[0], step.move[1], step.move[2]};
    if (fits(point, limit_)) {
      ++counts.by_minimax;
      return point;
    }
    if (faces_.size() != star_.moved.size()) return std::nullopt;
  }
  ++counts.near_misses;
  return std::nullopt;
}

void apply_collapse(DecimationState& state, Region& region, const EdgeStar& star, Vec3 point) {
  state.mesh.collapse(star.edge);
  state.mesh.move(star.kept, point);
  state.quadrics[star.kept] += state.quadrics[star.gone];
  state.locked[star.kept] |= state.locked[star.gone];
  region.removed_faces += star.removed.size();
}

void Proposer::collapse(Region& region, Vec3 point) {
  note_edit(state_, region, Edit::Kind::Collapse, star_.edge, taken_);
  apply_collapse(state_, region, star_, point);
}

/// Each sample to the face that was found nearest to it.
void Proposer::settle(Region& region) {
  DecimationState& s = state_;
  const std::uint32_t kept = star_.kept, gone = star_.gone;
  for (const std::uint32_t face : star_.removed) s.samples.clear(face);
  for (const Corner c : star_.moved) s.samples.clear(c / 3);
  samples_.give(numbers_);
  s.share[kept] = std::min(s.share[kept], s.share[gone]);
  ++region.clock;
  s.touched[kept] = region.clock;
  s.mesh.for_each_corner(kept, [&](Corner c) {
    s.touched[s.mesh.end(c)] = s.touched[s.mesh.apex(c)] = region.clock;
    return true;
  });
}

/// Whether all vertices around an edge belong to the region.
bool Proposer::is_inside(const Split& split, const Region& region, Corner edge) const {
  if (split.region_of.empty()) return true;
  const auto owned_around = [&](std::uint32_t v) {
    return state_.mesh.for_each_corner(v, [&](Corner c) {
      return split.owns(region.id, state_.mesh.end(c)) && split.owns(region.id, state_.mesh.apex(c));
    });
  };
  return owned_around(state_.mesh.start(edge)) && owned_around(state_.mesh.end(edge));
}

float edge_cost(const DecimationState& state, Corner edge) {
  const std::uint32_t a = state.mesh.start(edge), b = state.mesh.end(edge);
  return static_cast<float>(
      best_placement(state.quadrics[a], state.quadrics[b], state.mesh.position(a), state.mesh.position(b)).cost);
}

/// Collapses an edge where that is near enough, and proven where there is a prover. `around` are then the edges there
/// were at its ends.
bool collapse(DecimationState& state, const Split& split, Region& region, Proposer& proposer, double share,
              ChangeProver* prover, Corner edge, std::vector<Corner>& around) {
  const std::optional<Vec3> point = proposer.placement(split, region, edge, share);
  if (!point) return false;
  around.clear();
  for (const std::uint32_t v : {proposer.star().kept, proposer.star().gone}) {
    state.mesh.for_each_corner(v, [&](Corner c) {
      around.push_back(state.mesh.edge(c));
      around.push_back(state.mesh.edge(previous_corner(c)));
      return true;
    });
  }
  proposer.collapse(region, *point);
  if (prover != nullptr && !prover->prove_or_undo(split, region)) {
    const std::optional<Vec3> lower = proposer.lower_placement(*point);
    if (lower) proposer.collapse(region, *lower);
    if (!lower || !prover->prove_or_undo(split, region)) return false;
  }
  proposer.settle(region);
  return true;
}

void propose(DecimationState& state, const Split& split, Region& region, Proposer& proposer, double share,
             ChangeProver* prover, const std::function<bool(std::size_t removed)>& stop) {
  EdgeQueue queue(state.place_in_queue);
  const ArrayMesh& mesh = state.mesh;
  const auto is_open = [&](Corner e) {
    const std::uint32_t a = mesh.start(e), b = mesh.end(e);
    return split.owns(region.id, a) && split.owns(region.id, b) &&
           std::max(state.touched[a], state.touched[b]) >= state.refused_at[e];
  };
  for (Corner c = 0; c < 3 * mesh.face_count(); ++c) {
    if (!mesh.is_removed(c / 3) && mesh.edge(c) == c && is_open(c)) queue.put(c, edge_cost(state, c));
  }
  std::vector<Corner> around;
  while (!queue.empty() && !stop(region.removed_faces)) {
    const Corner edge = queue.pop();
    if (!proposer.is_inside(split, region, edge)) continue;
    if (!collapse(state, split, region, proposer, share, prover, edge, around)) {
      state.refused_at[edge] = region.clock + 1;
      continue;
    }
    for (const Corner e : around) queue.erase(e);
    mesh.for_each_corner(proposer.star().kept, [&](Corner c) {
      for (const Corner e : {mesh.edge(c), mesh.edge(previous_corner(c))}) {
        state.refused_at[e] = 0;
        if (split.owns(region.id, mesh.start(e)) && split.owns(region.id, mesh.end(e)))
          queue.put(e, edge_cost(state, e));
      }
      return true;
    });
  }
  queue.clear();
}

}  // namespace meshbound
