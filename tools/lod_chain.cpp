// SPDX-License-Identifier: MIT
// lod_chain IN DIR: levels of detail, each with a proven distance to IN. The files appear together, once every one of
// them has been written, read back and measured.
#include <cstdio>
#include <numbers>
#include <optional>
#include <vector>

#include "common/distinct_files.h"
#include "common/length.h"
#include "common/output.h"
#include "common/output_folder.h"
#include "common/signals.h"
#include "decimation/decimation_run.h"
#include "levels/level_run.h"
#include "meshbound/error.h"

namespace meshbound::tools {
namespace {

struct Options : DecimationOptions {
  std::string folder, format = "ply";
  std::vector<std::string> levels, distances;
  std::optional<double> pixels, screen_height, fov;
};

void declare(CLI::App& app, Options& options) {
  app.add_option("IN", options.input, "Mesh to make levels of: OFF, OBJ, PLY or STL")->required();
  app.add_option("DIR", options.folder, "Folder for lod_0, lod_1, ... and chain.json; made when it is not there")
      ->required();
  app.add_option("--levels", options.levels, "Tolerances: model units, or 0.1% of the bounding-box diagonal: T1,T2,...")
      ->delimiter(',');
  app.add_option("--pixels", options.pixels, "Instead of --levels: pixels that the error may cover on the screen");
  app.add_option("--screen-height", options.screen_height, "Height of the screen in pixels");
  app.add_option("--fov", options.fov, "Vertical field of view in degrees");
  app.add_option("--distances", options.distances,
                 "Distances from the eye to the model, a level for each: model units, or % of the diagonal: D1,D2,...")
      ->delimiter(',');
  app.add_option("--format", options.format, "Format of the level files")
      ->check(CLI::IsMember({"ply", "obj", "off", "stl"}))
      ->capture_default_str();
  add_decimation_options(app, options);
}

/// One run of the tool, in the order of its phases.
class Run : DecimationRun {
 public:
  explicit Run(const Options& options) : DecimationRun(options), options_(options) {}
  int operator()();

 private:
  void check_usage() const;
  void check_paths() const;
  [[nodiscard]] std::filesystem::path level_path(std::size_t index) const;
  [[nodiscard]] std::filesystem::path chain_path() const;
  void read();
  void choose_tolerances();
  void open_outputs();
  void make_levels();
  [[nodiscard]] bool take(std::size_t index, const SimplifiedLevel& level);
  void publish();
  void print_summary() const;

  const Options& options_;
  std::optional<Bvh> tree_;
  std::optional<OutputFolder> folder_;
  std::vector<GatedOutput> outputs_;  ///< one for each tolerance
  LodReport report_;
  std::optional<ProgressBar> bar_;
  bool ended_by_time_ = false;  ///< for some level
};

int Run::operator()() {
  check_usage();
  check_paths();
  read();
  choose_tolerances();
  open_outputs();
  make_levels();
  if (report_.verdict == Verdict::Within)
    publish();
  else if (interrupted_)
    throw Error("interrupted before every level was proven; nothing was written");
  if (!options_.common.json.empty()) write_text(options_.common.json, to_json(report_));
  if (options_.common.json != "-" && !options_.common.quiet) print_summary();
  if (report_.verdict != Verdict::Within)
    std::fprintf(stderr,
                 "lod_chain: a tolerance is smaller than the rounding of the output format; use PLY, OFF or OBJ; "
                 "nothing was written\n");
  else if (ended_by_time_)
    std::fprintf(stderr, "lod_chain: the time limit came first: levels are the best meshes that were proven by then\n");
  return report_.verdict == Verdict::Within && ended_by_time_ ? ExitUndecided : exit_code(report_.verdict);
}

void Run::check_usage() const {
  const int of_view = int{options_.pixels.has_value()} + int{options_.screen_height.has_value()} +
                      int{options_.fov.has_value()} + int{!options_.distances.empty()};
  if (options_.levels.empty() && of_view == 0)
    throw InvalidInput(
        "say which levels to make: --levels T1,T2,... or --pixels with --screen-height, --fov, "
        "--distances");
  if (!options_.levels.empty() && of_view > 0)
    throw InvalidInput("--levels gives the tolerances themselves; leave out --pixels and what belongs to it");
  if (options_.levels.empty() && of_view < 4)
    throw InvalidInput("--pixels, --screen-height, --fov and --distances belong together; one is missing");
}

std::filesystem::path Run::level_path(std::size_t index) const {
  return std::filesystem::path(options_.folder) / ("lod_" + std::to_string(index) + "." + options_.format);
}

std::filesystem::path Run::chain_path() const { return std::filesystem::path(options_.folder) / "chain.json"; }

void Run::check_paths() const {
  std::vector<NamedPath> outputs{{"DIR", chain_path()}, {"--json", options_.common.json}};
  for (std::size_t i = 0; i < options_.levels.size() + options_.distances.size(); ++i)
    outputs.push_back({"DIR", level_path(i)});
  require_distinct_files({{"IN", options_.input}}, outputs);
}

void Run::read() {
  read_original(report_.original);
  report_.seconds.read = watch_.lap();
}

void Run::choose_tolerances() {
  add_tolerances("--levels", options_.levels);
  if (options_.pixels) {
    const Screen screen{*options_.screen_height, *options_.fov / 180 * std::numbers::pi};
    report_.view = LodReport::View{*options_.pixels, screen};
    for (const std::string& distance : options_.distances)
      tolerances_.push_back(screen_space_tolerance(screen, *options_.pixels,
                                                   parse_length("--distances", distance).in_model_units(diagonal_)));
  }
  sort_tolerances();
}

void Run::open_outputs() {
  folder_.emplace(options_.folder);
  for (std::size_t i = 0; i < tolerances_.size(); ++i) outputs_.emplace_back(level_path(i), interrupted_);
  check_writable(chain_path());
  if (!options_.common.json.empty()) check_writable(options_.common.json);
}

void Run::make_levels() {
  bar_.emplace("simplifying and measuring", options_.common.quiet);
  report_.verdict = Verdict::Within;
  tree_.emplace(original_, BvhOptions{options_.common.threads});
  report_.seconds.certify += watch_.lap();
  SimplifyOptions options = decimation(outputs_.back(), *bar_);
  options.tolerance = tolerances_.back();
  LevelRun run(original_, options);
  for (std::size_t i = 0; i < tolerances_.size(); ++i)
    if (!take(i, run.next(tolerances_[i], 0))) break;
  report_.driver = options_.driver;
  report_.threads = threads();
  report_.seconds.total = watch_.seconds();
}

/// Writes the level under a temporary name, reads it back and measures that. The chain ends where this fails.
bool Run::take(std::size_t index, const SimplifiedLevel& level) {
  if (interrupted_) throw Error("interrupted before every level was proven; nothing was written");
  report_.seconds.simplify += watch_.lap();
  GatedOutput& output = outputs_[index];
  output.write(level.mesh);
  report_.seconds.write += watch_.lap();
  const auto redo = [&](double tolerance) {
    SimplifyOptions again = decimation(output, *bar_);
    again.tolerance = tolerance;
    return decimate_levels(original_, again).last().mesh;
  };
  const DecidedBy decided_by = prove(output, level.tolerance, *tree_, index > 0 ? &outputs_[index - 1] : nullptr, redo);
  report_.seconds.certify += watch_.lap();
  report_.verdict = output.verdict();
  if (report_.verdict == Verdict::Exceeds && level.ended_by != EndedBy::Rounding)
    throw Error(
        "internal error: a level is further from the original than was proven during decimation; nothing was "
        "written. Please report this with the input and the command line");
  if (report_.verdict != Verdict::Within) return false;
  LodReport::Level& entry = report_.levels.emplace_back();
  entry.tolerance = level.tolerance;
  entry.decided_by = decided_by;
  if (report_.view)
    entry.view_distance = min_view_distance(report_.view->screen, report_.view->pixels, level.tolerance);
  entry.path = output.path().string();
  entry.file = output.path().filename().string();
  entry.vertices = output.summary().vertices;
  entry.faces = output.summary().faces;
  entry.distance = output.distance();
  const bool was_late = options_.common.has_time_limit && remaining(1) == 0 &&
                        (decided_by == DecidedBy::SmallerLevel || decided_by == DecidedBy::Original);
  entry.stopped_by = to_string(was_late ? EndedBy::TimeLimit : level.ended_by);
  ended_by_time_ = ended_by_time_ || was_late || level.ended_by == EndedBy::TimeLimit;
  return true;
}

void Run::publish() {
  const UninterruptedScope together;
  // The report names the files, so it comes last; an interrupted rename leaves the old report with the old names.
  for (GatedOutput& output : outputs_) output.publish();
  write_text(chain_path(), to_json(report_));
}

void Run::print_summary() const {
  std::printf("original   %s, %zu faces\n", options_.input.c_str(), report_.original.summary.faces);
  for (const LodReport::Level& level : report_.levels) {
    std::printf("%-10s %zu faces, tolerance %s, distance [%.6g, %.6g]", level.file.c_str(), level.faces,
                both_units(level.tolerance, diagonal_).c_str(), level.distance.bounds.lower,
                level.distance.bounds.upper);
    if (level.view_distance) std::printf(", from view distance %s on", short_number(*level.view_distance).c_str());
    std::printf("\n");
    if (const std::string how = explanation(level.decided_by); !how.empty())
      std::printf("           decided: %s\n", how.c_str());
  }
  print_dropped(report_.original);
  std::printf("verdict    %s\n", to_string(report_.verdict).c_str());
  print_seconds(report_.seconds);
}

}  // namespace
}  // namespace meshbound::tools

int main(int argc, char** argv) {
  CLI::App app("Makes levels of detail of a triangle mesh and proves how far each is from the original.", "lod_chain");
  meshbound::tools::Options options;
  meshbound::tools::declare(app, options);
  return meshbound::tools::tool_main(app, argc, argv, [&] { return meshbound::tools::Run(options)(); });
}
