// SPDX-License-Identifier: MIT
#include "distance/search/one_sided_search.h"

#include <omp.h>

#include <algorithm>
#include <cmath>

#include "distance/shortcuts/identical.h"
#include "numeric/rounding.h"
#include "numeric/tasks.h"
#include "numeric/thread_count.h"

namespace meshbound {
namespace {

constexpr std::chrono::milliseconds between_progress{100};

double scaled(double length, int exponent) { return next_up(std::ldexp(length, exponent)); }

/// Working units: far beyond the distances between models that fit a frame (`max_magnitude`), with a square that is far
/// from overflowing.
constexpr double beyond_all_distances = 0x1p100;

Goal make_goal(const OneSidedTask& task, const Mapping& map) {
  const Frame& from = task.a.bvh->data().frame;
  const Frame& to = task.b.bvh->data().frame;
  Goal goal;
  goal.error_bound = std::min(to.working_length_down(task.error_bound), beyond_all_distances);
  goal.tolerance = std::min(to.working_length_down(task.tolerance), beyond_all_distances);
  goal.decide_only = task.decide_only;
  const double model_error = (from.error > 0 ? scaled(from.error, from.exponent - to.exponent) : 0) + to.error;
  set_slack(goal, map.magnitude, model_error + map.error);
  goal.stop = StopToken{.cancel = task.options.cancel}.until(task.start, task.options.budget.seconds);
  return goal;
}

/// Where both models are small a search is over before another thread has woken up.
constexpr std::size_t triangles_per_thread = 1024;

int useful_threads(const OneSidedTask& task) {
  const int wanted = thread_count(task.options.threads);
  const std::size_t larger = std::max(task.a.bvh->triangle_count(), task.b.bvh->triangle_count());
  return static_cast<int>(std::min<std::size_t>(static_cast<std::size_t>(wanted), 1 + larger / triangles_per_thread));
}

}  // namespace

OneSidedSearch::OneSidedSearch(const OneSidedTask& task, const Mapping& map)
    : task_(task),
      a_(task.a.bvh->data()),
      b_(task.b.bvh->data()),
      map_(map),
      goal_(make_goal(task, map)),
      recorder_(task.memory, b_, goal_),
      has_hints_(task.memory != nullptr),
      cuts_left_(task.options.budget.subdivisions),
      last_progress_(task.start) {
  for (int i = 0; i < useful_threads(task); ++i) kernels_.push_back(make_search_kernel(b_, goal_));
  if (task.memory != nullptr) task.memory->front.is_new = false;
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

void OneSidedSearch::offer_lower(const LowerBound& lower) {
  if (lower.lower > lower_.lower) lower_ = own_lower_ = lower;
}

void OneSidedSearch::offer_upper_squared(double squared) { upper_squared_ = std::max(upper_squared_, squared); }

void OneSidedSearch::offer_known_upper(double upper) { known_upper_ = std::max(known_upper_, upper); }

void OneSidedSearch::note_vertex(std::uint32_t v, const Nearest& nearest) {
  if (!(nearest.squared > farthest_nearest_.squared)) return;
  farthest_nearest_ = nearest;
  farthest_vertex_ = v;
}

void OneSidedSearch::offer_vertex(std::uint32_t v, const Nearest& nearest) {
  note_vertex(v, nearest);
  SearchKernel& kernel = begin_own_batch();
  kernel.offer(vertex(v), nearest, no_slot);
  if (!(kernel.lower().lower > lower_.lower)) return;
  offer_lower(kernel.lower());
  lower_.from_slot = own_lower_.from_slot = slot_using_vertex(a_, v);
}

SearchKernel& OneSidedSearch::begin_own_batch() {
  SearchKernel& kernel = *kernels_.front();
  kernel.begin(lower_);
  return kernel;
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
  if (!task_.options.progress || StopToken::Clock::now() - last_progress_ < between_progress) return;
  last_progress_ = StopToken::Clock::now();
  task_.options.progress(fraction);
}

std::vector<OpenTriangle> OneSidedSearch::run_chunks(std::uint32_t count, const Batches& batches,
                                                     const ChunkWork& work) {
  const std::uint32_t chunks = (count + batches.per_chunk - 1) / batches.per_chunk;
  std::vector<OpenTriangle> open;
  std::vector<Found> found;
  std::uint32_t batch = batches.first;
  for (std::uint32_t first = 0; first < chunks && !decided(); batch = std::min(2 * batch, batches.max_chunks)) {
    const std::uint32_t size = std::min(batch, chunks - first);
    found.assign(size, {});
    out_of_budget();
    for_each_task(size, [&](std::size_t i) {
      SearchKernel& kernel = own_kernel();
      kernel.begin(lower_);
      const std::uint32_t begin = (first + static_cast<std::uint32_t>(i)) * batches.per_chunk;
      work(kernel, begin, std::min(count, begin + batches.per_chunk), found[i]);
      found[i].lower = kernel.lower();
      found[i].upper_squared = kernel.upper_squared();
    });
    std::uint32_t farthest = 0;
    for (std::uint32_t i = 0; i < size; ++i) {
      offer_lower(found[i].lower);
      offer_upper_squared(found[i].upper_squared);
      stats_.walked += found[i].walks;
      if (found[i].farthest.squared > found[farthest].farthest.squared) farthest = i;
      open.insert(open.end(), found[i].open.begin(), found[i].open.end());
      recorder_.covers(found[i].covers);
    }
    spend_cuts();
    if (found[farthest].farthest.squared >= 0) offer_vertex(found[farthest].farthest_vertex, found[farthest].farthest);
    first += size;
    report_progress(batches.from + (batches.to - batches.from) * first / chunks);
  }
  return open;
}

}  // namespace meshbound
