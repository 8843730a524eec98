// SPDX-License-Identifier: MIT
#include "simplify/propose.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/boxes.h"
#include "geometry/position_table.h"
#include "numeric/no_index.h"
#include "simplify/faults.h"
#include "simplify/minimax_step.h"
#include "simplify/repair.h"

namespace meshbound {

double internal::sample_fault = 1;

namespace {

/// A placement takes at most so many steps towards where the largest sampled distance is smallest; fewer where a proof
/// of many collapses is still to come.
constexpr int max_minimax_steps = 4, max_minimax_steps_together = 2;

/// Placements of one edge that are worth a proof. With 8 there are 0.04% fewer faces, with 2 there are 0.5% more.
constexpr int max_proofs = 4;

/// For most edges so many samples show that no placement fits.
constexpr std::size_t few_samples = 24;

/// Root mean square of the distances from the planes in the quadrics of an edge, in tolerances, beyond which the edge
/// is refused at once. Most of what samples and proofs would accept beyond comes back when quadrics are renewed: with
/// 1.1 a run takes 3% longer at 0.1% and 2% at 0.02%, and leaves 0.3% and 0.2% fewer faces (74 and 37 meshes); with 1
/// it takes 1% less and leaves 0.4% and 0.2% more.
constexpr double max_deviation_from_planes = 1.05;
/// Root mean square up to which the placement of least cost is likely to fit.
constexpr double likely_deviation_from_planes = 0.6;
/// Where collapses are proven together, edges beyond this are left for later: they are near the limit. With 1.2 a run
/// takes 2% longer and leaves 0.1% fewer faces (37 meshes at 0.1%).
constexpr double max_deviation_together = 1;

/// Beyond this deviation, in limits, a first step is hardly ever followed by one that ends below 1.
constexpr double hopeful_deviation = 1.05;

/// The deviation of an edge that more of the tolerance does not help, but a change around it may.
constexpr float waits_for_change = 0.5F * (hopeless_deviation + far_beyond);

/// A placement is good enough where distances are this share of the limit: closest points move with it. With 0.9 a run
/// takes 1% longer and leaves 0.1% more faces.
constexpr double good_share = 0.95;

/// Root mean square of the distances of an edge's best placement from the planes in the quadrics of its ends.
double deviation_from_planes(const Placement& best, const Quadric& of_a, const Quadric& of_b) {
  return std::sqrt(std::max(0.0, best.cost) / (of_a.planes() + of_b.planes()));
}

/// Where the planes of an edge refuse it without a look at samples: its deviation, in tolerances. `limit` is what
/// samples may reach, `full_limit` all of the tolerance.
std::optional<float> refusal_by_planes(double deviation, double limit, double full_limit, bool is_together) {
  const double in_limits = deviation / (max_deviation_from_planes * full_limit);
  if (in_limits > 1) return static_cast<float>(in_limits) * far_beyond;
  if (is_together && deviation > max_deviation_together * limit) return 0.0F;
  return std::nullopt;
}

bool is_locked(const DecimationState& state, std::uint32_t v) { return state.locked[v] != 0 || state.is_refuted(v); }

/// Whether the two faces that stay are those of a tetrahedron: they have three vertices in common.
bool is_tetrahedron(const ArrayMesh& mesh, const std::vector<Corner>& moved) {
  return moved.size() == 2 && mesh.twin(next_corner(moved[0])) == next_corner(moved[1]);
}

/// Points on the edges at a new vertex that must be near the original. A point costs a hundredth of a proof, which
/// fails where a face runs over a hollow; where proofs are made together, the next ones are built on such a face.
constexpr PointsOnEdge points_on_borders{2, 15}, points_on_edges{2, 7}, points_on_edges_together{16, 1};

/// The link condition: what the ends have in common are the apexes of their faces, and the surface stays a manifold.
bool keeps_manifold(const ArrayMesh& mesh, Corner edge, const std::vector<std::uint32_t>& around_kept,
                    const std::vector<std::uint32_t>& around_gone) {
  const Corner other = mesh.twin(edge);
  const auto is_loose = [&](Corner c) {
    return mesh.twin(next_corner(c)) == no_index && mesh.twin(previous_corner(c)) == no_index;
  };
  if (is_loose(edge) || (other != no_index && is_loose(other))) return false;
  std::size_t common = 0;
  for (const std::uint32_t v : around_gone)
    common += static_cast<std::size_t>(std::count(around_kept.begin(), around_kept.end(), v));
  if (common != (other == no_index ? 1 : 2)) return false;
  if (other == no_index) return true;
  if (mesh.apex(edge) == mesh.apex(other)) return false;
  return !(mesh.is_border(mesh.start(edge)) && mesh.is_border(mesh.end(edge)));
}

}  // namespace

bool EdgeStar::gather(const ArrayMesh& mesh, Corner of) {
  edge = of;
  kept = mesh.start(edge), gone = mesh.end(edge);
  const std::uint32_t face = edge / 3, across = mesh.twin(edge) == no_index ? face : mesh.twin(edge) / 3;
  moved.clear();
  removed.clear();
  removed.push_back(face);
  if (across != face) removed.push_back(across);
  for (auto* ring : {&around_kept_, &around_gone_}) ring->clear();
  const auto visit = [&](std::uint32_t v, std::vector<std::uint32_t>& ring) {
    return mesh.for_each_corner(v, [&](Corner c) {
      ring.push_back(mesh.end(c));
      if (mesh.twin(previous_corner(c)) == no_index) ring.push_back(mesh.apex(c));
      if (c / 3 != face && c / 3 != across) moved.push_back(c);
      return moved.size() <= max_faces_of_star;
    });
  };
  if (!visit(kept, around_kept_) || !visit(gone, around_gone_) || moved.empty() || is_tetrahedron(mesh, moved))
    return false;
  return keeps_manifold(mesh, edge, around_kept_, around_gone_);
}

Proposer::Proposer(DecimationState& state) : state_(state), samples_(state) {
  if (state.texture) texture_.emplace(*state.texture, state.mesh, state.lines);
  if (state.turns) turns_.emplace(*state.turns, state.mesh);
}

void Proposer::gather_samples() {
  gathered_ = true;
  numbers_.resize(star_.moved.size());
  beside_.resize(star_.moved.size());
  std::size_t beside = 0;
  for (std::size_t i = 0; i < star_.moved.size(); ++i) {
    numbers_[i] = star_.moved[i] / 3;
    const Corner across = state_.mesh.twin(next_corner(star_.moved[i]));
    if (across != no_index && owns(across / 3)) beside_[beside++] = across / 3;
  }
  beside_.resize(beside);
  samples_.begin(origin_);
  taken_ = numbers_;
  taken_.insert(taken_.end(), star_.removed.begin(), star_.removed.end());
  samples_.add_faces(taken_);
  samples_.compare(faces_);
}

/// The faces that stay, with the point as their first corner. False where one is folded.
bool Proposer::set_faces(Vec3 point) {
  if (placed_ && same_position(*placed_, point)) return true;
  placed_.reset();
  faces_.clear();
  for (std::size_t i = 0; i < star_.moved.size(); ++i) {
    const Corner c = star_.moved[i];
    const Vec3 q = state_.mesh.position(state_.mesh.end(c)), r = state_.mesh.position(state_.mesh.apex(c));
    if (!before_[i].allows({point, q, r})) return false;
    faces_.emplace_back(point - origin_, q - origin_, r - origin_);
  }
  note_shared_sides(faces_);
  if (gathered_) samples_.compare(faces_);
  placed_ = point;
  return true;
}

/// What must be found in doubles around the star.
double Proposer::limit_around() const {
  if (!state_.local) return state_.limit;
  Eigen::AlignedBox3d box;
  for (const std::uint32_t face : star_.removed) box.extend(box_of(state_.mesh.triangle(face)));
  for (const Corner c : star_.moved) box.extend(box_of(state_.mesh.triangle(c / 3)));
  return state_.limit_in(box);
}

bool Proposer::owns(std::uint32_t face) const { return split_->owns_face(region_, face); }

/// Normals come first: they refuse more placements than all else, most of them at the sample that refused the last one.
bool Proposer::fits(Vec3 point) {
  found_.clear();
  if (!set_faces(point) || !keeps_normals(point)) return false;
  if (!gathered_) gather_samples();
  if (!samples_.hold(beside_, limit_) || !is_vertex_near(point)) return is_too_far();
  if (!keeps_texture(point) || !keeps_normals_around()) return false;
  return are_edges_near(point) || is_too_far();
}

bool Proposer::keeps_normals(Vec3 point) {
  if (!turns_) return true;
  if (!std::exchange(turns_gathered_, true)) turns_->begin({star_.moved, star_.removed, origin_});
  return turns_->holds_inside(point, faces_) || refuse(turn_deviation_, turns_->deviation());
}

bool Proposer::keeps_normals_around() {
  return !turns_ || turns_->holds_around(faces_) || refuse(turn_deviation_, turns_->deviation());
}

bool Proposer::keeps_texture(Vec3 point) {
  if (!texture_) return true;
  if (!std::exchange(texture_gathered_, true)) texture_->begin({star_.edge, star_.moved, star_.removed});
  return texture_->holds(point) || refuse(texture_deviation_, texture_->deviation());
}

float Proposer::deviation() const {
  const float least = refused_for_distance_ ? 0 : waits_for_change;
  return std::max({least, deviation_, texture_deviation_.value_or(0), turn_deviation_.value_or(0)});
}

/// Notes that a placement is refused for a distance. Always false.
bool Proposer::is_too_far() {
  refused_for_distance_ = true;
  return false;
}

/// Notes that a placement is refused for something else than the distance. Always false.
bool Proposer::refuse(std::optional<float>& least, float deviation) {
  least = std::min(least.value_or(HUGE_VALF), deviation);
  return false;
}

/// Ends of border edges that the vertex of the collapse will have.
void Proposer::find_borders() {
  const ArrayMesh& mesh = state_.mesh;
  borders_.clear();
  for (const Corner c : star_.moved) {
    if (mesh.twin(c) == no_index) borders_.push_back(mesh.position(mesh.end(c)));
    if (mesh.twin(previous_corner(c)) == no_index) borders_.push_back(mesh.position(mesh.apex(c)));
  }
  for (const Corner edge : {star_.edge, mesh.twin(star_.edge)}) {
    if (edge == no_index) continue;
    const bool is_border = mesh.twin(next_corner(edge)) == no_index || mesh.twin(previous_corner(edge)) == no_index;
    if (is_border) borders_.push_back(mesh.position(mesh.apex(edge)));
  }
}

bool Proposer::is_vertex_near(Vec3 point) {
  if (!looks_around()) return true;
  if (!samples_.is_near_original(point, limit_)) found_.push_back({point, 0});
  return found_.empty();
}

void Proposer::look_along(Vec3 point, Vec3 end, const PointsOnEdge& points) {
  const double steps = std::min(std::floor(length(end - point) / (points.spacing * full_limit_)), points.max);
  if (const auto share = samples_.stray_on_edge(point, end, static_cast<int>(steps), limit_))
    found_.push_back({end, *share});
}

/// A border that cuts across a bay of the original is far from it, though every sample is near a face; so is an edge
/// that runs over a hollow.
bool Proposer::are_edges_near(Vec3 point) {
  if (!looks_around()) return true;
  const ArrayMesh& mesh = state_.mesh;
  const PointsOnEdge& on_edges = is_together_ ? points_on_edges_together : points_on_edges;
  for (const Vec3 end : borders_) look_along(point, end, points_on_borders);
  for (const Corner c : star_.moved) look_along(point, mesh.position(mesh.end(c)), on_edges);
  return found_.empty();
}

bool Proposer::has_stray_edge(std::uint32_t face) {
  const ArrayMesh& mesh = state_.mesh;
  const double limit = state_.limit_around(mesh.triangle(face)),
               length_of_long = points_on_edges_together.spacing * limit;
  std::uint32_t near = state_.nearest[face];
  for (Corner c = 3 * face; c < 3 * face + 3; ++c) {
    if (mesh.edge(c) != c) continue;
    const Vec3 p = mesh.position(mesh.start(c)), q = mesh.position(mesh.end(c));
    if (length(q - p) >= length_of_long && !samples_.is_edge_near(p, q, near, 0, limit)) return true;
  }
  return false;
}

Proposer::AllowedEnds Proposer::allowed_ends(Corner edge) const {
  const std::uint32_t start = state_.mesh.start(edge), end = state_.mesh.end(edge);
  const OnLines on_lines = state_.lines.allowed(state_.mesh, edge);
  const bool is_free = on_lines == OnLines::Free, is_either = on_lines == OnLines::AtEitherEnd;
  AllowedEnds ends;
  ends.start = !is_locked(state_, end) && (is_free || is_either || on_lines == OnLines::AtStart);
  ends.end = !is_locked(state_, start) && (is_free || is_either || on_lines == OnLines::AtEnd);
  ends.elsewhere = is_free && ends.start && ends.end && !state_.keeps_positions;
  if (state_.lines.is_line(state_.mesh, edge)) {
    const auto is_near = [&](bool to_start) {
      return state_.line_limit > 0 &&
             state_.lines.squared_deviation(state_.mesh, edge, to_start) <= state_.line_limit * state_.line_limit;
    };
    ends.start = ends.start && is_near(true);
    ends.end = ends.end && is_near(false);
  }
  return ends;
}

/// The placement at an end of the edge, the cheaper one first.
std::optional<Vec3> Proposer::placement_at_end(const AllowedEnds& ends) {
  const std::uint32_t kept = star_.kept, gone = star_.gone;
  const Vec3 p = state_.mesh.position(kept), q = state_.mesh.position(gone);
  const auto cost = [&](Vec3 at) { return state_.quadrics[kept].at(at) + state_.quadrics[gone].at(at); };
  const bool end_first = ends.end && (!ends.start || cost(q) < cost(p));
  for (const bool at_end : {end_first, !end_first}) {
    if (!(at_end ? ends.end : ends.start)) continue;
    tried_ = at_end ? q : p;
    if (fits(tried_)) return tried_;
  }
  return std::nullopt;
}

std::optional<Vec3> Proposer::placement(Corner edge, double share, std::optional<Vec3> wanted) {
  ++counts.tried;
  refused_for_distance_ = false;
  deviation_ = 0;
  texture_deviation_.reset();
  turn_deviation_.reset();
  if (!star_.gather(state_.mesh, edge)) return std::nullopt;
  const std::uint32_t kept = star_.kept, gone = star_.gone;
  const AllowedEnds ends = allowed_ends(edge);
  if (!ends.start && !ends.end && !ends.elsewhere) return std::nullopt;
  begin_star(share);
  moves_ = ends.elsewhere;
  if (!ends.elsewhere) return placement_at_end(ends);
  const Vec3 p = state_.mesh.position(kept), q = state_.mesh.position(gone);
  const Placement best = best_placement(state_.quadrics[kept], state_.quadrics[gone], p, q);
  tried_ = wanted ? *wanted : best.point;
  const double deviation = deviation_from_planes(best, state_.quadrics[kept], state_.quadrics[gone]);
  if (const auto refusal = refusal_by_planes(deviation, limit_, full_limit_, is_together_); refusal && !wanted) {
    refused_for_distance_ = true;
    deviation_ = *refusal;
    return std::nullopt;
  }
  if (deviation < likely_deviation_from_planes * limit_ && fits(tried_)) return tried_;
  if (const auto lower = minimax(tried_)) return lower;
  for (const Vec3 end : {p, q}) {
    if (deviation_ <= 1 && !is_texture_far() && fits(end)) return end;
  }
  return std::nullopt;
}

/// What is known of a star before its vertex is placed.
void Proposer::begin_star(double share) {
  const ArrayMesh& mesh = state_.mesh;
  origin_ = mesh.position(star_.kept);
  before_.clear();
  for (const Corner c : star_.moved) before_.emplace_back(mesh, c, [&](std::uint32_t face) { return owns(face); });
  full_limit_ = limit_around() * internal::sample_fault;
  limit_ = full_limit_ * std::min({share, double{state_.share[star_.kept]}, double{state_.share[star_.gone]}});
  proofs_failed_ = 0;
  gathered_ = texture_gathered_ = turns_gathered_ = false;
  if (texture_) texture_->forget();
  strays_.clear();
  placed_.reset();
  find_borders();
  is_together_ = share < 1;
}

std::optional<Vec3> Proposer::next_placement(const std::optional<Vec3>& lost_point, Vec3 refuted) {
  if (++proofs_failed_ == max_proofs || !moves_ || !lost_point) return std::nullopt;
  samples_.add_point(*lost_point);
  samples_.compare(faces_);
  return minimax(refuted);
}

/// Takes a few samples from all parts of the star.
void Proposer::take_few() {
  const SamplePoints& points = samples_.points();
  const std::size_t stride = points.size() / few_samples;
  few_.clear();
  for (std::size_t i = 0; i < points.size(); i += stride) few_.add(points.at(i));
}

/// The placement, reached from `point`, where the largest distance is smallest or small enough.
std::optional<Vec3> Proposer::minimax(Vec3 point) {
  if (is_texture_far()) return std::nullopt;
  if (!set_faces(point)) {
    point = 0.5 * (state_.mesh.position(star_.kept) + state_.mesh.position(star_.gone));
    if (!set_faces(point)) return std::nullopt;
  }
  if (!gathered_) gather_samples();
  const SamplePoints& points = samples_.points();
  if (points.blocks.empty()) return fits(point) ? std::optional(point) : std::nullopt;
  const auto by_limit = static_cast<float>(1 / full_limit_),
             low_deviation = static_cast<float>(good_share * limit_ / full_limit_);
  const float max_height = hopeless_deviation * static_cast<float>(limit_ / full_limit_);
  if (points.size() > 2 * few_samples) {
    take_few();
    few_offsets_.resize(few_.blocks.size());
    sample_kernel_.offsets(few_.blocks, faces_, few_offsets_);
    deviation_kernel_.linearise(few_, faces_, few_offsets_, by_limit, deviations_);
    const MinimaxStep step = minimax_step(deviations_, deviation_kernel_, low_deviation);
    deviation_ = step.there;
    if (step.there > max_height) {
      refused_for_distance_ = true;
      return std::nullopt;
    }
    const Vec3 moved = point + full_limit_ * Vec3{step.move[0], step.move[1], step.move[2]};
    if (set_faces(moved))
      point = moved;
    else
      (void)set_faces(point);
  }
  const int max_steps = is_together_ ? max_minimax_steps_together : max_minimax_steps;
  for (int k = 0; k < max_steps; ++k) {
    deviation_kernel_.linearise(points, faces_, samples_.offsets(), by_limit, deviations_);
    for (const Stray& stray : strays_) add_stray(stray, point);
    MinimaxStep step = minimax_step(deviations_, deviation_kernel_, low_deviation);
    if (full_limit_ * step.here <= limit_) {
      if (fits(point)) return point;
      if (is_texture_far()) return std::nullopt;
      if (!found_.empty()) {
        for (const Stray& stray : found_) add_stray(stray, point);
        strays_.insert(strays_.end(), found_.begin(), found_.end());
        step = minimax_step(deviations_, deviation_kernel_, low_deviation);
      }
    }
    deviation_ = step.there;
    if (full_limit_ * step.there > (k == 0 ? hopeful_deviation : 1) * limit_) {
      refused_for_distance_ = true;
      return std::nullopt;
    }
    point = point + full_limit_ * Vec3{step.move[0], step.move[1], step.move[2]};
    if (!set_faces(point)) return std::nullopt;
  }
  return fits(point) ? std::optional(point) : std::nullopt;
}

/// Adds the distance of a point of the changed faces from the original to the deviations.
void Proposer::add_stray(const Stray& stray, Vec3 point) {
  const Vec3 at = point + stray.share * (stray.end - point);
  const Vec3 offset = (1 / full_limit_) * samples_.offset_from_original(at);
  const double deviation = length(offset);
  if (!(deviation > 0)) return;
  // It is the point that moves with the vertex, not its closest point.
  const auto slope = [&](double component) { return static_cast<float>((stray.share - 1) * component / deviation); };
  deviations_.add(static_cast<float>(deviation), slope(offset.x), slope(offset.y), slope(offset.z));
}

void apply_collapse(DecimationState& state, Region& region, const EdgeStar& star, Vec3 point) {
  state.lines.collapse(state.mesh, star.edge, point);
  state.mesh.collapse(star.edge);
  state.mesh.move(star.kept, point);
  state.quadrics[star.kept] += state.quadrics[star.gone];
  state.locked[star.kept] |= state.locked[star.gone];
  region.removed_faces += star.removed.size();
}

void Proposer::collapse(Region& region, Vec3 point) {
  note_edit(state_, region, Edit::Kind::Collapse, star_.edge, taken_);
  if (texture_) texture_->apply(*state_.texture);
  apply_collapse(state_, region, star_, point);
}

void Proposer::make_final(Region& region) {
  DecimationState& s = state_;
  const std::uint32_t kept = star_.kept, gone = star_.gone;
  for (const std::uint32_t face : star_.removed) s.samples.clear(face);
  for (const Corner c : star_.moved) s.samples.clear(c / 3);
  samples_.give(numbers_);
  if (texture_) texture_->give_samples(*s.texture);
  if (turns_) turns_->give_samples(*s.turns);
  s.share[kept] = std::min(s.share[kept], s.share[gone]);
  s.mesh.for_each_corner(kept, [&](Corner c) {
    s.notes.open(s.mesh.edge(c)), s.notes.open(s.mesh.edge(previous_corner(c)));
    reopen_around(s, *split_, region, s.mesh.end(c));
    if (s.mesh.twin(previous_corner(c)) == no_index) reopen_around(s, *split_, region, s.mesh.apex(c));
    return true;
  });
}

void Proposer::enter(const Split& split, const Region& region, Looks looks) {
  split_ = &split, region_ = region.id, looks_ = looks;
  if (turns_) turns_->enter(split.region_of_face, region.id);
}

bool Proposer::is_inside(Corner edge) const {
  if (split_->region_of.empty()) return true;
  const auto owned_around = [&](std::uint32_t v) {
    std::size_t faces = 0;
    return state_.mesh.for_each_corner(v, [&](Corner c) {
      return ++faces <= max_faces_of_star && split_->owns(region_, state_.mesh.end(c)) &&
             split_->owns(region_, state_.mesh.apex(c));
    });
  };
  return owned_around(state_.mesh.start(edge)) && owned_around(state_.mesh.end(edge));
}

bool is_refused_by_planes(const DecimationState& state, Corner edge) {
  const std::uint32_t a = state.mesh.start(edge), b = state.mesh.end(edge);
  const Quadric &of_a = state.quadrics[a], &of_b = state.quadrics[b];
  const Placement best = best_placement(of_a, of_b, state.mesh.position(a), state.mesh.position(b));
  return deviation_from_planes(best, of_a, of_b) > max_deviation_from_planes * state.limit;
}

EdgeCost edge_cost(const DecimationState& state, Corner edge, double share) {
  const std::uint32_t a = state.mesh.start(edge), b = state.mesh.end(edge);
  const Vec3 p = state.mesh.position(a), q = state.mesh.position(b);
  const Quadric &of_a = state.quadrics[a], &of_b = state.quadrics[b];
  const OnLines on_lines = state.lines.allowed(state.mesh, edge);
  if (on_lines == OnLines::Refused) return {HUGE_VALF, waits_for_change};
  if (on_lines != OnLines::Free || state.keeps_positions) {
    const auto cost = [&](Vec3 at) { return static_cast<float>(of_a.at(at) + of_b.at(at)); };
    if (on_lines == OnLines::AtStart) return {cost(p), {}};
    if (on_lines == OnLines::AtEnd) return {cost(q), {}};
    return {std::min(cost(p), cost(q)), {}};
  }
  const Placement best = best_placement(of_a, of_b, p, q);
  EdgeCost result{static_cast<float>(best.cost), {}};
  if (is_locked(state, a) || is_locked(state, b)) return result;
  // Where faces have tolerances of their own, none is larger.
  const double full_limit = state.limit * internal::sample_fault,
               limit = full_limit * std::min({share, double{state.share[a]}, double{state.share[b]}});
  result.refused_with = refusal_by_planes(deviation_from_planes(best, of_a, of_b), limit, full_limit, share < 1);
  return result;
}

}  // namespace meshbound
