// SPDX-License-Identifier: MIT
#include "levels/level_run.h"

#include "levels/unchanged_level.h"
#include "simplify/option_sizes.h"

namespace meshbound {

LevelRun::LevelRun(const TriangleMesh& original, const SimplifyOptions& options)
    : original_(original), options_(options) {
  check_sizes(options, original.vertices.size(), original.triangles.size());  // also where there is no time for more
  const Clock::time_point start = Clock::now();
  until_stopped([&] {
    decimation_.emplace(original, options, stop());
    lines_ = decimation_->lines();
  });
  prepare_seconds_ = seconds_since(start);
}

StopToken LevelRun::stop() const {
  const StopToken cancel{.cancel = options_.cancel};
  return cancel.until(Clock::now(), options_.time_limit - prepare_seconds_ - simplify_seconds_);
}

template <class Work>
void LevelRun::until_stopped(const Work& work) {
  try {
    work();
  } catch (const Stopped&) {
    decimation_.reset();
    const bool cancelled = options_.cancel != nullptr && options_.cancel->load();
    stopped_ = cancelled ? EndedBy::Cancelled : EndedBy::TimeLimit;
  }
}

void LevelRun::take_original(SimplifiedLevel& level) const {
  take_unchanged(original_, options_, level);
  level.lines = lines_;
}

SimplifiedLevel LevelRun::next(double tolerance, std::size_t target_faces) {
  const Clock::time_point start = Clock::now();
  SimplifiedLevel level;
  level.tolerance = tolerance;
  if (!stopped_) {
    until_stopped([&] {
      level.ended_by = decimation_->run(tolerance, target_faces, stop());
      // With a tolerance below the rounding of coordinates nothing can be proven, not even that faces cover the dropped
      // triangles.
      if (level.ended_by == EndedBy::Rounding)
        take_original(level);
      else
        decimation_->current_mesh(level);
      const CollapseCounts counts = decimation_->counts();
      level.collapses_performed = counts.proven_together + counts.proven_alone - counts.restored;
      level.collapses_refused = counts.refused;
    });
  }
  if (stopped_) {
    level.ended_by = *stopped_;
    take_original(level);
  }
  simplify_seconds_ += seconds_since(start);
  return level;
}

void LevelRun::set_texture_tolerance(double tolerance) {
  if (decimation_) decimation_->set_texture_tolerance(tolerance);
}

bool LevelRun::take_back(std::span<const Refuted> refuted) {
  const Clock::time_point start = Clock::now();
  const bool is_changed = decimation_ && decimation_->take_back(refuted);
  simplify_seconds_ += seconds_since(start);
  return is_changed;
}

void LevelRun::describe(SimplifyResult& result) const {
  if (decimation_) decimation_->describe(result);
  result.lines = lines_;
  result.seconds.prepare = prepare_seconds_;
  result.seconds.simplify = simplify_seconds_;
}

}  // namespace meshbound
