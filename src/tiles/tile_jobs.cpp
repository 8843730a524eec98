// SPDX-License-Identifier: MIT
#include "tiles/tile_jobs.h"

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <numeric>

#include "numeric/first_error.h"
#include "numeric/tasks.h"
#include "numeric/thread_count.h"

namespace meshbound {

std::vector<std::size_t> heaviest_first(const TileJobs& jobs) {
  std::vector<std::uint64_t> weights(jobs.size());
  for (std::size_t job = 0; job < weights.size(); ++job) weights[job] = jobs.weight(job);
  std::vector<std::size_t> order(jobs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return weights[i] > weights[j]; });
  return order;
}

ThreadRunner::ThreadRunner(int threads) : threads_(thread_count(threads)) {}

void ThreadRunner::run(TileJobs& jobs) {
  const std::vector<std::size_t> order = heaviest_first(jobs);
  std::uint64_t all = 0;
  for (const std::size_t job : order) all += jobs.weight(job);
  std::atomic<std::uint64_t> done = 0;
  FirstError error;
  on_any_thread(threads_, order.size(), [&](std::size_t i) {
    if (error.has_error()) return;
    error.guard([&] {
      jobs.run(order[i]);
      done += jobs.weight(order[i]);
      if (omp_get_thread_num() == 0) jobs.progress(static_cast<double>(done) / static_cast<double>(all));
    });
  });
  error.rethrow();
}

}  // namespace meshbound
