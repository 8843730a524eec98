// SPDX-License-Identifier: MIT
#include "distance/search/one_sided_search.h"

#include <omp.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "bvh/build.h"
#include "distance/shortcuts/identical.h"
#include "numeric/rounding.h"
#include "numeric/tasks.h"

namespace meshbound {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint32_t vertices_per_chunk = 256;   ///< hints are handed on inside a chunk, so not too few
constexpr std::uint32_t triangles_per_chunk = 256;  ///< cheap bounds
constexpr std::uint32_t swept_per_chunk = 512;      ///< each begins with a query
constexpr std::uint32_t walks_per_chunk = 8;        ///< walks differ much in cost
constexpr std::ptrdiff_t worst_first = 256;  ///< walks in the order of their bounds; a few of them set the lower bound
constexpr std::uint32_t probes = 64;
constexpr std::uint32_t probed_centroids = 16;
constexpr std::uint32_t probes_per_chunk = 16;  ///< as vertices
constexpr std::chrono::milliseconds between_progress{100};

/// Queries, or triangles of a sweep, between two looks at the clock: each may take a tenth of a millisecond where
/// thousands of triangles are equally near.
constexpr std::uint32_t steps_between_looks = 16;

double scaled(double length, int exponent) { return next_up(std::ldexp(length, exponent)); }

Goal make_goal(const OneSidedTask& task, const Mapping& map) {
  const Frame& from = task.a.bvh->data().frame;
  const Frame& to = task.b.bvh->data().frame;
  Goal goal;
  goal.error_bound = to.working_length_down(task.error_bound);
  goal.tolerance = to.working_length_down(task.tolerance);
  goal.decide_only = task.decide_only;
  const double model_error = (from.error > 0 ? scaled(from.error, from.exponent - to.exponent) : 0) + to.error;
  set_slack(goal, map.magnitude, model_error + map.error);
  goal.cancel = task.options.cancel;
  if (task.options.budget.seconds < 1e9)  // about 30 years: beyond it there is no deadline, and no overflow
    goal.deadline = task.start + std::chrono::duration_cast<Clock::duration>(
                                     std::chrono::duration<double>(task.options.budget.seconds));
  return goal;
}

/// Where both models are small a search is over before another thread has woken up.
constexpr std::size_t triangles_per_thread = 1024;

int thread_count(const OneSidedTask& task) {
  const int most = task.options.threads > 0 ? task.options.threads : omp_get_max_threads();
  const std::size_t larger = std::max(task.a.bvh->triangle_count(), task.b.bvh->triangle_count());
  return static_cast<int>(std::min<std::size_t>(static_cast<std::size_t>(most), 1 + larger / triangles_per_thread));
}

}  // namespace

OneSidedSearch::OneSidedSearch(const OneSidedTask& task, const Mapping& map)
    : task_(task),
      a_(task.a.bvh->data()),
      b_(task.b.bvh->data()),
      map_(map),
      goal_(make_goal(task, map)),
      scale_to_model_(std::ldexp(1.0, b_.frame.exponent)),
      known_lower_(0),
      cuts_left_(task.options.budget.subdivisions),
      last_progress_(task.start) {
  for (int i = 0; i < thread_count(task); ++i) kernels_.push_back(make_search_kernel(b_, goal_));
  raise_known_lower(task.known_lower);
  stats_.triangles = a_.triangle_count();
}

void OneSidedSearch::raise_known_lower(double lower) {
  if (!(lower > known_lower_)) return;
  known_lower_ = lower;
  const double working = b_.frame.working_length_down(lower);
  if (working > lower_.lower) lower_.lower = working;
}

double OneSidedSearch::proven_lower() const { return b_.frame.length_down(std::max(0.0, own_lower_.lower)); }

void OneSidedSearch::run(void (OneSidedSearch::*step)(), double PhaseSeconds::*phase) {
  const Clock::time_point start = Clock::now();
  (this->*step)();
  stats_.phases.*phase += std::chrono::duration<double>(Clock::now() - start).count();
}

SearchKernel& OneSidedSearch::own_kernel() const { return *kernels_[static_cast<std::size_t>(omp_get_thread_num())]; }

bool OneSidedSearch::out_of_budget() {
  if (exhausted_) return true;
  exhausted_ = cuts_left_ == 0 || goal_.out_of_time();
  return exhausted_;
}

void OneSidedSearch::spend_cuts() {
  std::uint64_t cuts = 0;
  for (const auto& kernel : kernels_) cuts += kernel->counters().cuts;
  const std::uint64_t budget = task_.options.budget.subdivisions;
  cuts_left_ = cuts < budget ? budget - cuts : 0;
}

void OneSidedSearch::report_progress(double fraction) {
  if (!task_.options.progress || Clock::now() - last_progress_ < between_progress) return;
  last_progress_ = Clock::now();
  task_.options.progress(fraction);
}

void OneSidedSearch::merge(const Found& found) {
  if (found.lower.lower > lower_.lower) {
    lower_ = found.lower;
    own_lower_ = found.lower;
  }
  upper_squared_ = std::max(upper_squared_, found.upper_squared);
}

/// Runs work(kernel, chunk, found) for chunks 0 ... count - 1, in batches that grow from `batch` to `largest_batch`:
/// the lower bound that a batch starts from is the one of all batches before it.
template <class Work>
void OneSidedSearch::run_chunks(std::uint32_t count, std::uint32_t batch, std::uint32_t largest_batch, double from,
                                double to, Work&& work) {
  std::vector<Found> found;
  for (std::uint32_t begin = 0; begin < count && !decided(); batch = std::min(2 * batch, largest_batch)) {
    const std::uint32_t size = std::min(batch, count - begin);
    found.assign(size, {});
    out_of_budget();
    for_each_task(size, [&](std::size_t i) {
      SearchKernel& kernel = own_kernel();
      kernel.begin(lower_);
      work(kernel, begin + static_cast<std::uint32_t>(i), found[i]);
      found[i].lower = kernel.lower();
      found[i].upper_squared = kernel.upper_squared();
    });
    std::uint32_t farthest = 0;
    for (std::uint32_t i = 0; i < size; ++i) {
      merge(found[i]);
      stats_.walked += found[i].walks;
      if (found[i].farthest_squared > found[farthest].farthest_squared) farthest = i;
      open_.insert(open_.end(), found[i].open.begin(), found[i].open.end());
      remember_walk(found[i]);
    }
    spend_cuts();
    if (found[farthest].farthest_squared >= 0) {
      const VertexNearest& nearest = nearest_[found[farthest].farthest_vertex];
      offer_vertex(found[farthest].farthest_vertex, {nearest.squared, nearest.slot});
    }
    begin += size;
    report_progress(from + (to - from) * begin / count);
  }
}

/// Raises the lower bound by a vertex, if it is further than all before it.
void OneSidedSearch::offer_vertex(std::uint32_t v, const Nearest& nearest) {
  if (nearest.squared > farthest_nearest_.squared) {
    farthest_nearest_ = nearest;
    farthest_vertex_ = v;
  }
  SearchKernel& kernel = *kernels_.front();
  kernel.begin(lower_);
  kernel.offer(vertex(v), nearest, no_slot);
  if (kernel.lower().lower > lower_.lower) {
    lower_ = own_lower_ = kernel.lower();
    lower_.from_slot = own_lower_.from_slot = slot_using_vertex(a_, v);
  }
}

/// Whether B has one of a few triangles of A: comparing all costs as much as bounding them.
bool OneSidedSearch::sample_is_identical() {
  const std::uint32_t n = a_.triangle_count(), samples = std::min(probes, n);
  SearchKernel& kernel = *kernels_.front();
  std::uint32_t hint = 0;
  for (std::uint32_t i = 0; i < samples; ++i) {
    const auto slot = static_cast<std::uint32_t>(std::uint64_t{i} * n / samples);
    hint = kernel.nearest(centroid(slot), hint, 0).slot;
    if (same_triangle(a_, a_.corners[slot], b_, b_.corners[hint])) return true;
  }
  return false;
}

void OneSidedSearch::drop_identical() {
  const bool exact = map_.is_identity && map_.error == 0 && a_.frame.error == 0 && b_.frame.error == 0;
  if (!exact || !probe_on_b_ || !sample_is_identical()) return;
  alive_.assign(a_.triangle_count(), 1);
  stats_.matched = drop_identical_triangles(a_, b_, alive_);
}

void OneSidedSearch::probe() {
  probe_start();
  const std::size_t n = a_.vertices.size(), count = std::min<std::size_t>(probes, n);
  const auto probed = [&](std::size_t i) { return static_cast<std::uint32_t>(i * n / count); };
  std::array<Nearest, probes> nearest;
  for_each_range(count, probes_per_chunk, [&](std::size_t begin, std::size_t end) {
    std::uint32_t hint = 0;
    for (std::size_t i = begin; i < end; ++i) {
      nearest[i] = own_kernel().nearest(vertex(probed(i)), hint, 0);
      hint = nearest[i].slot;
    }
  });
  std::size_t farthest = 0;
  for (std::size_t i = 0; i < count; ++i) {
    probe_on_b_ = probe_on_b_ || nearest[i].squared <= goal_.slack * goal_.slack;
    if (nearest[i].squared > nearest[farthest].squared) farthest = i;
  }
  offer_vertex(probed(farthest), nearest[farthest]);
  probe_centroids();
}

/// The vertices of a mesh that was simplified lie on the original, its triangles do not.
void OneSidedSearch::probe_centroids() {
  const std::uint32_t n = a_.triangle_count(), count = probed_centroids;
  if (n < count) return;  // a search of them all costs no more
  SearchKernel& kernel = *kernels_.front();
  kernel.begin(lower_);
  std::uint32_t hint = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto slot = static_cast<std::uint32_t>(std::uint64_t{i} * n / count);
    const Vec3 p = centroid(slot);
    const Nearest nearest = kernel.nearest(p, hint, 0);
    hint = nearest.slot;
    kernel.offer(p, nearest, slot);
  }
  if (kernel.lower().lower > lower_.lower) lower_ = own_lower_ = kernel.lower();
}

void OneSidedSearch::sweep_chunk(SearchKernel& kernel, std::uint32_t begin, std::uint32_t end, Found& found) {
  // Tries that fail cost about as much as a query does, so they end where most of them fail.
  int worth_testing = 32, worth_walking = 16, queries = 4;
  std::uint32_t hint = no_slot;
  CoverRecord record;
  record.names_all = task_.memory != nullptr && task_.memory->names_faces;
  kernel.record_in(task_.memory != nullptr ? &record : nullptr);
  for (std::uint32_t i = begin; i < end; ++i) {
    const std::uint32_t slot = culled_ ? left_[i] : i;
    if (!is_alive(slot)) continue;
    if (i % steps_between_looks == 0 && goal_.out_of_time()) worth_testing = 0;
    if (worth_testing <= 0) {
      found.open.push_back({0, slot, no_slot});
      continue;
    }
    const Triangle& t = a_.corners[slot];
    const TriangleCorners corners{vertex(t[0]), vertex(t[1]), vertex(t[2])};
    const auto ask = [&] {
      --queries;
      hint = kernel.nearest((1.0 / 3) * (corners[0] + corners[1] + corners[2]), hint == no_slot ? 0 : hint, 0).slot;
    };
    if (hint == no_slot) ask();
    record.clear();
    const std::uint64_t cuts = worth_walking > 0 ? cuts_left_ : 0;
    Swept swept = kernel.sweep(corners, hint, cuts);
    if (swept == Swept::NotNear && queries > 0) {
      ask();
      swept = kernel.sweep(corners, hint, cuts);
    }
    if (swept == Swept::ByOneTriangle || swept == Swept::ByWalk) {
      worth_testing += 2;
      if (swept == Swept::ByWalk) ++found.walks, ++worth_walking;
      if (task_.memory != nullptr) remember_cover(slot, record, found);
      continue;
    }
    --worth_testing;
    if (swept == Swept::NotAtAll) worth_walking -= 2;
    found.open.push_back({0, slot, no_slot});
  }
  kernel.record_in(nullptr);
}

void OneSidedSearch::sweep() {
  if (decided() || culled_ || exhausted_) return;
  const std::uint32_t n = a_.triangle_count();
  const std::uint32_t chunks = (n + swept_per_chunk - 1) / swept_per_chunk;
  run_chunks(chunks, 256, 256, 0.0, 0.1, [&](SearchKernel& kernel, std::uint32_t chunk, Found& found) {
    const std::uint32_t begin = chunk * swept_per_chunk;
    sweep_chunk(kernel, begin, std::min(n, begin + swept_per_chunk), found);
  });
  left_.reserve(open_.size());
  for (const Open& open : open_) left_.push_back(open.slot);
  open_.clear();
  culled_ = true;
}

/// The vertices of the triangles that are left. Their number decides the cost where whole nodes were culled: there
/// flags would touch all vertices for nothing.
void OneSidedSearch::list_wanted_vertices() {
  if (!some_dropped()) return;
  if (!culled_)
    for (std::uint32_t slot = 0; slot < a_.triangle_count(); ++slot)
      if (is_alive(slot)) left_.push_back(slot);
  culled_ = true;
  if (left_.size() > a_.vertices.size() / 16) {
    std::vector<std::uint8_t> wanted(a_.vertices.size(), 0);
    for (const std::uint32_t slot : left_)
      for (const std::uint32_t v : a_.corners[slot]) wanted[v] = 1;
    for (std::uint32_t v = 0; v < wanted.size(); ++v)
      if (wanted[v] != 0) wanted_.push_back(v);
    return;
  }
  wanted_.reserve(3 * left_.size());
  for (const std::uint32_t slot : left_)
    wanted_.insert(wanted_.end(), a_.corners[slot].begin(), a_.corners[slot].end());
  std::sort(wanted_.begin(), wanted_.end());
  wanted_.erase(std::unique(wanted_.begin(), wanted_.end()), wanted_.end());
}

void OneSidedSearch::query_chunk(SearchKernel& kernel, std::uint32_t begin, std::uint32_t end, Found& found) {
  std::uint32_t hint = 0;
  bool hurried = exhausted_;
  for (std::uint32_t i = begin; i < end; ++i) {
    const std::uint32_t v = culled_ ? wanted_[i] : i;
    if (i % steps_between_looks == 0) hurried = hurried || goal_.out_of_time();
    if (const std::uint32_t before = hint_before(task_.memory, v); before != no_slot) hint = before;
    const double enough = hurried ? std::numeric_limits<double>::infinity() : kernel.accepted_squared();
    const Nearest nearest = kernel.nearest(vertex(v), hint, enough);
    nearest_[v] = {nearest.squared, nearest.slot};
    hint = nearest.slot;
    if (!hurried && nearest.squared > found.farthest_squared) {
      found.farthest_squared = nearest.squared;
      found.farthest_vertex = v;
    }
  }
}

void OneSidedSearch::query_vertices() {
  if (decided()) return;
  list_wanted_vertices();
  const auto all = static_cast<std::uint32_t>(a_.vertices.size());
  nearest_ = std::make_unique_for_overwrite<VertexNearest[]>(all);
  const std::uint32_t n = culled_ ? static_cast<std::uint32_t>(wanted_.size()) : all;
  const std::uint32_t chunks = (n + vertices_per_chunk - 1) / vertices_per_chunk;
  run_chunks(chunks, 4, 256, 0.0, 0.2, [&](SearchKernel& kernel, std::uint32_t chunk, Found& found) {
    const std::uint32_t begin = chunk * vertices_per_chunk;
    query_chunk(kernel, begin, std::min(n, begin + vertices_per_chunk), found);
  });
}

void OneSidedSearch::bound_chunk(SearchKernel& kernel, std::uint32_t begin, std::uint32_t end, Found& found) {
  for (std::uint32_t i = begin; i < end; ++i) {
    const std::uint32_t slot = culled_ ? left_[i] : i;
    const Triangle& t = a_.corners[slot];
    const Vec3 corner[3] = {vertex(t[0]), vertex(t[1]), vertex(t[2])};
    double bound = std::numeric_limits<double>::infinity();
    int worst = 0;
    std::uint32_t nearest_to_all = 0;
    for (int k = 0; k < 3 && bound > kernel.accepted_squared(); ++k) {
      if (nearest_[t[k]].squared > nearest_[t[worst]].squared) worst = k;
      const std::uint32_t candidate = nearest_[t[k]].slot;
      if (k > 0 && (candidate == nearest_[t[0]].slot || (k == 2 && candidate == nearest_[t[1]].slot))) continue;
      const double squared = kernel.farthest_squared(corner[0], corner[1], corner[2], candidate);
      if (squared < bound) {
        bound = squared;
        nearest_to_all = candidate;
      }
    }
    remember(slot, bound, nearest_to_all);
    if (bound <= kernel.accepted_squared() || exhausted_)
      kernel.accept(bound);
    else
      found.open.push_back({bound, slot, nearest_[t[worst]].slot});
  }
}

void OneSidedSearch::bound_triangles() {
  if (decided()) return;
  const std::uint32_t n = culled_ ? static_cast<std::uint32_t>(left_.size()) : a_.triangle_count();
  const std::uint32_t chunks = (n + triangles_per_chunk - 1) / triangles_per_chunk;
  run_chunks(chunks, 256, 256, 0.2, 0.3, [&](SearchKernel& kernel, std::uint32_t chunk, Found& found) {
    const std::uint32_t begin = chunk * triangles_per_chunk;
    bound_chunk(kernel, begin, std::min(n, begin + triangles_per_chunk), found);
  });
}

void OneSidedSearch::refine_chunk(SearchKernel& kernel, std::uint32_t begin, std::uint32_t end, Found& found) {
  for (std::uint32_t i = begin; i < end; ++i) {
    const Open& open = open_[i];
    if (open.bound_squared <= kernel.accepted_squared() || exhausted_ || goal_.out_of_time()) {
      kernel.accept(open.bound_squared);
      continue;
    }
    const Triangle& t = a_.corners[open.slot];
    const Vec3 a = vertex(t[0]), b = vertex(t[1]), c = vertex(t[2]);
    if (task_.options.method == Method::CrossCulling) {
      kernel.subdivide({a, b, c}, open.slot, open.bound_squared, cuts_left_);
      continue;
    }
    // The centroid breaks the ties of corners, which many triangles of B share.
    const Nearest start = kernel.nearest((1.0 / 3) * (a + b + c), open.start, kernel.accepted_squared());
    if (task_.memory == nullptr)
      kernel.cover(a, b, c, open.slot, start.slot, cuts_left_);
    else
      cover_and_record(kernel, open.slot, start.slot, found);
  }
}

/// The worst first, to raise the lower bound early; the rest in the order of the curve, where neighbours share what is
/// in the cache.
void OneSidedSearch::sort_open() {
  const auto worse = [](const Open& x, const Open& y) {
    return x.bound_squared != y.bound_squared ? x.bound_squared > y.bound_squared : x.slot < y.slot;
  };
  const auto middle = open_.begin() + std::min<std::ptrdiff_t>(worst_first, std::ssize(open_));
  std::partial_sort(open_.begin(), middle, open_.end(), worse);
  std::sort(middle, open_.end(), [](const Open& x, const Open& y) { return x.slot < y.slot; });
}

void OneSidedSearch::refine_rest() {
  if (decided()) return;
  sort_open();
  const auto n = static_cast<std::uint32_t>(open_.size());
  stats_.walked += n;
  const std::uint32_t chunks = (n + walks_per_chunk - 1) / walks_per_chunk;
  run_chunks(chunks, 1, 512, 0.3, 1.0, [&](SearchKernel& kernel, std::uint32_t chunk, Found& found) {
    const std::uint32_t begin = chunk * walks_per_chunk;
    refine_chunk(kernel, begin, std::min(n, begin + walks_per_chunk), found);
  });
}

}  // namespace meshbound
