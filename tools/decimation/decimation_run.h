// SPDX-License-Identifier: MIT
#pragma once
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "common/gated_output.h"
#include "common/progress.h"
#include "common/run_clock.h"
#include "common/signals.h"
#include "decimation/decimation_options.h"
#include "decimation/original.h"
#include "decimation/texture_tolerance.h"
#include "deviation/deviation_outputs.h"
#include "levels/scene_run.h"
#include "meshbound/report.h"
#include "meshbound/simplify.h"

namespace meshbound::tools {

/// What the runs of the tools that decimate have in common: the original, the tolerances and the clock.
class DecimationRun {
 protected:
  /// `options` must outlive this. Throws `InvalidInput` for a driver that is not there or does not know the cost.
  explicit DecimationRun(const DecimationOptions& options);

  /// As `tools::read_original`. Throws `Stopped` when the time limit comes first.
  void read_original(MeshReport& report, bool with_checksum, const std::filesystem::path& output);
  /// `flag` names the option that `texts` come from, for messages.
  void add_tolerances(const std::string& flag, const std::vector<std::string>& texts);
  /// Ascending, without repetitions.
  void sort_tolerances();

  /// Reads how far the texture may move. `kind` names the files that must carry texture coordinates, for messages.
  /// Throws `InvalidInput` where they do not.
  void choose_appearance(const std::string& kind);
  [[nodiscard]] bool bounds_texture() const { return texture_tolerance_.has_value(); }
  [[nodiscard]] bool bounds_appearance() const { return bounds_texture() || shared_.normal_tolerance; }
  /// How far the texture of a level with this tolerance may move, model units. Needs `bounds_texture`.
  [[nodiscard]] double texture_tolerance_of(double tolerance) const {
    return texture_tolerance_->of_level(tolerance, original_.diagonal, texel_length_);
  }

  /// Options of a decimation to this tolerance whose result is measured as it reads from files like `output`.
  [[nodiscard]] SimplifyOptions decimation(const GatedOutput& output, double tolerance, ProgressBar& bar) const;
  /// From now on decimations and measurements use so many threads.
  void use_threads(int threads) { threads_ = threads; }
  /// Options of the measurement of a file.
  [[nodiscard]] DistanceOptions measurement(double tolerance) const;
  /// What reports and pictures show of the output with the largest tolerance, which reads as `result` and was decided
  /// in this way, and of `finer` ones. They must outlive it. The name of the result is left open.
  [[nodiscard]] DeviationSubject deviation_subject(const GatedOutput& output, std::span<const GatedOutput> finer,
                                                   const TriangleMesh& result, DecidedBy how) const;
  /// What a decimation may use up of a tolerance: the rest is for the rounding in the frames of nodes.
  [[nodiscard]] double before_rounding(double tolerance) const;
  [[nodiscard]] bool is_out_of_time() const { return interrupted() || clock_.seconds_left() == 0; }
  /// No vertex of the original is moved further by writing it to files like `output`, model units; 0: none is moved.
  [[nodiscard]] double max_rounding(const GatedOutput& output) const;
  /// Writes the original under a temporary name and measures it. Says why it is not within the tolerances of `output`;
  /// empty: it is. Throws `Error` where rounding moves the texture or turns faces too far.
  [[nodiscard]] std::string obstacle_of_original(GatedOutput& output, double tolerance);
  /// Notes the lines that outputs must keep: edges of the original.
  void set_lines(std::vector<Edge> lines);
  /// Says why nothing collapsed where rounding alone may exceed the tolerance, and what to do where that is due to the
  /// format of the output.
  [[nodiscard]] std::string rounding_reason(const GatedOutput& output, double tolerance) const;
  /// Throws when a signal came.
  void end_if_interrupted() const;
  /// Says how far the lines of an output are from those of the original; none where there are no lines.
  [[nodiscard]] std::optional<LineReport> line_report(const GatedOutput& output, double tolerance) const;
  /// Says how far its texture moves and its faces turn; none where that has no tolerance.
  [[nodiscard]] std::optional<TextureReport> texture_report(const GatedOutput& output) const;
  [[nodiscard]] std::optional<NormalReport> normal_report(const GatedOutput& output) const;
  /// How an output is made.
  struct OutputSteps {
    /// Makes the level for the tolerance, again once something of it was taken back. It stays as it is until the next
    /// call.
    std::function<const SimplifiedLevel&()> make;
    std::function<SimplifiedLevel(double tolerance)> redo;  ///< makes a mesh for a tolerance from the original
    const GatedOutput* smaller = nullptr;                   ///< the output with the smaller tolerance before
  };
  /// Makes a level, writes it under a temporary name, reads that back and measures it against the original. Where
  /// texture or normals have changed too much, that is undone and the level made again; it may then have more faces
  /// than the smaller one, which takes its place. Where the distance remains undecided it tries harder: another method,
  /// a mesh for a slightly smaller tolerance, then the smaller output, then the original itself. Once the time limit
  /// has come only the last two are left. Says how the mesh that stands in `output` then was decided; the verdict may
  /// be that it exceeds the tolerance. Throws `Error` when it was interrupted.
  [[nodiscard]] DecidedBy make_output(GatedOutput& output, double tolerance, const OutputSteps& steps,
                                      SimplifyReport::Seconds& seconds);
  /// For a result whose proof was not finished in time: the one of `smaller`, or the original.
  [[nodiscard]] DecidedBy fall_back(GatedOutput& output, const GatedOutput* smaller, const DistanceOptions& options);
  [[nodiscard]] int threads() const { return threads_; }

  RunClock clock_;
  Original original_;
  std::vector<double> tolerances_;
  std::vector<Edge> lines_;  ///< of the original
  std::optional<OriginalLines> original_lines_;
  /// Why the last output that was made does not hold, a sentence without an end. Empty: it holds, or a proof was wrong.
  std::string obstacle_;
  std::optional<SceneRun> scene_;  ///< makes the levels; absent where workers on tiles do

 private:
  void warn_of_other_coordinates() const;
  void guard_texture(double tolerance, SimplifyOptions& options) const;
  [[nodiscard]] const TriangleMesh& original_of_normals(const GatedOutput& output);
  void set_requirements(GatedOutput& output, double tolerance);
  [[nodiscard]] double narrow_enough(double tolerance) const;
  [[nodiscard]] bool rounds_to_floats(const GatedOutput& output) const;
  [[nodiscard]] double largest_coordinate() const;
  [[nodiscard]] std::string without_floats() const;
  void narrow(GatedOutput& output, double tolerance);
  [[nodiscard]] std::string obstacle_of(const GatedOutput& output, double tolerance, bool is_original) const;
  [[nodiscard]] bool looks_wrong(GatedOutput& output, const SimplifiedLevel& level);
  void look_at(GatedOutput& output, const SimplifiedLevel& level);
  [[nodiscard]] bool takes_back(const GatedOutput& output);
  [[nodiscard]] bool writes(GatedOutput& output, const SimplifiedLevel& level) const;
  [[nodiscard]] bool decides(GatedOutput& output, const DistanceOptions& options);
  [[nodiscard]] DecidedBy prove(GatedOutput& output, double tolerance, const OutputSteps& steps);

  const DecimationOptions& shared_;
  std::string output_format_;  ///< the extension
  bool output_carries_texture_ = true;
  std::optional<TextureTolerance> texture_tolerance_;
  std::optional<TriangleMesh> rounded_original_;
  double texel_length_ = 0;  ///< model units, where there is a texture size
  MeshWithTree measured_original_;
  int threads_;
};

}  // namespace meshbound::tools
