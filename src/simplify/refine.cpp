// SPDX-License-Identifier: MIT
#include "simplify/refine.h"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "geometry/triangle_corners.h"
#include "numeric/first_error.h"
#include "numeric/tasks.h"
#include "simplify/lower_deviation.h"
#include "simplify/mesh/edge_queue.h"
#include "simplify/region_collapses.h"
#include "simplify/relaxed_collapse.h"

namespace meshbound {
namespace {

/// Vertices of a region at least.
constexpr std::size_t min_vertices_refined = 1000;

/// A round that removes a smaller share of the faces is the last one, but for the first round. With three rounds at
/// least `high` takes 1.17 of the time for 0.8% fewer faces (13 meshes at 0.1%).
constexpr double min_gain_of_round = 0.025;
constexpr int min_refine_rounds = 2, max_refine_rounds = 12;

/// From the second round on, a shaken vertex is moved this share of the way to the mean of its neighbours, plus a
/// random offset of up to `jitter` times an edge. Without this the search ends in the next local minimum, with 5 to 8%
/// more faces.
constexpr double way_to_middle = 0.2, jitter = 0.3;
/// Attempts along a random edge where a shake breaks the bound, as nearly every other way does at creases. With one or
/// two shorter ways tried before, a round takes 1.05 and 1.09 of the time for 0.1% fewer faces (13 meshes at 0.1%).
constexpr int max_slides = 2;
constexpr double max_slide = 0.4;

/// This share of the edges is flipped whatever that gains: on plane faces every triangulation is as good as another,
/// but not every one has room for the next collapse.
constexpr double share_of_random_flips = 0.1;

/// A move that lowers the deviation by a smaller share is not worth its proof: with 0.02 three rounds take 1.05 of the
/// time and leave as many faces, with 0.2 they take 0.96 and leave 0.3% more (13 meshes at 0.1%).
constexpr double min_move_gain = 0.1;

/// Refines one region after another. One for each thread.
class Refiner {
 public:
  Refiner(DecimationState& state, Proposer& proposer, ChangeProver& prover)
      : state_(state), proposer_(proposer), prover_(prover), edit_(state), relaxed_(state, edit_, prover_) {}

  struct Task {
    std::vector<std::uint32_t> vertices;  ///< of the region
    std::size_t max_removed = 0;          ///< faces
    std::function<bool()> stop;
  };
  void round(const Split& split, Region& region, int round, const Task& task) {
    split_ = &split, region_ = &region, task_ = &task;
    edit_.enter(split, region);
    random_.seed(static_cast<std::uint64_t>(round) << 32 | region.id);
    if (round > 0) {
      shake();
      flip_at_random();
    }
    flip();
    relocate();
    flip();
    RegionCollapses(state_, split, region, proposer_, &prover_, {1, [&](std::size_t) { return is_done(); }, nullptr})
        .collapse_all();
    collapse_relaxed();
  }

 private:
  [[nodiscard]] bool is_done() const { return region_->removed_faces >= task_->max_removed || task_->stop(); }
  template <class Change>
  void for_each_vertex(const Change& change) {
    for (const std::uint32_t v : task_->vertices) {
      if (is_done()) return;
      if (state_.mesh.is_vertex(v)) change(v);
    }
  }
  template <class Change>
  void for_each_edge(const Change& change) {
    edges_.clear();
    for (const std::uint32_t v : task_->vertices) {
      if (!state_.mesh.is_vertex(v)) continue;
      state_.mesh.for_each_corner(v, [&](Corner c) {
        if (state_.mesh.edge(c) == c) edges_.push_back(c);
        return true;
      });
    }
    for (const Corner edge : edges_) {
      if (is_done()) return;
      change(edge);
    }
  }

  /// Makes the change that has been placed, if it can be proven.
  bool make() {
    if (!edit_.fits(1)) return false;
    edit_.make();
    if (!prover_.prove_or_undo(*split_, *region_, edit_.changed_faces())) return false;
    edit_.assign_samples();
    return true;
  }

  void shake() {
    for_each_vertex([&](std::uint32_t v) { shake(v); });
  }
  void shake(std::uint32_t vertex);
  void relocate() {
    for_each_vertex([&](std::uint32_t v) { relocate(v); });
  }
  void relocate(std::uint32_t vertex) {
    if (!edit_.gather_move(vertex)) return;
    (void)edit_.place(edit_.origin());
    const LoweredDeviation found = lower_deviation(edit_, edit_.origin(), state_.tolerance, {});
    if (found.lowest.sum < (1 - min_move_gain) * found.before) (void)make();
  }
  void flip_at_random() {
    for_each_edge([&](Corner edge) {
      if (std::abs(uniform()) < share_of_random_flips && edit_.gather_flip(edge) && edit_.place_flipped()) (void)make();
    });
  }
  void flip() {
    for_each_edge([&](Corner edge) {
      if (edit_.flip_lowers_deviation(edge)) (void)make();
    });
  }
  void collapse_relaxed();

  double uniform() { return static_cast<double>(random_() >> 11) * 0x1p-52 - 1; }  ///< in -1 to 1

  DecimationState& state_;
  const Split* split_ = nullptr;
  Region* region_ = nullptr;
  const Task* task_ = nullptr;
  Proposer& proposer_;
  ChangeProver& prover_;
  LocalEdit edit_;
  RelaxedCollapse relaxed_;
  std::vector<Corner> edges_, around_;
  std::mt19937_64 random_;  ///< the standard fixes what it yields, so results are the same everywhere
};

void Refiner::shake(std::uint32_t vertex) {
  if (!edit_.gather_move(vertex)) return;
  const Vec3 p = edit_.origin();
  const std::size_t degree = edit_.faces().size();
  const double part = 1 / static_cast<double>(degree);
  Vec3 middle{0, 0, 0}, normal{0, 0, 0};
  double mean_edge = 0;
  for (const TriangleCorners& c : edit_.faces()) {
    middle = middle + part * c[1];
    normal = normal + cross(c[1] - p, c[2] - p);
    mean_edge += part * length(c[1] - p);
  }
  const double norm = length(normal);
  if (!(norm > 0)) return;
  normal = (1 / norm) * normal;
  const double x = uniform(), y = uniform(), z = uniform();
  Vec3 way = way_to_middle * (middle - p) + jitter * mean_edge * Vec3{x, y, z};
  way = way - dot(way, normal) * normal;
  if (edit_.place(p + way) && make()) return;
  for (int attempt = 0; attempt < max_slides; ++attempt) {
    const Vec3 end = edit_.faces()[random_() % degree][1];
    if (edit_.place(p + max_slide * std::abs(uniform()) * (end - p)) && make()) return;
  }
}

void Refiner::collapse_relaxed() {
  const ArrayMesh& mesh = state_.mesh;
  EdgeQueue queue(state_.notes);
  for_each_edge([&](Corner edge) {
    if (split_->owns(region_->id, mesh.end(edge))) queue.put(edge, edge_cost(state_, edge, 1).cost);
  });
  while (!queue.empty() && !is_done()) {
    const Corner edge = queue.pop();
    if (mesh.is_removed(edge / 3)) continue;  // flips renumber edges
    const std::uint32_t kept = mesh.start(edge);
    around_.clear();
    for (const std::uint32_t v : {kept, mesh.end(edge)}) mesh.for_each_edge(v, [&](Corner e) { around_.push_back(e); });
    if (!relaxed_.run(*split_, *region_, edge)) continue;
    for (const Corner e : around_) queue.erase(e);
    mesh.for_each_edge(kept, [&](Corner e) { queue.put(e, edge_cost(state_, e, 1).cost); });
  }
}

std::vector<Refiner::Task> tasks(const DecimationState& state, const Split& regions, const RefinementGoal& goal) {
  std::vector<Refiner::Task> tasks(regions.regions.size());
  for (Refiner::Task& task : tasks) {
    task.max_removed = (state.faces - goal.target_faces + tasks.size() - 1) / tasks.size();
    task.stop = goal.stop;
  }
  for (std::uint32_t v = 0; v < state.mesh.vertex_count(); ++v)
    if (state.mesh.is_vertex(v)) tasks[regions.region_of.empty() ? 0 : regions.region_of[v]].vertices.push_back(v);
  return tasks;
}

/// One round over all regions, each by one thread. Each round is cut elsewhere than the one before.
void refine_round(DecimationState& state, const std::vector<std::unique_ptr<Refiner>>& refiners, int round,
                  const RefinementGoal& goal) {
  const auto threads = static_cast<int>(refiners.size());
  Split regions = split(state, round % shifts_of_split, min_vertices_refined, threads);
  const std::vector<Refiner::Task> work = tasks(state, regions, goal);
  FirstError error;
  on_any_thread(threads, work.size(), [&](std::size_t r) {
    error.guard([&] {
      refiners[static_cast<std::size_t>(omp_get_thread_num())]->round(regions, regions.regions[r], round, work[r]);
    });
  });
  error.rethrow();
  merge(state, std::move(regions));
}

}  // namespace

void refine(DecimationState& state, const RefinementGoal& goal, DecimationThreads& threads) {
  std::vector<std::unique_ptr<Refiner>> refiners;
  for (std::size_t k = 0; k < threads.proposers.size(); ++k)
    refiners.push_back(std::make_unique<Refiner>(state, *threads.proposers[k], *threads.provers[k]));
  for (int round = 0; round < max_refine_rounds && state.faces > goal.target_faces && !goal.stop(); ++round) {
    const std::size_t before = state.faces;
    refine_round(state, refiners, round, goal);
    const auto gain = static_cast<double>(before - state.faces);
    if (round + 1 >= min_refine_rounds && gain < min_gain_of_round * static_cast<double>(before)) break;
  }
}

}  // namespace meshbound
