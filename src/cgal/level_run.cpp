// SPDX-License-Identifier: GPL-3.0-or-later
#include "cgal/level_run.h"

namespace meshbound::cgal {

LevelRun::LevelRun(const TriangleMesh& original, const SimplifyOptions& options)
    : original_(original), options_(options) {
  const Clock::time_point start = Clock::now();
  until_stopped([&] { decimation_.emplace(original, options, stop()); });
  prepare_seconds_ = seconds_since(start);
}

StopToken LevelRun::stop() const {
  const StopToken cancel{.cancel = options_.cancel};
  return cancel.until(Clock::now(), options_.time_limit - prepare_seconds_ - simplify_seconds_);
}

/// Without a proven state there is nothing to go on from.
template <class Work>
void LevelRun::until_stopped(const Work& work) {
  try {
    work();
  } catch (const Stopped&) {
    decimation_.reset();
    stopped_ = ended_by({.cancel = options_.cancel});
  }
}

SimplifiedLevel LevelRun::next(double tolerance, std::size_t target_faces) {
  const Clock::time_point start = Clock::now();
  SimplifiedLevel level;
  level.tolerance = tolerance;
  if (!stopped_) {
    until_stopped([&] {
      level.ended_by = decimation_->run(tolerance, target_faces, stop());
      level.mesh = decimation_->current_mesh();
      level.collapses_performed = decimation_->counts().performed;
      level.collapses_refused = decimation_->counts().refused;
    });
  }
  if (stopped_) {
    level.ended_by = *stopped_;
    level.mesh = original_;
  }
  simplify_seconds_ += seconds_since(start);
  return level;
}

void LevelRun::describe(SimplifyResult& result) const {
  if (decimation_) decimation_->describe(result);
  result.seconds.prepare = prepare_seconds_;
  result.seconds.simplify = simplify_seconds_;
}

}  // namespace meshbound::cgal
