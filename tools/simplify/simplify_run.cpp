// SPDX-License-Identifier: MIT
// A run of simplify_with_bound: as few triangles as possible, never further than the tolerance from the original. A
// file appears under the name OUT only after it was written, read back and measured against IN.
#include "simplify/simplify_run.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <deque>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "common/length.h"
#include "common/memory.h"
#include "common/output.h"
#include "common/output_folder.h"
#include "common/provenance.h"
#include "common/signals.h"
#include "common/standard_streams.h"
#include "common/tile_workers.h"
#include "decimation/decimation_run.h"
#include "deviation/deviation_outputs.h"
#include "levels/measured_level.h"
#include "levels/scene_run.h"
#include "mesh/atomic_file.h"
#include "meshbound/certificate.h"
#include "meshbound/error.h"
#include "meshbound/texture_certificate.h"
#include "simplify/estimate.h"
#include "simplify/output_paths.h"
#include "simplify/reproducer.h"
#include "simplify/summary.h"

namespace meshbound::tools {
namespace {

/// One run of the tool, in the order of its phases.
class Run : DecimationRun {
 public:
  explicit Run(const SimplifyArguments& options) : DecimationRun(options), options_(options) {}
  int operator()();

 private:
  void parse_target();
  void read();
  void plan_memory();
  [[nodiscard]] SimplifiedLevel decimated(const SimplifyOptions& options) const;
  void choose_tolerances();
  void open_outputs();
  void choose_options(ProgressBar& bar);
  void make_scene();
  [[nodiscard]] int foresee();
  void make_levels();
  void make_level(std::size_t level);
  [[noreturn]] void report_wrong_proof(const GatedOutput& output, double tolerance) const;
  [[nodiscard]] SimplifyOptions decimation_options(double tolerance, ProgressBar& bar) const;
  /// OUT may repeat the last level.
  [[nodiscard]] double tolerance_of(std::size_t output) const {
    return tolerances_[std::min(output, tolerances_.size() - 1)];
  }
  [[nodiscard]] std::optional<Certificate> certificate_of(const GatedOutput& output, double tolerance,
                                                          CertificateOptions options) const;
  void write_certificates();
  void measure_deviation();
  void describe();
  void publish();
  void tell();
  void tell_obstacle() const;

  const SimplifyArguments& options_;
  std::optional<OutputFolder> folder_;  ///< of the levels
  std::vector<GatedOutput> outputs_;
  std::deque<AtomicFile> certificates_;  ///< of the outputs, when they are asked for
  std::optional<DeviationOutputs> deviation_;
  SimplifyOptions simplify_;  ///< of all levels
  SimplifyResult result_;     ///< the last level that was made
  SimplifyReport report_;
  Verdict verdict_ = Verdict::Undecided;
  /// Whether the time limit ended the run: OUT is then the best mesh proven by that time.
  [[nodiscard]] bool ended_by_time() const;
  /// Whether some output contains the JSON document, which needs the checksums of the files.
  [[nodiscard]] bool has_document() const {
    return !options_.common.json.empty() || !options_.deviation.report.empty();
  }

  std::optional<double> target_ratio_;
  std::vector<std::string> checksums_;  ///< of the outputs, when a document is to name them
  std::vector<DecidedBy> decided_by_;   ///< of the outputs
};

int Run::operator()() {
  parse_target();
  check_paths(options_);
  read();
  choose_tolerances();
  choose_appearance("an IN and OUT");
  open_outputs();
  if (options_.dry_run) return foresee();
  make_levels();
  if (verdict_ == Verdict::Within) write_certificates();
  if (verdict_ == Verdict::Within && deviation_) measure_deviation();
  describe();
  publish();
  tell();
  const bool lacks_deviation = options_.deviation.has_any() && !report_.deviation;
  return verdict_ == Verdict::Within && (ended_by_time() || lacks_deviation) ? ExitUndecided : exit_code(verdict_);
}

void Run::parse_target() {
  if (!options_.target_ratio.empty()) target_ratio_ = parse_share("--target-ratio", options_.target_ratio);
}

void Run::read() {
  read_original(report_.original, has_document(), options_.output);
  if (!options_.memory.empty()) plan_memory();
  report_.seconds.read = clock_.lap();
}

/// Sets the threads by --memory. The limit itself holds since the start of the process.
void Run::plan_memory() {
  const TileOptions tiles{options_.tile_triangles};
  use_threads(threads_within(parse_memory("--memory", options_.memory), "--memory " + options_.memory,
                             original_.stored->triangle_count(), tiles, cost_of_simplifying, options_.common.threads));
}

SimplifiedLevel Run::decimated(const SimplifyOptions& options) const {
  if (options_.workers != nullptr) return options_.workers->decimate(*original_.stored, options).last();
  return decimate_levels(original_.mesh, options, original_.attributes).last();
}

/// Fills `tolerances_`, the last being that of OUT.
void Run::choose_tolerances() {
  add_tolerances("--levels", options_.levels);
  sort_tolerances();
  if (!options_.tolerance.empty()) {
    const double largest_level = tolerances_.empty() ? 0 : tolerances_.back();
    add_tolerances("--tolerance", {options_.tolerance});
    if (tolerances_.back() < largest_level)
      throw InvalidInput("--levels: a level is larger than --tolerance, which is that of OUT");
  } else if (tolerances_.empty()) {
    throw InvalidInput(missing_tolerance);
  }
  sort_tolerances();
  report_.tolerance = tolerances_.back();
}

/// Opens an output for each level, if levels are asked for, and then OUT.
void Run::open_outputs() {
  if (!options_.levels.empty()) {
    if (!options_.output_dir.empty()) folder_.emplace(options_.output_dir);
    for (std::size_t i = 0; i < tolerances_.size(); ++i) {
      const bool is_level = i + 1 < tolerances_.size() || options_.tolerance.empty();
      if (is_level) outputs_.emplace_back(level_path(options_, i), clock_.stop(), options_.write);
    }
  }
  outputs_.emplace_back(options_.output, clock_.stop(), options_.write);
  outputs_.back().write_by(options_.workers);
  if (options_.deviation.has_any()) deviation_.emplace(options_.deviation);
  if (options_.certificate.empty()) return;
  for (std::size_t i = 0; i + 1 < outputs_.size(); ++i)
    certificates_.emplace_back(level_certificate_path(options_, i), AtomicFile::Stream::Staged, stop_at_signal());
  certificates_.emplace_back(options_.certificate, AtomicFile::Stream::Staged, stop_at_signal());
}

/// Sets the options of all levels.
void Run::choose_options(ProgressBar& bar) {
  simplify_ = decimation_options(tolerances_.back(), bar);
  if (bounds_texture()) {
    simplify_.texture_tolerance = texture_tolerance_of(tolerances_.front());
    // Points with the same coordinate are no nearer than the nearest.
    if (tolerances_.size() == 1) simplify_.tolerance = std::min(simplify_.tolerance, simplify_.texture_tolerance);
  }
  if (options_.workers == nullptr) check_options(simplify_);
}

/// Makes what makes the levels, and finds the lines; not where workers on tiles do.
void Run::make_scene() {
  if (options_.workers != nullptr) return;
  scene_.emplace(original_.mesh, original_.attributes, simplify_);
  set_lines(scene_->lines());
}

/// What --dry-run does in place of the work: says what it would take, or that rounding alone exceeds a tolerance.
int Run::foresee() {
  {
    ProgressBar bar("checking", options_.common.quiet);
    choose_options(bar);
    const double rounding = max_rounding(outputs_.back());
    const double limit = std::min(tolerances_.front(), simplify_.line_tolerance.value_or(tolerances_.front()));
    const bool may_exceed = rounding > limit || (rounding > 0 && bounds_appearance());
    if (may_exceed) make_scene();
    for (std::size_t i = 0; may_exceed && i < outputs_.size() && obstacle_.empty(); ++i)
      obstacle_ = obstacle_of_original(outputs_[i], tolerance_of(i));
  }
  if (obstacle_.empty()) {
    print_estimate(report_.original.summary.faces, report_.tolerance, original_.diagonal);
    return ExitDone;
  }
  tell_obstacle();
  return ExitExceeds;
}

/// Makes the levels, the finest first, and proves each before the next one.
void Run::make_levels() {
  ProgressBar bar("simplifying", options_.common.quiet);
  choose_options(bar);
  make_scene();
  verdict_ = Verdict::Within;
  for (std::size_t i = 0; i < outputs_.size() && verdict_ == Verdict::Within; ++i) {
    const double tolerance = tolerance_of(i);
    OutputSteps steps;
    steps.smaller = i > 0 ? &outputs_[i - 1] : nullptr;
    steps.make = [&]() -> const SimplifiedLevel& {
      if (i < tolerances_.size()) make_level(i);  // OUT may repeat the last level
      return result_.last();
    };
    steps.redo = [&](double smaller) {
      SimplifyOptions again = decimation_options(tolerance, bar);
      again.tolerance = before_rounding(smaller);
      return decimated(again);
    };
    decided_by_.push_back(make_output(outputs_[i], tolerance, steps, report_.seconds));
    verdict_ = outputs_[i].verdict();
    if (verdict_ != Verdict::Within && obstacle_.empty()) report_wrong_proof(outputs_[i], tolerance);
  }
  report_.effort = bounds_appearance() ? "normal" : options_.effort;  // high changes nothing there
  report_.driver = options_.driver;
  report_.locked_vertices = result_.locked_vertices;
  report_.pruned = {result_.pruned_components, result_.pruned_faces};
  report_.stopped_by = to_string(result_.last().ended_by);
  report_.collapses = {result_.last().collapses_performed, result_.last().collapses_refused,
                       result_.counts.proven_together, result_.counts.taken_back, result_.counts.proven_alone};
}

/// Sets `result_`, whose only level is this one.
void Run::make_level(std::size_t level) {
  if (!scene_) {
    result_ = options_.workers->decimate(*original_.stored, simplify_);
    return;
  }
  const bool is_last = level + 1 == tolerances_.size();
  const double tolerance = is_last ? simplify_.tolerance : before_rounding(tolerances_[level]);
  if (bounds_texture()) scene_->set_texture_tolerance(texture_tolerance_of(tolerances_[level]));
  SimplifiedLevel made = scene_->next(tolerance, is_last ? target_faces(original_.mesh, simplify_) : 0);
  result_ = {};
  result_.levels.push_back(std::move(made));
  scene_->describe(result_);
  if (is_last && !bounds_appearance()) scene_.reset();  // nothing will be taken back: room for the measurement
}

/// All options of a decimation from the original.
SimplifyOptions Run::decimation_options(double tolerance, ProgressBar& bar) const {
  SimplifyOptions simplify = decimation(outputs_.back(), tolerance, bar);
  if (options_.target_faces) simplify.target_faces = static_cast<std::size_t>(*options_.target_faces);
  simplify.target_ratio = target_ratio_;
  simplify.on_exceed = options_.on_exceed == "stop" ? OnExceed::Stop : OnExceed::Skip;
  simplify.effort = options_.effort == "high" ? Effort::High : Effort::Normal;
  simplify.prune = options_.prune;
  return simplify;
}

/// Saves what led to an output that a measurement refutes, and throws.
void Run::report_wrong_proof(const GatedOutput& output, double tolerance) const {
  throw Error(
      "internal error: the result is further from the original than was proven during decimation; nothing was "
      "written under its name. Please report this with the folder " +
      save_reproducer(options_, output, {tolerances_, tolerance, target_ratio_}).string());
}

/// Also of the lines and the texture if there are any with a tolerance. Absent if the time ended.
std::optional<Certificate> Run::certificate_of(const GatedOutput& output, double tolerance,
                                               CertificateOptions options) const {
  MeshFile file;
  if (bounds_texture())
    file = output.written_with_attributes();
  else
    file.mesh = output.written_mesh();
  const TriangleMesh& written = file.mesh;
  if (options_.workers != nullptr)
    return options_.workers->certify(*original_.stored, MeshInMemory(written), tolerance, options);
  if (original_lines_)
    options.lines = CertifiedLines{lines_, output.lines_of(written), std::min(tolerance, original_lines_->tolerance)};
  const Stopwatch watch;
  auto certificate = build_certificate(original_.mesh, written, tolerance, options);
  if (!certificate || !bounds_texture()) return certificate;
  options.seconds -= watch.seconds();
  auto with_texture = with_texture_proof(
      *certificate, textured_meshes(original_.mesh, original_.texture_as_read, written, file.attributes),
      texture_tolerance_of(tolerance), options);
  if (!with_texture) return std::nullopt;
  return std::move(with_texture->certificate);
}

/// Proves the files as they read. A result whose certificate is not complete in time is replaced by the original, which
/// is certified in one pass.
void Run::write_certificates() {
  if (certificates_.empty()) return;
  clock_.lap();
  ProgressBar bar("proving", options_.common.quiet);
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    CertificateOptions options;
    options.threads = options_.common.threads;
    const bool is_original = decided_by_[i] == DecidedBy::Original || result_.last().collapses_performed == 0;
    if (!is_original) options.seconds = clock_.seconds_left();
    options.cancel = &interrupted();
    options.progress = bar.callback();
    const double tolerance = tolerance_of(i);
    auto certificate = certificate_of(outputs_[i], tolerance, options);
    end_if_interrupted();
    if (!certificate) {
      decided_by_[i] = fall_back(outputs_[i], nullptr, measurement(tolerance));
      options.seconds = std::numeric_limits<double>::infinity();
      certificate = certificate_of(outputs_[i], tolerance, options);
      end_if_interrupted();
    }
    const std::vector<std::uint8_t>& bytes = certificate->bytes;
    certificates_[i].write({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    certificates_[i].complete();
    report_.certificates.push_back({certificates_[i].path().string(), bytes.size()});
  }
  report_.seconds.certificate = clock_.lap();
}

/// Measures deviations of the meshes as they read from their files. Leaves `deviation_` empty if there was no time for
/// it.
void Run::measure_deviation() {
  const ProgressBar bar("measuring deviations", options_.common.quiet);
  const GatedOutput& out = outputs_.back();
  const MeshFile written = out.written_with_attributes();
  std::span<const GatedOutput> finer(outputs_.begin(), outputs_.end() - 1);
  if (options_.deviation.report.empty()) finer = {};
  DeviationSubject subject = deviation_subject(out, finer, written.mesh, decided_by_.back());
  const CornerAttribute &before = original_.attributes.texture_coordinates,
                        &after = written.attributes.texture_coordinates;
  if (!before.empty()) subject.original_texture = &before;
  if (!after.empty()) subject.result_texture = &after;
  subject.result_name = "simplified";
  try {
    deviation_->measure(subject, {options_.common.threads, clock_.stop()});
    report_.deviation = deviation_->report();
  } catch (const Stopped&) {
    end_if_interrupted();
    deviation_.reset();
    std::fprintf(stderr, "%s: no time was left to measure deviations; their files were not written\n",
                 provenance().tool.c_str());
  }
}

void Run::describe() {
  if (verdict_ == Verdict::Within && has_document())
    for (const GatedOutput& output : outputs_) checksums_.push_back(output.checksum());
  const GatedOutput& out = outputs_.back();
  report_.verdict = verdict_;
  report_.decided_by = decided_by_.empty() ? DecidedBy::Measurement : decided_by_.back();
  if (ended_by_time()) report_.stopped_by = to_string(EndedBy::TimeLimit);
  report_.provenance = provenance();
  report_.simplified = {verdict_ == Verdict::Within ? as_typed(options_.output) : "", out.summary()};
  if (!checksums_.empty()) report_.simplified.sha256 = checksums_.back();
  report_.turned_faces = out.turned_faces();
  report_.distance = out.distance();
  report_.lines = line_report(out, report_.tolerance);
  report_.texture = texture_report(out);
  report_.normals = normal_report(out);
  for (std::size_t i = 0; i + 1 < outputs_.size() && verdict_ == Verdict::Within; ++i)
    report_.levels.push_back({tolerances_[i], decided_by_[i], outputs_[i].path().string(), outputs_[i].summary().faces,
                              outputs_[i].distance(), line_report(outputs_[i], tolerances_[i]),
                              texture_report(outputs_[i]), normal_report(outputs_[i]),
                              checksums_.empty() ? "" : checksums_[i], outputs_[i].turned_faces()});
  report_.input = {result_.split, result_.dropped_triangles, result_.kept_triangles};
  if (options_.resume) report_.resumed_tiles = options_.workers->reused_tiles();
  if (!options_.memory.empty()) report_.memory = MemoryReport{peak_memory(), parse_memory("--memory", options_.memory)};
  report_.threads = threads();
  if (options_.workers != nullptr) report_.communication = options_.workers->communication();
  report_.seconds.total = clock_.seconds();
}

/// Makes all files appear; without a proof that is the document alone. Everything that a full disk can prevent comes
/// before the first one. A certificate comes after its mesh, and the document after what it names.
void Run::publish() {
  std::optional<StagedText> json;
  if (!options_.common.json.empty()) json.emplace(options_.common.json, to_json(report_), stop_at_signal());
  if (report_.deviation) deviation_->stage(to_json(report_));
  const UninterruptedScope together;
  if (verdict_ == Verdict::Within) {
    for (GatedOutput& output : outputs_) output.publish();
    for (AtomicFile& certificate : certificates_) certificate.commit();
    if (options_.workers != nullptr) options_.workers->drop_tiles();
  }
  if (report_.deviation) deviation_->publish();
  if (json) json->publish();
}

void Run::tell() {
  if (verdict_ == Verdict::Within && options_.common.prints_summary() && !is_stream_path(options_.output)) {
    const bool is_rounded = result_.last().ended_by == EndedBy::Rounding;
    print_summary({options_, report_, result_, outputs_, decided_by_, ended_by_time(), original_.diagonal,
                   is_rounded ? rounding_reason(outputs_.back(), report_.tolerance) : ""});
  }
  if (verdict_ == Verdict::Within && ended_by_time())
    std::fprintf(stderr, "%s: the time limit came first: %s is the best mesh that was proven by then\n",
                 provenance().tool.c_str(), as_typed(options_.output).c_str());
  if (verdict_ != Verdict::Within) tell_obstacle();
}

void Run::tell_obstacle() const {
  std::fprintf(stderr, "%s: %s; nothing was written\n", provenance().tool.c_str(), obstacle_.c_str());
}

bool Run::ended_by_time() const {
  const bool was_late = std::any_of(decided_by_.begin(), decided_by_.end(), [](DecidedBy how) {
    return how == DecidedBy::SmallerLevel || how == DecidedBy::Original;
  });
  return result_.last().ended_by == EndedBy::TimeLimit || (was_late && clock_.seconds_left() == 0);
}

}  // namespace

int run_simplify(const SimplifyArguments& options) {
  if (!options.memory.empty()) limit_memory(parse_memory("--memory", options.memory));
  try {
    return Run(options)();
  } catch (const IoError&) {  // such as a full disk
    if (options.workers != nullptr) options.workers->keep_tiles();
    throw;
  }
}

}  // namespace meshbound::tools
