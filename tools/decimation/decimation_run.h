// SPDX-License-Identifier: MIT
#pragma once
#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/gated_output.h"
#include "common/progress.h"
#include "common/stopwatch.h"
#include "common/time_limit.h"
#include "decimation/decimation_options.h"
#include "deviation/measure_here.h"
#include "meshbound/report.h"
#include "meshbound/simplify.h"

namespace meshbound::tools {

/// What the runs of the tools that decimate have in common: the original, the tolerances and the clock.
class DecimationRun {
 protected:
  /// `options` must outlive this. Throws `InvalidInput` for a driver that is not there or does not know the cost.
  explicit DecimationRun(const DecimationOptions& options);

  /// Reads and validates the input; its checksum is computed where a document is to name it. Attributes come along
  /// where files like `output` carry them. Throws `Stopped` when the time limit comes first.
  void read_original(MeshReport& report, bool with_checksum, const std::filesystem::path& output);
  /// `flag` names the option that `texts` come from, for messages.
  void add_tolerances(const std::string& flag, const std::vector<std::string>& texts);
  /// Ascending, without repetitions.
  void sort_tolerances();

  /// Options of a decimation whose results are measured as they read from files like `output`.
  [[nodiscard]] SimplifyOptions decimation(const GatedOutput& output, ProgressBar& bar) const;
  /// From now on decimations and measurements use so many threads.
  void use_threads(int threads) { threads_ = threads; }
  /// Options of the measurement of a file.
  [[nodiscard]] DistanceOptions measurement(double tolerance) const;
  /// How a browser repeats the measurement of an output.
  [[nodiscard]] RepeatedMeasurement repeated(double tolerance, DecidedBy how) const;
  /// Measures how far texture and normals of a level that is not written yet have changed, as far as the output
  /// requires it; leaves off at the time limit.
  void look_at(GatedOutput& output, const SimplifiedLevel& level);
  /// Writes; false when the time limit came first.
  [[nodiscard]] bool writes(GatedOutput& output, const SimplifiedLevel& level) const;
  /// Measures what was written; true when the verdict is known.
  [[nodiscard]] bool decides(GatedOutput& output, const DistanceOptions& options);
  /// What a decimation may use up of a tolerance: the rest is for the rounding in the frames of nodes.
  [[nodiscard]] double before_rounding(double tolerance) const;
  [[nodiscard]] bool is_out_of_time() const { return interrupted_ || remaining(1) == 0; }
  /// Seconds of this share of the time limit that are left.
  [[nodiscard]] double remaining(double share) const;
  /// Notes the lines that outputs must keep: edges of the original.
  void set_lines(std::vector<Edge> lines);
  /// Says how far the lines of an output are from those of the original; none where there are no lines.
  [[nodiscard]] std::optional<LineReport> line_report(const GatedOutput& output, double tolerance) const;
  /// Makes the mesh again for a tolerance, model units.
  using Redo = std::function<SimplifiedLevel(double tolerance)>;
  /// Reads back what `writes` left in `output` and measures it against the original. Where that remains undecided it
  /// tries harder: another method, a mesh for a slightly smaller tolerance, then the result of the smaller tolerance
  /// before (may be null), then the original itself. Once the time limit has come only the last two are left. Says how
  /// the mesh that stands in `output` then was decided. Throws `Error` when it was interrupted.
  [[nodiscard]] DecidedBy prove(GatedOutput& output, double tolerance, const GatedOutput* smaller, const Redo& redo);
  /// For a result whose proof was not finished in time: the one of `smaller`, or the original.
  [[nodiscard]] DecidedBy fall_back(GatedOutput& output, const GatedOutput* smaller, const DistanceOptions& options);
  /// Stops at a signal, and at the time limit.
  [[nodiscard]] StopToken stop() const { return stop_of_run(shared_.common, watch_); }
  [[nodiscard]] int threads() const;
  /// Throws `Stopped` when the time limit comes first.
  [[nodiscard]] const Bvh& original_tree() { return measured_original_.tree(stop()); }

  const std::atomic<bool>& interrupted_;
  Stopwatch watch_;
  TriangleMesh original_;                        ///< empty where there are workers on tiles
  std::unique_ptr<StoredMesh> stored_original_;  ///< for these
  double diagonal_ = 0;
  std::vector<double> tolerances_;
  MeshAttributes attributes_;        ///< of the original, where outputs carry them
  double rounding_ = 0;              ///< what the frames of nodes may move vertices by, model units
  std::vector<Edge> feature_edges_;  ///< seams of these, and the edges of --feature-edges
  std::vector<Edge> lines_;          ///< of the original
  std::optional<OriginalLines> original_lines_;

 private:
  const DecimationOptions& shared_;
  MeshWithTree measured_original_;
  int threads_;  ///< 0: as many as OpenMP has
};

/// "dropped: 6553 texture coordinates, 1 material", a line on stdout where the original has what no output carries, and
/// another one where it has parts that were measured in rest pose.
void print_dropped(const MeshReport& original);

/// What to tell the user about a result that was not decided at once: a sentence, empty where there is nothing to say.
[[nodiscard]] std::string explanation(DecidedBy how);

/// "locked      12 of 482 vertices: ...", a line on stdout where options lock some.
void print_locked(std::size_t vertices, const MeshSummary& original);

/// "lines       64 -> 10 edges ...", lines on stdout where there are feature lines.
void print_lines(const std::optional<LineReport>& lines, double diagonal);

/// "seconds     read 0.010, simplify ...", a line on stdout.
void print_seconds(const SimplifyReport::Seconds& seconds, int threads);

}  // namespace meshbound::tools
