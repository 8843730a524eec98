// SPDX-License-Identifier: MIT
// lod_chain IN DIR: levels of detail, each with a proven distance to IN. The files appear together, once every one of
// them has been written, read back and measured.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <deque>
#include <numbers>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "common/distance_text.h"
#include "common/distinct_files.h"
#include "common/length.h"
#include "common/level_files.h"
#include "common/output.h"
#include "common/output_folder.h"
#include "common/provenance.h"
#include "common/signals.h"
#include "common/standard_streams.h"
#include "common/texture_text.h"
#include "decimation/decimation_run.h"
#include "decimation/decimation_text.h"
#include "deviation/deviation_outputs.h"
#include "levels/scene_run.h"
#include "lod/one_file.h"
#include "lod/pixel_limit.h"
#include "lod/tileset.h"
#include "meshbound/error.h"
#include "meshbound/mesh_summary.h"
#include "numeric/sort_unique.h"
#include "view/view_run.h"

namespace meshbound::tools {
namespace {

struct Options : DecimationOptions {
  std::string folder, format = "ply", scene, one_file;
  bool tileset = false;
  std::vector<std::string> levels, distances;
  std::vector<double> pixels;
  std::optional<double> screen_height, fov;
  DeviationRequest deviation;
};

/// The levels by their tolerances, or by what is seen of them.
void declare_levels(CLI::App& app, Options& options) {
  app.add_option("--levels", options.levels, "Tolerances: model units, or 0.1% of the bounding-box diagonal: T1,T2,...")
      ->delimiter(',')
      ->allow_extra_args(false);  // so that IN may follow
  app.add_option("--pixels", options.pixels,
                 "Instead of --levels: pixels that the error may cover on the screen; P1,P2,... at one of --distances "
                 "makes a level for each")
      ->delimiter(',')
      ->allow_extra_args(false);  // so that IN may follow
  app.add_option("--distances", options.distances,
                 "With --pixels: distances from the eye to the model, model units or % of the diagonal; D1,D2,... for "
                 "one of --pixels makes a level for each")
      ->delimiter(',')
      ->allow_extra_args(false);  // so that IN may follow
  app.add_option("--screen-height", options.screen_height,
                 "With --pixels: height of the screen in pixels (default 1080)");
  app.add_option("--fov", options.fov, "With --pixels: vertical field of view in degrees (default 60)");
}

void declare(CLI::App& app, Options& options) {
  app.add_option("IN", options.input,
                 "Mesh to make levels of: OFF, OBJ, PLY, STL, GLB or glTF; with --scene leave it out")
      ->required();
  app.add_option("DIR", options.folder,
                 "Folder for lod_0 (the finest), lod_1, ... and chain.json; made when it is not there. Levels of an "
                 "earlier run in it that are not written again are removed");
  app.add_option(
      "--scene", options.scene,
      "Instead of IN: a scene of instances and cameras (JSON, GLB or glTF); makes the levels that they need, "
      "and view.json, which says who uses which");
  declare_levels(app, options);
  app.add_option("--format", options.format, "Format of the level files")
      ->check(CLI::IsMember(mesh_formats()))
      ->capture_default_str();
  app.add_option("--glb", options.one_file,
                 "With --format glb: write all levels into this file, too, for engines that know MSFT_lod; a level is "
                 "shown where its proven error covers at most a pixel (or the first of --pixels)");
  app.add_flag("--tileset", options.tileset,
               "With --format glb: write DIR/tileset.json, too, for viewers of 3D Tiles; geometricError is the proven "
               "error of each level. Viewers take y as up; --up z where it is the z axis of IN");
  add_report_options(app, options.deviation);
  app.get_option("--units")->description("Name of the unit of lengths in the report, such as mm");
  app.get_option("--up")->description(
      "Axis of IN that points up: in the report (default z), and with --tileset in the tileset (default y)");
  add_appearance_options(app, options);
  add_decimation_options(app, options);
  add_examples(
      app, {"lod_chain bunny.ply lods --levels 0.1%,0.3%,1%", "lod_chain bunny.ply lods --pixels 1,2,4 --distances 3"});
}

/// In degrees: smaller fields of view are those of telescopes, and every angle in radians is below this.
constexpr double smallest_usual_fov = 5;

/// Throws for options that have no meaning for the bare triangles of many models.
void check_no_use_in_scenes(const Options& options) {
  const std::pair<const char*, bool> without_use[] = {{"--feature-edges", !options.feature_edges.empty()},
                                                      {"--line-tolerance", !options.line_tolerance.empty()},
                                                      {"--texture-tolerance", !options.texture_tolerance.empty()},
                                                      {"--texture-size", options.texture_size.has_value()},
                                                      {"--normal-tolerance", options.normal_tolerance.has_value()},
                                                      {"--error-bound", !options.error_bound.empty()},
                                                      {"--strict", options.strict},
                                                      {"--glb", !options.one_file.empty()},
                                                      {"--tileset", options.tileset}};
  for (const auto& [name, is_given] : without_use)
    if (is_given)
      throw InvalidInput(std::string("--scene writes bare triangles of many models; leave out ") + name +
                         ", which is for the levels of one mesh");
}

/// `lod_chain --scene FILE DIR`.
int run_scene(const Options& options) {
  if (!options.folder.empty()) throw InvalidInput("--scene names the models; leave IN out and give DIR alone");
  if (!options.levels.empty() || !options.distances.empty() || options.fov ||
      (!is_gltf(options.scene) && (!options.pixels.empty() || options.screen_height)))
    throw InvalidInput(
        "--scene gives pixels, screen and cameras (one of glTF only cameras); leave out --levels, --pixels and what "
        "belongs to them");
  if (options.pixels.size() > 1) throw InvalidInput("--scene takes one number of --pixels");
  if (options.deviation.has_any())
    throw InvalidInput("--report shows the levels of one mesh; leave it out with --scene");
  check_no_use_in_scenes(options);
  ViewRequest request{.scene = options.scene, .folder = options.input, .format = options.format, .limit = {}};
  if (!options.pixels.empty()) request.limit.pixels = options.pixels.front();
  if (options.screen_height) request.limit.screen_height = *options.screen_height;
  return run_view(options, request);
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
  [[nodiscard]] std::filesystem::path tileset_path() const;
  void read();
  void choose_tolerances();
  void choose_view();
  void open_outputs();
  void make_levels();
  [[nodiscard]] bool make_level(std::size_t index);
  [[nodiscard]] SimplifiedLevel decimated(std::size_t index);
  void note_level(std::size_t index, EndedBy ended_by, DecidedBy decided_by);
  void measure_deviation();
  void publish();
  void stage_chain(std::deque<StagedText>& documents);
  [[nodiscard]] std::string tileset_text() const;
  [[nodiscard]] std::vector<std::filesystem::path> stale_files() const;
  void print_summary() const;

  [[nodiscard]] double screen_height() const { return options_.screen_height.value_or(PixelLimit().screen_height); }

  const Options& options_;
  std::optional<OutputFolder> folder_;
  std::vector<GatedOutput> outputs_;  ///< one for each tolerance
  std::optional<AtomicFile> one_file_;
  std::optional<DeviationOutputs> deviation_;
  std::vector<double> pixels_;  ///< of the tolerances, where they come from a view
  LodReport report_;
  std::optional<ProgressBar> bar_;
  bool ended_by_time_ = false;  ///< true if it ended any level
};

int Run::operator()() {
  check_usage();
  check_paths();
  read();
  choose_tolerances();
  choose_appearance("an IN and levels");
  open_outputs();
  make_levels();
  if (report_.verdict == Verdict::Within) {
    if (deviation_) measure_deviation();
  } else if (interrupted()) {
    throw Error("interrupted before every level was proven; nothing was written");
  }
  publish();
  const bool is_within = report_.verdict == Verdict::Within;
  if (is_within && options_.common.prints_summary()) print_summary();
  if (!is_within)
    std::fprintf(stderr, "lod_chain: %s; nothing was written\n", obstacle_.c_str());
  else if (ended_by_time_)
    std::fprintf(stderr, "lod_chain: the time limit came first: levels are the best meshes that were proven by then\n");
  const bool is_complete = !ended_by_time_ && options_.deviation.has_any() == report_.deviation.has_value();
  return report_.verdict == Verdict::Within && !is_complete ? ExitUndecided : exit_code(report_.verdict);
}

void Run::check_usage() const {
  if ((!options_.one_file.empty() || options_.tileset) && options_.format != "glb")
    throw InvalidInput("--glb and --tileset need --format glb");
  if (!options_.one_file.empty() && format_of(options_.one_file) != FileFormat::Glb)
    throw InvalidInput("--glb: " + options_.one_file + " must be a .glb file");
  if (options_.folder.empty()) throw InvalidInput("DIR is required: the folder for the levels (see --help)");
  const bool has_view =
      !options_.pixels.empty() || !options_.distances.empty() || options_.screen_height || options_.fov;
  if (options_.levels.empty() && !has_view)
    throw InvalidInput("say which levels to make: --levels T1,T2,... or --pixels P1,P2,... with --distances D");
  if (!options_.levels.empty() && has_view)
    throw InvalidInput("--levels gives the tolerances themselves; leave out --pixels and what belongs to it");
  if (!has_view) return;
  if (options_.pixels.empty()) throw InvalidInput("missing: --pixels, how many the error may cover, such as 1");
  if (options_.distances.empty())
    throw InvalidInput("missing: --distances, from the eye to the model, in model units or % of the diagonal");
  if (options_.pixels.size() > 1 && options_.distances.size() > 1)
    throw InvalidInput("several --pixels need one of --distances, and several --distances one of --pixels");
  if (options_.fov && *options_.fov < smallest_usual_fov && !options_.common.quiet)
    std::fprintf(stderr, "lod_chain: --fov %s is taken as degrees; a field of view given in radians would be %s\n",
                 exact_number(*options_.fov).c_str(), short_number(*options_.fov / std::numbers::pi * 180).c_str());
}

std::filesystem::path Run::level_path(std::size_t index) const {
  return std::filesystem::path(options_.folder) / ("lod_" + std::to_string(index) + "." + options_.format);
}

std::filesystem::path Run::chain_path() const { return std::filesystem::path(options_.folder) / "chain.json"; }

std::filesystem::path Run::tileset_path() const { return std::filesystem::path(options_.folder) / "tileset.json"; }

void Run::check_paths() const {
  std::vector<NamedPath> outputs = options_.deviation.outputs();
  outputs.insert(outputs.end(),
                 {{"DIR", chain_path()}, {"--json", options_.common.json}, {"--glb", options_.one_file}});
  if (options_.tileset) outputs.push_back({"DIR", tileset_path()});
  const std::size_t of_view = std::max(options_.pixels.size(), options_.distances.size());
  for (std::size_t i = 0; i < options_.levels.size() + of_view; ++i) outputs.push_back({"DIR", level_path(i)});
  require_distinct_files({{"IN", options_.input}, {"--feature-edges", options_.feature_edges}}, outputs);
  DeviationRequest request = options_.deviation;
  if (request.up && request.report.empty() && !options_.tileset)
    throw InvalidInput("--up is for the report and the tileset: add --report or --tileset, or leave it out");
  request.up.reset();
  request.check();
}

void Run::read() {
  read_original(report_.original, true, level_path(0));
  report_.seconds.read = clock_.lap();
}

void Run::choose_tolerances() {
  add_tolerances("--levels", options_.levels);
  if (!options_.pixels.empty()) choose_view();
  sort_tolerances();
}

void Run::choose_view() {
  const Screen screen{screen_height(), options_.fov.value_or(default_fov) / 180 * std::numbers::pi};
  std::vector<std::pair<double, double>> levels;  // tolerance, pixels
  for (const double pixels : options_.pixels) {
    for (const std::string& text : options_.distances) {
      const double distance = parse_length("--distances", text).in_model_units(original_.diagonal);
      levels.emplace_back(screen_space_tolerance(screen, pixels, distance), pixels);
    }
  }
  sort_unique(levels);
  for (const auto& [tolerance, pixels] : levels) {
    tolerances_.push_back(tolerance);
    pixels_.push_back(pixels);
  }
  report_.view = LodReport::View{pixels_.front(), screen};
}

void Run::open_outputs() {
  folder_.emplace(options_.folder);
  for (std::size_t i = 0; i < tolerances_.size(); ++i)
    outputs_.emplace_back(level_path(i), clock_.stop(), options_.write);
  check_writable(chain_path());
  if (options_.tileset) check_writable(tileset_path());
  if (!options_.one_file.empty()) one_file_.emplace(options_.one_file, AtomicFile::Stream::Staged, stop_at_signal());
  check_writable(options_.common.json);
  if (options_.deviation.has_any()) deviation_.emplace(options_.deviation);
}

void Run::make_levels() {
  bar_.emplace("simplifying and measuring", options_.common.quiet);
  report_.verdict = Verdict::Within;
  SimplifyOptions options = decimation(outputs_.back(), tolerances_.back(), *bar_);
  if (bounds_texture()) options.texture_tolerance = texture_tolerance_of(tolerances_.front());
  scene_.emplace(original_.mesh, original_.attributes, options);
  set_lines(scene_->lines());
  for (std::size_t i = 0; i < tolerances_.size() && make_level(i); ++i) continue;
  SimplifyResult run_of_all;
  scene_->describe(run_of_all);
  scene_.reset();  // it refers to the options here, and deviations that are measured next need the room
  report_.locked_vertices = run_of_all.locked_vertices;
  report_.provenance = provenance();
  report_.driver = options_.driver;
  report_.threads = threads();
  report_.seconds.total = clock_.seconds();
}

/// Makes a level and its file, under a temporary name. Returns false, which ends the chain, if it is not proven.
bool Run::make_level(std::size_t index) {
  GatedOutput& output = outputs_[index];
  SimplifiedLevel level;
  OutputSteps steps;
  steps.smaller = index > 0 ? &outputs_[index - 1] : nullptr;
  steps.make = [&]() -> const SimplifiedLevel& { return level = decimated(index); };
  steps.redo = [&](double tolerance) {
    SimplifyOptions again = decimation(output, tolerances_[index], *bar_);
    again.tolerance = before_rounding(tolerance);
    return decimate_levels(original_.mesh, again, original_.attributes).last();
  };
  const DecidedBy decided_by = make_output(output, tolerances_[index], steps, report_.seconds);
  report_.verdict = output.verdict();
  if (report_.verdict != Verdict::Within && obstacle_.empty())
    throw Error(
        "internal error: a level is further from the original than was proven during decimation; nothing was "
        "written. Please report this with the input and the command line");
  if (report_.verdict != Verdict::Within) return false;
  note_level(index, level.ended_by, decided_by);
  return true;
}

SimplifiedLevel Run::decimated(std::size_t index) {
  if (bounds_texture()) scene_->set_texture_tolerance(texture_tolerance_of(tolerances_[index]));
  return scene_->next(before_rounding(tolerances_[index]), 0);
}

void Run::note_level(std::size_t index, EndedBy ended_by, DecidedBy decided_by) {
  const GatedOutput& output = outputs_[index];
  LodReport::Level& entry = report_.levels.emplace_back();
  entry.tolerance = tolerances_[index];
  entry.decided_by = decided_by;
  if (report_.view) {
    entry.pixels = pixels_[index];
    entry.view_distance = min_view_distance(report_.view->screen, pixels_[index], entry.tolerance);
  }
  entry.path = output.path().string();
  entry.file = output.path().filename().string();
  entry.sha256 = output.checksum();
  entry.vertices = output.summary().vertices;
  entry.faces = output.summary().faces;
  entry.turned_faces = output.turned_faces();
  entry.distance = output.distance();
  entry.lines = line_report(output, entry.tolerance);
  entry.texture = texture_report(output);
  entry.normals = normal_report(output);
  const bool was_late =
      clock_.seconds_left() == 0 && (decided_by == DecidedBy::SmallerLevel || decided_by == DecidedBy::Original);
  entry.stopped_by = to_string(was_late ? EndedBy::TimeLimit : ended_by);
  ended_by_time_ = ended_by_time_ || was_late || ended_by == EndedBy::TimeLimit;
}

/// Measures deviations of the levels as they read from their files. Leaves `deviation_` empty if there was no time for
/// it.
void Run::measure_deviation() {
  const GatedOutput& coarsest = outputs_.back();
  const TriangleMesh result = coarsest.written_mesh();
  const std::span<const GatedOutput> finer(outputs_.begin(), outputs_.end() - 1);
  DeviationSubject subject = deviation_subject(coarsest, finer, result, report_.levels.back().decided_by);
  subject.result_name = "level " + std::to_string(outputs_.size() - 1);
  try {
    deviation_->measure(subject, {threads(), clock_.stop()});
    report_.deviation = deviation_->report();
  } catch (const Stopped&) {
    if (interrupted()) throw Error("interrupted before the deviations were measured; nothing was written");
    deviation_.reset();
    std::fprintf(stderr, "lod_chain: no time was left to measure deviations; the report was not written\n");
  }
}

/// Makes all files appear; without a proof that is the document of --json alone. Everything that a full disk can
/// prevent comes before the first one.
void Run::publish() {
  const bool is_proven = report_.verdict == Verdict::Within;
  const std::vector<std::filesystem::path> stale = stale_files();
  std::deque<StagedText> documents;
  if (is_proven) stage_chain(documents);
  if (!options_.common.json.empty()) documents.emplace_back(options_.common.json, to_json(report_), stop_at_signal());
  if (report_.deviation) deviation_->stage(to_json(report_));
  const UninterruptedScope together;
  if (is_proven)
    for (GatedOutput& output : outputs_) output.publish();
  if (is_proven && one_file_) one_file_->commit();
  if (report_.deviation) deviation_->publish();
  // They name the files, so they come last; an interrupted rename leaves the old ones with the old names.
  for (StagedText& document : documents) document.publish();
  if (!is_proven) return;
  std::error_code ignored;  // the new chain.json does not name these files, so a failure to remove one does no harm
  for (const std::filesystem::path& path : stale) std::filesystem::remove(path, ignored);
}

/// Writes what stands beside the levels, under no name yet.
void Run::stage_chain(std::deque<StagedText>& documents) {
  if (one_file_) {
    const PixelLimit limit{report_.view ? report_.view->pixels : 1, screen_height()};
    const auto vertices = options_.placement == "subset" ? LevelVertices::Shared : LevelVertices::Apart;
    write_levels(*one_file_, outputs_, original_.mesh, original_.attributes, limit, vertices);
    one_file_->complete();
  }
  if (options_.tileset) documents.emplace_back(tileset_path(), tileset_text(), stop_at_signal());
  documents.emplace_back(chain_path(), to_json(report_), stop_at_signal());
}

std::string Run::tileset_text() const {
  std::vector<TileLevel> levels;
  double error = 0;  // that of a tile must not be below those of its children, and a coarser level may be nearer
  for (const LodReport::Level& level : report_.levels) {
    error = std::max(error, level.distance.bounds.upper);
    levels.push_back({level.file, error});
  }
  Eigen::AlignedBox3d box = used_bounding_box(original_.mesh);
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(levels.back().error);  // a level may stand out by that
  box.extend(Eigen::Vector3d(box.min() - margin));
  box.extend(Eigen::Vector3d(box.max() + margin));
  return tileset(levels, box, options_.deviation.up);
}

/// Levels of an earlier run in the same folder that this run neither reads nor writes.
std::vector<std::filesystem::path> Run::stale_files() const {
  std::vector<std::filesystem::path> stale = level_files_of(chain_path());
  std::erase_if(stale, [&](const std::filesystem::path& path) {
    std::error_code error;
    const auto is_here = [&](const std::filesystem::path& other) {
      return path == other || std::filesystem::equivalent(path, other, error);
    };
    return is_here(options_.input) || is_here(options_.common.json) || is_here(options_.one_file) ||
           std::any_of(outputs_.begin(), outputs_.end(), [&](const GatedOutput& o) { return is_here(o.path()); });
  });
  return stale;
}

void Run::print_summary() const {
  print_line("original", options_.input + ", " + face_count(report_.original.summary.faces));
  for (std::size_t i = 0; i < report_.levels.size(); ++i) {
    const LodReport::Level& level = report_.levels[i];
    print_line(level.file, face_count(level.faces) + ", tolerance " + both_units(level.tolerance, original_.diagonal));
    if (level.stopped_by == to_string(EndedBy::Rounding)) print_line("", rounding_reason(outputs_[i], level.tolerance));
    print_interval("", "distance ", level.distance.bounds, original_.diagonal);
    print_lines(level.lines, original_.diagonal);
    print_turned(level.turned_faces);
    if (level.normals) print_normals(*level.normals);
    if (level.texture) print_texture(*level.texture, {"original to level", "level to original"}, original_.diagonal);
    if (level.view_distance)
      print_line("", exact_number(*level.pixels) + (*level.pixels == 1 ? " pixel" : " pixels") +
                         " on the screen from view distance " + short_number(*level.view_distance) + " on");
    if (const std::string how = explanation(level.decided_by); !how.empty()) print_line("", "decided: " + how);
  }
  if (report_.deviation)
    print_deviation(*report_.deviation, "original to coarsest level", "coarsest level to original");
  print_line("verdict", to_string(report_.verdict));
  print_locked(report_.locked_vertices, report_.original.summary);
  print_dropped(report_.original);
  print_seconds(report_.seconds, report_.threads);
}

}  // namespace
}  // namespace meshbound::tools

int main(int argc, char** argv) {
  CLI::App app("Makes levels of detail of a triangle mesh and proves how far each is from the original.", "lod_chain");
  meshbound::tools::Options options;
  meshbound::tools::declare(app, options);
  return meshbound::tools::tool_main(app, argc, argv, [&] {
    return options.scene.empty() ? meshbound::tools::Run(options)() : meshbound::tools::run_scene(options);
  });
}
