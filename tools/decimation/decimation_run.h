// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <atomic>
#include <string>
#include <vector>

#include "common/gated_output.h"
#include "common/progress.h"
#include "common/stopwatch.h"
#include "decimation/decimation_options.h"
#include "meshbound/cgal/simplify_with_bound.h"
#include "meshbound/report.h"

namespace meshbound::tools {

/// What the runs of the tools that decimate have in common: the original, the tolerances and the clock.
class DecimationRun {
 protected:
  /// `options` must outlive this.
  explicit DecimationRun(const DecimationOptions& options);

  /// Reads and validates the input.
  void read_original(MeshReport& report);
  /// `flag` names the option that `texts` come from, for messages.
  void add_tolerances(const std::string& flag, const std::vector<std::string>& texts);
  /// Ascending, without repetitions.
  void sort_tolerances();

  /// Options of a decimation whose results are measured as they read from files like `output`.
  [[nodiscard]] cgal::SimplifyOptions decimation(const GatedOutput& output, ProgressBar& bar) const;
  /// Options of the measurement of a file.
  [[nodiscard]] DistanceOptions measurement(double tolerance) const;
  /// Seconds of this share of the time limit that are left.
  [[nodiscard]] double remaining(double share) const;
  /// True when a mesh is to be given up for one that is proven already, since the time ended before its own proof.
  [[nodiscard]] bool must_fall_back(const GatedOutput& output) const;
  [[nodiscard]] int threads() const;

  const std::atomic<bool>& interrupted_;
  Stopwatch watch_;
  TriangleMesh original_;
  double diagonal_ = 0;
  std::vector<double> tolerances_;

 private:
  const DecimationOptions& shared_;
  double largest_coordinate_ = 0;
};

/// "dropped: 6553 texture coordinates, 1 material", a line on stdout where the original has what no output carries.
void print_dropped(const MeshReport& original);

/// "seconds    read 0.01, simplify ...", a line on stdout.
void print_seconds(const SimplifyReport::Seconds& seconds);

}  // namespace meshbound::tools
