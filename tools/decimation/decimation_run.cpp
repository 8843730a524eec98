// SPDX-License-Identifier: GPL-3.0-or-later
#include "decimation/decimation_run.h"

#include <omp.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <numbers>

#include "common/length.h"
#include "common/signals.h"
#include "decimation/dropped_attributes.h"
#include "meshbound/io.h"

namespace meshbound::tools {
namespace {

/// Share of the time limit that decimation may use; the rest is for the proof of what came out.
constexpr double simplify_share = 0.7;

/// Width of the measured interval, as a share of the original's diagonal.
constexpr double relative_error_bound = 1e-6;

}  // namespace

DecimationRun::DecimationRun(const DecimationOptions& options) : interrupted_(interrupted()), shared_(options) {}

void DecimationRun::read_original(MeshReport& report) {
  MeshFile file = read_mesh(shared_.input, {&interrupted_});
  original_ = std::move(file.mesh);
  validate(original_);
  report = {shared_.input,       summarise(original_),  file.triangulated_polygons,
            file.decoded_strips, file.ignored_elements, file.dropped};
  diagonal_ = report.summary.bbox_diagonal;
  const Eigen::AlignedBox3d box = used_bounding_box(original_);
  largest_coordinate_ = std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff());
}

void DecimationRun::add_tolerances(const std::string& flag, const std::vector<std::string>& texts) {
  for (const std::string& text : texts) tolerances_.push_back(parse_length(flag, text).in_model_units(diagonal_));
}

void DecimationRun::sort_tolerances() {
  std::sort(tolerances_.begin(), tolerances_.end());
  tolerances_.erase(std::unique(tolerances_.begin(), tolerances_.end()), tolerances_.end());
}

cgal::SimplifyOptions DecimationRun::decimation(const GatedOutput& output, ProgressBar& bar) const {
  cgal::SimplifyOptions options;
  options.cost =
      shared_.cost == "lindstrom-turk" ? cgal::CollapseCost::LindstromTurk : cgal::CollapseCost::GarlandHeckbert;
  options.preserve_boundary = shared_.preserve_boundary;
  if (shared_.feature_angle) options.feature_angle = *shared_.feature_angle / 180 * std::numbers::pi;
  // A vertex may leave the box by the tolerance.
  options.output_rounding = output.largest_rounding(largest_coordinate_ + tolerances_.back());
  options.measure = false;  // the file is what counts
  options.time_limit = remaining(simplify_share);
  options.threads = shared_.common.threads;
  options.cancel = &interrupted_;
  options.progress = [&bar](double fraction) { bar.show(fraction); };
  return options;
}

DistanceOptions DecimationRun::measurement(double tolerance) const {
  DistanceOptions options;
  options.error_bound = relative_error_bound * diagonal_;
  options.tolerance = tolerance;
  options.budget.seconds = remaining(1);
  options.threads = shared_.common.threads;
  options.cancel = &interrupted_;
  return options;
}

double DecimationRun::remaining(double share) const {
  return shared_.common.has_time_limit ? std::max(0.0, share * shared_.common.time_limit - watch_.seconds())
                                       : std::numeric_limits<double>::infinity();
}

bool DecimationRun::must_fall_back(const GatedOutput& output) const {
  return output.verdict() == Verdict::Undecided && shared_.common.has_time_limit && !interrupted_;
}

int DecimationRun::threads() const {
  return shared_.common.threads > 0 ? shared_.common.threads : omp_get_max_threads();
}

void print_dropped(const MeshReport& original) {
  if (original.dropped && *original.dropped != DroppedAttributes{})
    std::printf("dropped: %s\n", listed(*original.dropped).c_str());
}

void print_seconds(const SimplifyReport::Seconds& seconds) {
  std::printf("seconds    read %.2f, simplify %.2f, write %.2f, certify %.2f, total %.2f\n", seconds.read,
              seconds.simplify, seconds.write, seconds.certify, seconds.total);
}

}  // namespace meshbound::tools
