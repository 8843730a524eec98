// SPDX-License-Identifier: GPL-3.0-or-later
#include "cgal/collapse_run.h"

#include <algorithm>
#include <boost/property_map/function_property_map.hpp>
#include <cmath>
#include <utility>

#include "cgal/estimate_fault.h"
#include "cgal/hub_collapse.h"

namespace meshbound::cgal {
namespace {

/// A pass over all edges that removes a smaller share of the faces than this is the last one: what it gains no longer
/// pays for looking at every edge again.
constexpr double least_gain_of_pass = 0.01;

/// Refinement ends where as much work as all passes before it gains less than this share of the faces.
constexpr double least_gain_of_refinement = 0.015;
/// But not before this many proofs per original triangle, as a few hundred faces may stay the same for long and fall
/// again, and at most so many in all: large meshes need more in any case.
constexpr std::uint64_t least_refinement = 300, most_of_least_refinement = 6'000'000;

/// Of those that `DeviationMonitor` knows, all: where the one that is computed fails, the ends of the edge may still
/// keep the bound (2 to 4% fewer faces).
constexpr int fallback_placements = CollapseRun::Monitor::most_fallback_placements;

/// The clock is looked at once in this many edges, each of which may take milliseconds, the callback called once in
/// so many.
constexpr std::uint64_t checks_between_looks = 4, checks_between_progress = 64;

/// Estimated collapses end where the estimate reaches this share of the tolerance. The estimate errs by a third or so:
/// true distances of 0.7 to 0.85 tolerances came out on real meshes, with 0.8 some beyond the tolerance.
constexpr double share_of_estimate = 0.7;
/// And where as many edges have been left out as this share of the collapses that would halve the faces: what is left
/// out now is collapsed later, at a higher cost than its turn.
constexpr double most_left_out = 0.03;
/// At the seams of parts that were estimated alone most collapses are overdue, and the end comes soon.
constexpr double most_left_out_at_seams = 0.001;

/// What a run that was cancelled may take for its last proof.
constexpr double seconds_of_last_proof = 0.3;

/// While proven collapses halve the number of faces, each original triangle is tested about this often: a collapse
/// takes 2 faces away and tests what some 10 stand for. The work that estimated ones save counts as if it were done.
constexpr double tests_per_halving = 3.5;

}  // namespace

double internal::estimate_fault = 1;

class CollapseRun::Filter {
 public:
  explicit Filter(CollapseRun& owner) : owner_(&owner), filter_(owner.monitor_->filter()) {}

  template <class Profile, class OptionalPoint>
  OptionalPoint operator()(const Profile& profile, const OptionalPoint& placement) const {
    const OptionalPoint admitted = filter_(profile, placement);
    if (!admitted && owner_->options_.on_exceed == OnExceed::Stop && owner_->monitor_->last_refusal_by_bound() &&
        owner_->truly_exceeds()) {
      owner_->ended_by_ = EndedBy::Tolerance;
      if (owner_->goal_.stop.stopped()) owner_->note_stop();
    }
    return admitted;
  }

 private:
  CollapseRun* owner_;
  Monitor::Filter filter_;
};

CollapseRun::CollapseRun(ManifoldCopy copy, const TriangleMesh& original, const SimplifyOptions& options,
                         const std::vector<bool>& locked)
    : original_(original), options_(options), copy_(std::move(copy)), locked_(locked) {
  policies_.emplace(options.cost, kept_parts(), nullptr);
  if (!may_estimate()) start_exactly();
}

/// Nothing to lose: no part of the original that the mesh leaves out, and nothing to be proven before the first
/// collapse or with other tolerances.
bool CollapseRun::may_estimate() const {
  return copy_.dropped_triangles == 0 && !options_.prune && options_.face_tolerances.empty();
}

void CollapseRun::start_exactly() {
  monitor_.emplace(copy_.mesh, original_, copy_.triangle_of_face, 0.0, get(CGAL::vertex_point, copy_.mesh));
  set_up_monitor();
}

void CollapseRun::set_up_monitor() {
  monitor_->normal_guard = NormalGuard();
  monitor_->preserve_boundary = options_.preserve_boundary;
  monitor_->fallback_placements = options_.effort == Effort::Fast ? 0 : fallback_placements;
  monitor_->should_stop = [this](std::size_t faces) { return must_stop(faces); };
  if (!locked_.empty())
    monitor_->lock_vertices(boost::make_function_property_map<SurfaceMesh::Vertex_index>(
        [&](SurfaceMesh::Vertex_index v) { return bool(locked_[v]); }));
  refinement_.emplace(copy_.mesh, *monitor_, [this] { return must_stop(monitor_->faces()); });
}

CollapseRun::CollapseRun(Part part, const Seams& seams, const SimplifyOptions& options, const std::vector<bool>& locked)
    : part_(std::move(part)),
      original_(part_->original),
      options_(options),
      copy_(to_manifold_copy(std::move(part_->copy))),
      locked_(locked) {
  seam_.emplace(seams, part_->seam_vertex);
  policies_.emplace(options.cost, kept_parts(), &*seam_);
  if (!may_estimate()) start_exactly();
}

KeptParts CollapseRun::kept_parts() const {
  KeptParts kept{&copy_.mesh, options_.preserve_boundary, {}};
  if (!locked_.empty()) kept.is_locked = [this](SurfaceMesh::Vertex_index v) { return is_locked(v); };
  return kept;
}

bool CollapseRun::is_locked(SurfaceMesh::Vertex_index v) const {
  return monitor_ ? monitor_->is_locked(v) : phase_->is_locked(v);
}

/// The first collapses without proofs, then a monitor that proves what they left. Where that fails, once more without
/// what could not be proven, and then with proofs from the beginning.
void CollapseRun::estimate() {
  const SurfaceMesh start = copy_.mesh;
  try {
    if (try_estimates(start)) return;
  } catch (const Stopped&) {
    if (!part_) throw;
    note_stop();
    copy_.mesh = start;
  }
  start_exactly();
}

bool CollapseRun::try_estimates(const SurfaceMesh& start) {
  std::vector<bool> frozen;
  for (int attempt = 0; attempt < 2; ++attempt) {
    if (estimate_without(frozen)) return true;
    ++estimated_.restarts;
    frozen = around_unproven(start);
    monitor_.reset();
    copy_.mesh = start;
    phase_.emplace(copy_.mesh, NormalGuard(), locked_, frozen, [](std::size_t) { return true; });
    policies_.emplace(options_.cost, kept_parts(), seam_ ? &*seam_ : nullptr);
    if (ended_by_ == EndedBy::Target) ended_by_.reset();
    if (ended_by_) goal_.stop.check();
    if (ended_by_) break;
  }
  return false;
}

/// False when what came out could not be proven.
bool CollapseRun::estimate_without(const std::vector<bool>& frozen) {
  run_phase(frozen, kept_parts());
  if (phase_->collapses() > 0) return prove_phase();
  if (ended_by_) goal_.stop.check();
  start_exactly();
  return true;
}

void CollapseRun::run_phase(std::vector<bool> frozen, const KeptParts& kept) {
  const double tolerance = goal_.tolerance - goal_.room;
  double left_out = most_left_out * static_cast<double>(copy_.mesh.number_of_faces()) / 4;
  if (kept.only != nullptr) {
    const auto vertices = std::count(kept.only->begin(), kept.only->end(), true);
    left_out = most_left_out_at_seams * static_cast<double>(vertices) / 2;
  }
  phase_.emplace(copy_.mesh, NormalGuard(), locked_, std::move(frozen),
                 [this](std::size_t left) { return must_stop(left); });
  if (!heights_.empty()) phase_->start_from(std::move(heights_));
  policies_->stop_by(goal_.stop);
  try {
    phase_->run(*policies_, kept, share_of_estimate * internal::estimate_fault * tolerance,
                options_.on_exceed == OnExceed::Stop ? 1 : 1 + static_cast<std::uint64_t>(left_out));
  } catch (const Stopped&) {
    note_stop();
  }
}

/// A cancelled run of the whole mesh proves what it has where that takes no time to speak of.
StopToken CollapseRun::stop_of_proof() const {
  if (!goal_.stop.cancelled() || part_) return goal_.stop_proof;
  return StopToken().until(StopToken::Clock::now(), seconds_of_last_proof);
}

bool CollapseRun::prove_phase() {
  monitor_.emplace(copy_.mesh, original_, Bvh(MeshView(original_), BvhOptions{options_.threads}),
                   goal_.tolerance - goal_.room, get(CGAL::vertex_point, copy_.mesh), options_.threads,
                   stop_of_proof());
  if (!monitor_->unproven().empty()) return false;
  estimated_.performed += phase_->collapses();
  const auto faces = static_cast<double>(original_.triangles.size());
  estimated_work_ =
      static_cast<std::uint64_t>(tests_per_halving * faces * std::log2(faces / static_cast<double>(monitor_->faces())));
  locked_ = phase_->locked();
  set_up_monitor();
  return true;
}

/// Vertices of the mesh at the start: of the triangles and faces that the monitor could not prove, and beside them.
std::vector<bool> CollapseRun::around_unproven(const SurfaceMesh& start) const {
  const Unproven& unproven = monitor_->unproven();
  std::vector<bool> marked(start.num_vertices(), false), around(start.num_vertices(), false);
  const auto mark = [&](const SurfaceMesh& mesh, SurfaceMesh::Face_index f) {
    for (const auto v : CGAL::vertices_around_face(mesh.halfedge(f), mesh)) marked[v] = true;
  };
  std::uint32_t place = 0;
  for (const auto f : copy_.mesh.faces())
    if (std::find(unproven.faces.begin(), unproven.faces.end(), place++) != unproven.faces.end()) mark(copy_.mesh, f);
  for (const auto f : start.faces())
    if (std::binary_search(unproven.originals.begin(), unproven.originals.end(), copy_.triangle_of_face[f]))
      mark(start, f);
  for (const auto v : start.vertices()) {
    if (!marked[v]) continue;
    around[v] = true;
    for (const auto h : CGAL::halfedges_around_target(start.halfedge(v), start)) around[start.source(h)] = true;
  }
  return around;
}

std::vector<std::uint32_t> CollapseRun::uncovered() const {
  return monitor_ ? monitor_->uncovered() : std::vector<std::uint32_t>();
}

CollapseRun::Monitor::Counts CollapseRun::counts() const {
  Monitor::Counts counts = monitor_ ? monitor_->counts() : Monitor::Counts();
  counts += counts_of_parts_;
  counts.performed += estimated_.performed;
  return counts;
}

TrackerStats CollapseRun::stats() const {
  TrackerStats stats = stats_of_parts_;
  if (monitor_) stats += monitor_->tracker().stats();
  return stats;
}

EndedBy CollapseRun::run(const CollapseGoal& goal) {
  goal_ = goal;
  stop_checks_ = 0;  // the first look is at the first collapse: without any time there is none
  ended_by_.reset();
  estimated_work_ = 0;
  if (!monitor_) estimate();
  monitor_->grow_tolerance(goal.tolerance - goal.room);
  prune();
  const std::uint64_t before = work() - std::exchange(work_of_parts_, 0);
  if (!ended_by_) passes_until_nothing_fits();
  work_of_run_ = estimated_work_ + work() - before;
  if (options_.effort == Effort::High && options_.on_exceed == OnExceed::Skip && !ended_by_) refine(work_of_run_);
  if (!ended_by_) prune();
  return ended_by_.value_or(EndedBy::NothingFits);
}

/// Before the passes, while the other components are still as the original has them, and once more after.
void CollapseRun::prune() {
  if (!options_.prune) return;
  const Monitor::Dropped dropped = monitor_->drop_components(goal_.target_faces);
  pruned_.components += dropped.components;
  pruned_.faces += dropped.faces;
}

void CollapseRun::passes_until_nothing_fits() {
  for (;;) {
    const std::size_t before = monitor_->faces();
    pass();
    if (ended_by_ || options_.effort == Effort::Fast) return;
    const std::size_t removed = before - monitor_->faces();
    monitor_->begin_pass();
    if (static_cast<double>(removed) < least_gain_of_pass * static_cast<double>(before)) return;
  }
}

/// Rounds of edits, each followed by passes over the edges that they changed. Work is counted, not timed, so that the
/// result is the same on every machine.
void CollapseRun::refine(std::uint64_t work_of_passes) {
  monitor_->search_placements = true;
  monitor_->begin_pass();
  std::size_t faces = monitor_->faces();
  std::uint64_t looked_at = work(), before = 0;
  const std::uint64_t earliest_end =
      looked_at + std::min(least_refinement * original_.triangles.size(), most_of_least_refinement);
  while (!ended_by_ && work() > before) {
    before = work();
    refinement_->round();
    if (ended_by_) break;
    passes_until_nothing_fits();
    if (work() - looked_at < work_of_passes) continue;
    looked_at = work();
    const auto gain = static_cast<double>(faces - monitor_->faces());
    if (work() >= earliest_end && gain < least_gain_of_refinement * static_cast<double>(faces)) break;
    faces = monitor_->faces();
  }
  monitor_->search_placements = false;
}

void CollapseRun::pass() {
  policies_->stop_by(goal_.stop);
  try {
    collapse_edges(copy_.mesh, monitor_->stop_predicate(), *policies_, monitor_->placement(*policies_), Filter(*this),
                   monitor_->visitor(), kept_parts());
  } catch (const Stopped&) {  // between two collapses
    note_stop();
  }
}

void CollapseRun::note_stop() { ended_by_ = goal_.stop.cancelled() ? EndedBy::Cancelled : EndedBy::TimeLimit; }

bool CollapseRun::must_stop(std::size_t faces) {
  if (ended_by_) return true;
  if (faces <= goal_.target_faces) {
    ended_by_ = EndedBy::Target;
    return true;
  }
  if (stop_checks_ % checks_between_looks == 0 && goal_.stop.stopped()) note_stop();
  if (stop_checks_++ % checks_between_progress == 0) show_progress(faces);
  return ended_by_.has_value();
}

void CollapseRun::show_progress(std::size_t faces) {
  if (!options_.progress) return;
  // Most runs end at a small share of the faces and spend their time on the way there.
  options_.progress(1 - static_cast<double>(faces) / static_cast<double>(original_.triangles.size()));
}

/// The collapse that the monitor has just refused, on a copy: does the whole mesh leave the tolerance by it? The local
/// proof may fail where the bound still holds, with the help of faces that are far along the surface.
bool CollapseRun::truly_exceeds() {
  const Bvh changed(after_refused_collapse());
  DistanceOptions options;
  options.threads = options_.threads;
  options.cancel = goal_.stop.cancel;
  options.budget.seconds = goal_.stop.seconds_left();
  return check_symmetric(monitor_->original_bvh(), changed, goal_.tolerance, options).verdict != Verdict::Within;
}

TriangleMesh CollapseRun::after_refused_collapse() const {
  TriangleMesh soup;
  const auto add = [&](const std::array<Eigen::Vector3d, 3>& corners) {
    const auto first = static_cast<std::uint32_t>(soup.vertices.size());
    soup.vertices.insert(soup.vertices.end(), corners.begin(), corners.end());
    soup.triangles.push_back({first, first + 1, first + 2});
  };
  monitor_->for_each_face_after_refused([&](const std::array<Eigen::Vector3d, 3>& corners) { add(corners); });
  for (const std::uint32_t t : monitor_->uncovered()) {
    const Triangle& corners = original_.triangles[t];
    add({original_.vertices[corners[0]], original_.vertices[corners[1]], original_.vertices[corners[2]]});
  }
  return soup;
}

}  // namespace meshbound::cgal
