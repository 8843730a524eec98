// SPDX-License-Identifier: GPL-3.0-or-later
#include "cgal/collapse_run.h"

#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include <boost/property_map/function_property_map.hpp>
#include <utility>

namespace meshbound::cgal {
namespace {

/// A pass over all edges that removes a smaller share of the faces than this is the last one: what it gains no longer
/// pays for looking at every edge again.
constexpr double least_gain_of_pass = 0.01;

/// Refinement ends where as much work as all passes before it gains less than this share of the faces.
constexpr double least_gain_of_refinement = 0.015;

/// With Effort::Fast, of those that `DeviationMonitor` knows: the middle and the ends of the edge.
constexpr int fast_fallback_placements = 3;

/// Clock and callbacks are looked at once in this many collapses.
constexpr std::uint64_t checks_between_looks = 64;

}  // namespace

class CollapseRun::Filter {
 public:
  explicit Filter(CollapseRun& owner) : owner_(&owner), filter_(owner.monitor_->filter()) {}

  template <class Profile, class OptionalPoint>
  OptionalPoint operator()(const Profile& profile, const OptionalPoint& placement) const {
    const OptionalPoint admitted = filter_(profile, placement);
    if (!admitted && owner_->options_.on_exceed == OnExceed::Stop && owner_->monitor_->last_refusal_by_bound() &&
        owner_->truly_exceeds())
      owner_->ended_by_ = EndedBy::Tolerance;
    return admitted;
  }

 private:
  CollapseRun* owner_;
  Monitor::Filter filter_;
};

CollapseRun::CollapseRun(ManifoldCopy copy, const TriangleMesh& original, const SimplifyOptions& options,
                         const std::vector<bool>& locked)
    : original_(original), options_(options), copy_(std::move(copy)) {
  monitor_.emplace(copy_.mesh, original_, copy_.triangle_of_face, 0.0, get(CGAL::vertex_point, copy_.mesh));
  monitor_->normal_guard = NormalGuard();
  monitor_->preserve_boundary = options.preserve_boundary;
  if (options.effort == Effort::Fast) monitor_->fallback_placements = fast_fallback_placements;
  monitor_->should_stop = [this](std::size_t faces) { return must_stop(faces); };
  if (!locked.empty()) lock_vertices(locked);
  policies_.emplace(options.cost, kept_parts());
  refinement_.emplace(copy_.mesh, *monitor_, [this] { return must_stop(monitor_->faces()); });
}

void CollapseRun::lock_vertices(const std::vector<bool>& locked) {
  monitor_->lock_vertices(boost::make_function_property_map<SurfaceMesh::Vertex_index>(
      [&](SurfaceMesh::Vertex_index v) { return bool(locked[v]); }));
  has_locks_ = true;
}

KeptParts CollapseRun::kept_parts() const {
  KeptParts kept{&copy_.mesh, options_.preserve_boundary, {}};
  if (has_locks_) kept.is_locked = [this](SurfaceMesh::Vertex_index v) { return monitor_->is_locked(v); };
  return kept;
}

EndedBy CollapseRun::run(const CollapseGoal& goal) {
  goal_ = goal;
  stop_checks_ = 0;  // the first look is at the first collapse: without any time there is none
  ended_by_.reset();
  monitor_->grow_tolerance(goal.tolerance - goal.room);
  prune();
  const std::uint64_t before = work();
  passes_until_nothing_fits();
  if (options_.effort == Effort::High && options_.on_exceed == OnExceed::Skip && !ended_by_) refine(work() - before);
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
  while (!ended_by_ && work() > before) {
    before = work();
    refinement_->round();
    if (ended_by_) break;
    passes_until_nothing_fits();
    if (work() - looked_at < work_of_passes) continue;
    looked_at = work();
    if (static_cast<double>(faces - monitor_->faces()) < least_gain_of_refinement * static_cast<double>(faces)) break;
    faces = monitor_->faces();
  }
  monitor_->search_placements = false;
}

void CollapseRun::pass() {
  SMS::edge_collapse(copy_.mesh, monitor_->stop_predicate(),
                     CGAL::parameters::get_cost(*policies_)
                         .get_placement(monitor_->placement(*policies_))
                         .filter(Filter(*this))
                         .visitor(monitor_->visitor())
                         .edge_is_constrained_map(kept_parts()));
}

bool CollapseRun::must_stop(std::size_t faces) {
  if (ended_by_) return true;
  if (faces <= goal_.target_faces) {
    ended_by_ = EndedBy::Target;
    return true;
  }
  if (stop_checks_++ % checks_between_looks != 0) return false;
  if (options_.cancel != nullptr && options_.cancel->load())
    ended_by_ = EndedBy::Cancelled;
  else if (std::chrono::duration<double>(CollapseGoal::Clock::now() - goal_.began).count() >= goal_.seconds)
    ended_by_ = EndedBy::TimeLimit;
  show_progress(faces);
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
  options.cancel = options_.cancel;
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
