// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "mpi/communicator.h"
#include "tiles/tile_jobs.h"

namespace meshbound::mpi {

/// All ranks work on the same jobs: rank 0 hands the next one, heaviest first, to whichever asks, and when all are done
/// each rank, or rank 0 alone where others have no use for them, gets the results of the others. Ranks that are slower,
/// or have heavier jobs, so get fewer of them. The thread that calls `run` hands out and asks, besides `threads` others
/// that work. Every rank throws what a job of some rank has thrown.
class RankRunner : public JobRunner {
 public:
  /// `ranks` must outlive this. `threads`: of this rank; 0 for as many as OpenMP has.
  RankRunner(Communicator& ranks, int threads);
  void run(TileJobs& jobs) override;
  [[nodiscard]] bool is_first() const override { return ranks_.rank() == 0; }
  [[nodiscard]] bool any(bool here) override { return ranks_.any(here); }
  void do_together(const std::function<void()>& step) override { ranks_.do_together(step); }

 private:
  void exchange(TileJobs& jobs, const std::vector<std::pair<std::size_t, std::string>>& done);

  Communicator& ranks_;
  int threads_;
};

}  // namespace meshbound::mpi
