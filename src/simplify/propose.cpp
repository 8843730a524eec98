// SPDX-License-Identifier: MIT
#include "simplify/propose.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "simplify/faults.h"
#include "simplify/minimax_step.h"

namespace meshbound {

double internal::sample_fault = 1;

namespace {

/// Placements are moved to where the largest sampled distance is least at most this often.
constexpr int max_minimax_steps = 3;

/// One sample in this many tells for most edges that there is nothing to gain.
constexpr std::size_t coarseness = 6;

/// Distance from the planes that an edge stands for, in limits, beyond which it is refused at once.
double max_root_mean_square = std::getenv("RMS") ? std::atof(std::getenv("RMS")) : 2;

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
  if (!visit(kept, around_kept_) || !visit(gone, around_gone_) || moved.empty()) return false;
  return keeps_manifold(mesh, edge, around_kept_, around_gone_);
}

Proposer::Proposer(DecimationState& state) : state_(state), samples_(state) {}

void Proposer::gather_samples() {
  gathered_ = true;
  samples_.begin(origin_);
  for (const std::uint32_t face : star_.removed) samples_.add_face(face);
  numbers_.clear();
  beside_.clear();
  for (const Corner c : star_.moved) {
    samples_.add_face(c / 3);
    numbers_.push_back(c / 3);
    const Corner across = state_.mesh.twin(next_corner(c));
    if (across != ArrayMesh::none && owns(across / 3)) beside_.push_back(across / 3);
  }
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

/// What must be found in doubles around the star.
double Proposer::limit_around() const {
  if (!state_.local) return state_.limit;
  Eigen::AlignedBox3d box;
  for (const std::uint32_t face : star_.removed)
    for (const Vec3 p : state_.mesh.triangle(face)) box.extend(Eigen::Vector3d(p.x, p.y, p.z));
  for (const Corner c : star_.moved)
    for (const Vec3 p : state_.mesh.triangle(c / 3)) box.extend(Eigen::Vector3d(p.x, p.y, p.z));
  return state_.limit_in(box);
}

bool Proposer::owns(std::uint32_t face) const {
  if (split_->region_of.empty()) return true;
  const auto corners = state_.mesh.corners(face);
  return std::all_of(corners.begin(), corners.end(), [&](std::uint32_t v) { return split_->owns(region_, v); });
}

bool Proposer::fits(Vec3 point, double limit) {
  if (!set_faces(point)) {
    return false;
  }
  if (!gathered_) gather_samples();
  by_bound_ = true;
  return samples_.hold(faces_, beside_, limit) && samples_.is_near_original(point, limit);
}

/// Whether the planes of the original that the ends stand for are too far from any one point for it to be near them all:
/// collapses beyond are accepted once in a hundred times or less.
bool Proposer::is_hopeless(double cost, double limit) const {
  const double planes = state_.quadrics[star_.kept].planes() + state_.quadrics[star_.gone].planes();
  return cost > max_root_mean_square * max_root_mean_square * limit * limit * planes;
}

std::optional<Vec3> Proposer::placement(Corner edge, double share, std::optional<Vec3> wanted) {
  ++counts.tried;
  by_bound_ = false;
  const ArrayMesh& mesh = state_.mesh;
  if (!star_.gather(mesh, edge)) {
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
  const double limit = limit_ = limit_around() * internal::sample_fault *
      std::min({share, double{state_.share[kept]}, double{state_.share[gone]}});
  gathered_ = false;
  if (is_locked(kept) || is_locked(gone)) {
    const Vec3 fixed = is_locked(kept) ? p : q;
    tried_ = fixed;
    return fits(fixed, limit) ? std::optional(fixed) : std::nullopt;
  }
  if (!wanted) {
    const Placement best = best_placement(state_.quadrics[kept], state_.quadrics[gone], p, q);
    wanted = best.point;
    by_bound_ = true;
    if (is_hopeless(best.cost, limit)) return std::nullopt;
  }
  tried_ = *wanted;
  if (fits(*wanted, limit)) {
    return wanted;
  }
  if (const auto lower = minimax(*wanted, limit)) return lower;
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
      return std::nullopt;
    }
  }
  for (int k = 0; k < max_minimax_steps; ++k) {
    height_kernel_.linearise(points, faces_, by_limit, heights_);
    const MinimaxStep step = minimax_step(heights_, height_kernel_);
    if (step.there > hopeless_height) {
      hopeless_ = true;
      return std::nullopt;
    }
    point = point + limit * Vec3{step.move[0], step.move[1], step.move[2]};
    if (fits(point, limit_)) {
      return point;
    }
    if (faces_.size() != star_.moved.size()) return std::nullopt;
  }
  return std::nullopt;
}

void Proposer::collapse(Region& region, Vec3 point) {
  DecimationState& s = state_;
  EditLog& log = region.log;
  const std::uint32_t number = log.last_number() + 1;
  const std::uint32_t kept = star_.kept, gone = star_.gone;
  log.edits.push_back({Edit::Kind::Collapse, s.locked[kept] != 0, star_.edge, s.mesh.position(kept),
                       static_cast<std::uint32_t>(log.stamps.size())});
  const auto stamp = [&](std::uint32_t face) {
    log.stamps.push_back({face, s.stamp[face]});
    s.stamp[face] = number;
  };
  for (const std::uint32_t face : star_.removed) stamp(face);
  for (const Corner c : star_.moved) stamp(c / 3);
  s.mesh.collapse(star_.edge);
  s.mesh.move(kept, point);
  s.quadrics[kept] += s.quadrics[gone];
  s.locked[kept] |= s.locked[gone];
  region.removed_faces += star_.removed.size();
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

void Proposer::enter(const Split& split, const Region& region) { split_ = &split, region_ = region.id; }

bool Proposer::is_inside(Corner edge) const {
  if (split_->region_of.empty()) return true;
  const auto owned_around = [&](std::uint32_t v) {
    return state_.mesh.for_each_corner(v, [&](Corner c) {
      return split_->owns(region_, state_.mesh.end(c)) && split_->owns(region_, state_.mesh.apex(c));
    });
  };
  return owned_around(state_.mesh.start(edge)) && owned_around(state_.mesh.end(edge));
}

float Proposer::cost(Corner edge) const {
  const std::uint32_t a = state_.mesh.start(edge), b = state_.mesh.end(edge);
  return static_cast<float>(
      best_placement(state_.quadrics[a], state_.quadrics[b], state_.mesh.position(a), state_.mesh.position(b)).cost);
}

}  // namespace meshbound
