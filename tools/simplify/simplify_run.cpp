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
#include <vector>

#include "common/length.h"
#include "common/memory.h"
#include "common/output.h"
#include "common/output_folder.h"
#include "common/provenance.h"
#include "common/signals.h"
#include "common/standard_streams.h"
#include "common/texture_length.h"
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

/// What of a level, or of the original, has moved too far in the texture or turned too much.
std::vector<Refuted> refuted_by(const GatedOutput& output) {
  std::vector<Refuted> refuted;
  if (const auto& texture = output.texture_deviation()) {
    for (const TextureWitness& w : texture->a_to_b.exceeding)
      refuted.push_back({w.from.triangle, w.nearest.triangle, w.coordinate});
    for (const TextureWitness& w : texture->b_to_a.exceeding)
      refuted.push_back({no_index, w.from.triangle, w.coordinate});
  }
  if (const auto& normals = output.normal_deviation())
    for (const FaceTurn& turn : normals->exceeding) refuted.push_back({turn.from.triangle, turn.nearest.triangle});
  return refuted;
}

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
  void make_levels();
  void make_level(std::size_t level);
  void choose_appearance();
  void set_requirements(GatedOutput& output) const;
  [[nodiscard]] bool looks_wrong(GatedOutput& output);
  [[nodiscard]] bool takes_back(const GatedOutput& output);
  [[nodiscard]] bool tightens_appearance(std::size_t output);
  [[nodiscard]] SimplifyOptions decimation_options(ProgressBar& bar) const;
  void guard_texture(SimplifyOptions& simplify) const;
  void certify(std::size_t output, ProgressBar& bar);
  /// OUT may repeat the last level.
  [[nodiscard]] double tolerance_of(std::size_t output) const {
    return tolerances_[std::min(output, tolerances_.size() - 1)];
  }
  [[nodiscard]] std::optional<Certificate> certificate_of(const GatedOutput& output, double tolerance,
                                                          CertificateOptions options) const;
  void write_certificates();
  void measure_deviation();
  void take_finer(std::size_t index);
  void warn_of_other_coordinates() const;
  void end_if_interrupted() const;
  void publish();
  void report();

  const SimplifyArguments& options_;
  std::optional<OutputFolder> folder_;  ///< of the levels
  std::vector<GatedOutput> outputs_;
  std::deque<AtomicFile> certificates_;  ///< of the outputs, when they are asked for
  std::optional<DeviationOutputs> deviation_;
  SimplifyOptions simplify_;       ///< of all levels
  std::optional<SceneRun> scene_;  ///< makes them; absent where workers on tiles do
  SimplifyResult result_;          ///< the last level that was made
  SimplifyReport report_;
  Verdict verdict_ = Verdict::Undecided;
  /// Whether the time limit ended the run: OUT is then the best mesh proven by that time.
  [[nodiscard]] bool ended_by_time() const;
  [[nodiscard]] bool bounds_appearance() const { return original_texture_ || options_.normal_tolerance; }
  /// Whether some output contains the JSON document, which needs the checksums of the files.
  [[nodiscard]] bool has_document() const {
    return !options_.common.json.empty() || !options_.deviation.report.empty();
  }

  std::optional<double> target_ratio_;
  std::optional<TextureLength> typed_texture_tolerance_;
  std::optional<OriginalTexture> original_texture_;
  double texel_length_ = 0;
  std::vector<std::string> checksums_;  ///< of the outputs, when a document is to name them
  std::vector<DecidedBy> decided_by_;   ///< of the outputs
};

int Run::operator()() {
  parse_target();
  check_paths(options_);
  read();
  choose_tolerances();
  choose_appearance();
  if (options_.dry_run) {
    print_estimate(report_.original.summary.faces, report_.tolerance, diagonal_);
    return ExitDone;
  }
  open_outputs();
  make_levels();
  if (verdict_ == Verdict::Within) write_certificates();
  if (verdict_ == Verdict::Within && deviation_) measure_deviation();
  if (verdict_ == Verdict::Within) publish();
  report();
  const bool lacks_deviation = options_.deviation.has_any() && !report_.deviation;
  return verdict_ == Verdict::Within && (ended_by_time() || lacks_deviation) ? ExitUndecided : exit_code(verdict_);
}

void Run::parse_target() {
  if (!options_.target_ratio.empty()) target_ratio_ = parse_share("--target-ratio", options_.target_ratio);
  if (!options_.texture_tolerance.empty())
    typed_texture_tolerance_ =
        parse_texture_length("--texture-tolerance", options_.texture_tolerance, options_.texture_size.has_value());
}

void Run::read() {
  read_original(report_.original, has_document(), options_.output);
  if (!options_.memory.empty()) plan_memory();
  report_.seconds.read = watch_.lap();
}

/// Sets the number of triangles in a tile and the threads by --memory. The limit itself holds since the start of the
/// process.
void Run::plan_memory() {
  const TileOptions tiles{options_.tile_triangles};
  use_threads(threads_within(parse_memory("--memory", options_.memory), "--memory " + options_.memory,
                             stored_original_->triangle_count(), tiles, cost_of_simplifying, options_.common.threads));
}

SimplifiedLevel Run::decimated(const SimplifyOptions& options) const {
  if (options_.workers != nullptr) return options_.workers->decimate(*stored_original_, options).last();
  return decimate_levels(original_, options, attributes_).last();
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
    throw InvalidInput(
        "--tolerance is missing: say how far the result may be from IN, such as --tolerance 0.1%, or "
        "--tolerance 100% where only the number of faces counts");
  }
  sort_tolerances();
  report_.tolerance = tolerances_.back();
}

void Run::choose_appearance() {
  if (!typed_texture_tolerance_) return;
  if (attributes_.texture_coordinates.empty())
    throw InvalidInput(
        "--texture-tolerance needs texture coordinates, and an IN and OUT of a format that carries them "
        "(OBJ, PLY, glTF): none were found in " +
        options_.input);
  warn_of_other_coordinates();
  if (options_.texture_size)
    texel_length_ =
        texel_length(textured_meshes(original_, attributes_, original_, attributes_)[0], *options_.texture_size);
  const double tolerance = typed_texture_tolerance_->in_model_units(diagonal_, texel_length_);
  original_texture_ = OriginalTexture{&original_, &attributes_, tolerance};
}

/// Further sets of texture coordinates come along, but nothing is measured of them.
void Run::warn_of_other_coordinates() const {
  std::string sets;
  for (const NamedAttribute& attribute : attributes_.named)
    if (attribute.name.starts_with("TEXCOORD_")) sets += (sets.empty() ? "" : ", ") + attribute.name;
  if (sets.empty()) return;
  const std::string warning =
      options_.input + ": --texture-tolerance bounds the first set of texture coordinates only, and not " + sets;
  if (options_.strict) throw InvalidInput(warning + "; leave out --strict to accept that");
  std::fprintf(stderr, "%s: %s\n", provenance().tool.c_str(), warning.c_str());
}

/// Opens an output for each level, if levels are asked for, and then OUT.
void Run::open_outputs() {
  if (!options_.levels.empty()) {
    if (!options_.output_dir.empty()) folder_.emplace(options_.output_dir);
    for (std::size_t i = 0; i < tolerances_.size(); ++i) {
      const bool is_level = i + 1 < tolerances_.size() || options_.tolerance.empty();
      if (is_level) outputs_.emplace_back(level_path(options_, i), stop(), options_.write);
    }
  }
  outputs_.emplace_back(options_.output, stop(), options_.write);
  outputs_.back().write_by(options_.workers);
  if (options_.deviation.has_any()) deviation_.emplace(options_.deviation);
  if (options_.certificate.empty()) return;
  const StopToken signals{.cancel = &interrupted_};
  for (std::size_t i = 0; i + 1 < outputs_.size(); ++i)
    certificates_.emplace_back(level_certificate_path(options_, i), AtomicFile::Stream::Staged, signals);
  certificates_.emplace_back(options_.certificate, AtomicFile::Stream::Staged, signals);
}

/// Makes the levels, the finest first, and proves each before the next one. Where a texture has moved too far or faces
/// have turned too much, the level is made again there, which may leave it with more faces than the finer one.
void Run::make_levels() {
  ProgressBar bar("simplifying", options_.common.quiet);
  simplify_ = decimation_options(bar);
  simplify_.tolerance = before_rounding(tolerances_.back());
  if (original_texture_ && tolerances_.size() == 1)  // points with the same coordinate are no nearer than the nearest
    simplify_.tolerance = std::min(simplify_.tolerance, original_texture_->tolerance);
  if (options_.workers == nullptr) {
    check_options(simplify_);
    scene_.emplace(original_, attributes_, simplify_);
    set_lines(scene_->lines());
  }
  verdict_ = Verdict::Within;
  for (std::size_t i = 0; i < outputs_.size() && verdict_ == Verdict::Within; ++i) {
    set_requirements(outputs_[i]);
    for (;;) {
      if (i < tolerances_.size()) make_level(i);  // OUT may repeat the last level
      end_if_interrupted();
      if (looks_wrong(outputs_[i]) && takes_back(outputs_[i])) continue;
      certify(i, bar);
      if (!tightens_appearance(i)) break;
    }
    if (i > 0 && outputs_[i].summary().faces > outputs_[i - 1].summary().faces) take_finer(i);
  }
  report_.effort = options_.effort;
  report_.driver = options_.driver;
  report_.locked_vertices = result_.locked_vertices;
  report_.pruned = {result_.pruned_components, result_.pruned_faces};
  report_.stopped_by = to_string(result_.last().ended_by);
  report_.collapses = {result_.last().collapses_performed, result_.last().collapses_refused,
                       result_.counts.proven_together, result_.counts.taken_back, result_.counts.proven_alone};
}

/// Sets `result_`, whose only level is this one.
void Run::make_level(std::size_t level) {
  watch_.lap();
  if (scene_) {
    const bool is_last = level + 1 == tolerances_.size();
    const double tolerance = is_last ? simplify_.tolerance : before_rounding(tolerances_[level]);
    SimplifiedLevel made = scene_->next(tolerance, is_last ? target_faces(original_, simplify_) : 0);
    result_ = {};
    result_.levels.push_back(std::move(made));
    scene_->describe(result_);
    if (is_last && !bounds_appearance()) scene_.reset();  // nothing will be taken back: room for the measurement
  } else {
    result_ = options_.workers->decimate(*stored_original_, simplify_);
  }
  report_.seconds.simplify += watch_.lap();
}

/// All options of the decimation except its tolerances.
SimplifyOptions Run::decimation_options(ProgressBar& bar) const {
  SimplifyOptions simplify = decimation(outputs_.back(), bar);
  if (options_.target_faces) simplify.target_faces = static_cast<std::size_t>(*options_.target_faces);
  simplify.target_ratio = target_ratio_;
  simplify.on_exceed = options_.on_exceed == "stop" ? OnExceed::Stop : OnExceed::Skip;
  simplify.effort = options_.effort == "high" ? Effort::High : Effort::Normal;
  simplify.prune = options_.prune;
  simplify.normal_tolerance = options_.normal_tolerance;
  if (original_texture_) guard_texture(simplify);
  return simplify;
}

/// Makes the decimation refuse collapses that move the texture too far.
void Run::guard_texture(SimplifyOptions& simplify) const {
  const CornerAttribute& from = attributes_.texture_coordinates;
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  for (const Triangle& index : from.index) {
    auto& corners = simplify.texture_coordinates.emplace_back();
    for (std::size_t k = 0; k < 3; ++k)
      corners[k] = index[k] == CornerAttribute::none ? Eigen::Vector2d(none, none) : from.values[index[k]].head<2>();
  }
  simplify.materials = attributes_.materials.index;
  simplify.texture_tolerance = original_texture_->tolerance;
}

void Run::set_requirements(GatedOutput& output) const {
  if (original_lines_) output.require_lines(&*original_lines_);
  if (original_texture_) output.require_texture(&*original_texture_);
  output.require_normals(options_.normal_tolerance);
}

/// Whether the level that was made last moves the texture too far or turns faces too much. What is seen before it is
/// written need not be written again.
bool Run::looks_wrong(GatedOutput& output) {
  if (!scene_ || !bounds_appearance()) return false;
  watch_.lap();
  look_at(output, result_.last());
  report_.seconds.certify += watch_.lap();
  return !output.keeps_appearance();
}

/// Writes the level under a temporary name, reads it back and measures that.
void Run::certify(std::size_t index, ProgressBar& bar) {
  GatedOutput& output = outputs_[index];
  const double tolerance = tolerance_of(index);
  watch_.lap();
  (void)writes(output, result_.last());  // if this fails, `prove` falls back to a finer level or the original
  report_.seconds.write += watch_.lap();
  const auto redo = [&](double smaller) {
    SimplifyOptions again = decimation_options(bar);
    again.tolerance = before_rounding(smaller);
    return decimated(again);
  };
  decided_by_.resize(index + 1);
  decided_by_[index] = prove(output, tolerance, index > 0 ? &outputs_[index - 1] : nullptr, redo);
  verdict_ = output.verdict();
  report_.seconds.certify += watch_.lap();
  if (verdict_ == Verdict::Exceeds && !result_.tolerance_below_rounding)
    throw Error(
        "internal error: the result is further from the original than was proven during decimation; nothing was "
        "written under its name. Please report this with the folder " +
        save_reproducer(options_, output, {tolerances_, tolerance, target_ratio_}).string());
}

/// Undoes what has led to a texture that has moved too far or to faces that have turned too much. False if nothing was
/// undone, or not in time.
bool Run::takes_back(const GatedOutput& output) {
  end_if_interrupted();
  if (is_out_of_time()) return false;
  watch_.lap();
  const bool is_changed = scene_->take_back(refuted_by(output));
  report_.seconds.simplify += watch_.lap();
  return is_changed;
}

/// Takes back what moves the texture too far or turns faces too much as the file reads. A result that does not get
/// within these tolerances in this way is replaced by the original.
bool Run::tightens_appearance(std::size_t index) {
  GatedOutput& output = outputs_[index];
  if (output.verdict() != Verdict::Within || output.keeps_appearance()) return false;
  if (takes_back(output)) return true;
  const bool has_smaller = index > 0 && outputs_[index - 1].keeps_appearance();
  decided_by_[index] =
      fall_back(output, has_smaller ? &outputs_[index - 1] : nullptr, measurement(tolerance_of(index)));
  return false;
}

/// Replaces a level by the finer one before it, which is within its tolerance too.
void Run::take_finer(std::size_t index) {
  decided_by_[index] = fall_back(outputs_[index], &outputs_[index - 1], measurement(tolerance_of(index)));
  verdict_ = outputs_[index].verdict();
}

void Run::end_if_interrupted() const {
  if (interrupted_) throw Error("interrupted before the result was proven; nothing was written");
}

/// Also of the lines and the texture if there are any with a tolerance. Absent if the time ended.
std::optional<Certificate> Run::certificate_of(const GatedOutput& output, double tolerance,
                                               CertificateOptions options) const {
  MeshFile file;
  if (original_texture_)
    file = output.written_with_attributes();
  else
    file.mesh = output.written_mesh();
  const TriangleMesh& written = file.mesh;
  if (options_.workers != nullptr)
    return options_.workers->certify(*stored_original_, MeshInMemory(written), tolerance, options);
  if (original_lines_)
    options.lines = CertifiedLines{lines_, output.lines_of(written), std::min(tolerance, original_lines_->tolerance)};
  const Stopwatch watch;
  auto certificate = build_certificate(original_, written, tolerance, options);
  if (!certificate || !original_texture_) return certificate;
  options.seconds -= watch.seconds();
  auto with_texture =
      with_texture_proof(*certificate, textured_meshes(original_, attributes_, written, file.attributes),
                         original_texture_->tolerance, options);
  if (!with_texture) return std::nullopt;
  return std::move(with_texture->certificate);
}

/// Proves the files as they read. A result whose certificate is not complete in time is replaced by the original, which
/// is certified in one pass.
void Run::write_certificates() {
  if (certificates_.empty()) return;
  watch_.lap();
  ProgressBar bar("proving", options_.common.quiet);
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    CertificateOptions options;
    options.threads = options_.common.threads;
    const bool is_original = decided_by_[i] == DecidedBy::Original || result_.last().collapses_performed == 0;
    if (!is_original) options.seconds = remaining(1);
    options.cancel = &interrupted_;
    options.progress = [&](double fraction) { bar.show(fraction); };
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
  report_.seconds.certificate = watch_.lap();
}

/// Measures deviations of the meshes as they read from their files. Leaves `deviation_` empty if there was no time for
/// it.
void Run::measure_deviation() {
  const ProgressBar bar("measuring deviations", options_.common.quiet);
  const GatedOutput& out = outputs_.back();
  const MeshFile written = out.written_with_attributes();
  const TriangleMesh& result = written.mesh;
  const HausdorffDistance& distance = out.distance();
  DeviationSubject subject;
  subject.original = &original_;
  subject.result = &result;
  const CornerAttribute &before = attributes_.texture_coordinates, &after = written.attributes.texture_coordinates;
  if (!before.empty()) subject.original_texture = &before;
  if (!after.empty()) subject.result_texture = &after;
  subject.original_name = "original";
  subject.result_name = "simplified";
  subject.scale = scale_for(tolerances_.back(), distance.bounds, diagonal_);
  const auto worst = worst_spot(distance.bounds, distance.a_to_b, &distance.b_to_a);
  subject.worst_is_on_original = !worst || worst->on_a;
  subject.measurement = repeated(tolerances_.back(), decided_by_.back());
  if (!options_.deviation.report.empty())
    for (std::size_t i = 0; i + 1 < outputs_.size(); ++i) subject.levels.push_back(outputs_[i].written_mesh());
  try {
    deviation_->measure(subject, {options_.common.threads, stop()});
    report_.deviation = deviation_->report();
  } catch (const Stopped&) {
    end_if_interrupted();
    deviation_.reset();
    std::fprintf(stderr, "%s: no time was left to measure deviations; their files were not written\n",
                 provenance().tool.c_str());
  }
}

/// Publishes certificates last, so that the mesh of each published certificate is there.
void Run::publish() {
  if (has_document())
    for (const GatedOutput& output : outputs_) checksums_.push_back(output.checksum());
  const UninterruptedScope together;
  for (GatedOutput& output : outputs_) output.publish();
  for (AtomicFile& certificate : certificates_) certificate.commit();
}

void Run::report() {
  const GatedOutput& out = outputs_.back();
  report_.verdict = verdict_;
  report_.decided_by = decided_by_.empty() ? DecidedBy::Measurement : decided_by_.back();
  if (ended_by_time()) report_.stopped_by = to_string(EndedBy::TimeLimit);
  report_.provenance = provenance();
  report_.simplified = {verdict_ == Verdict::Within ? as_typed(options_.output) : "", out.summary()};
  if (!checksums_.empty()) report_.simplified.sha256 = checksums_.back();
  report_.distance = out.distance();
  report_.lines = line_report(out, report_.tolerance);
  if (original_texture_ && out.texture_deviation())
    report_.texture =
        TextureReport{*out.texture_deviation(), original_texture_->tolerance, options_.texture_size, texel_length_};
  if (options_.normal_tolerance && out.normal_deviation())
    report_.normals = NormalReport{*out.normal_deviation(), *options_.normal_tolerance};
  for (std::size_t i = 0; i + 1 < outputs_.size() && verdict_ == Verdict::Within; ++i)
    report_.levels.push_back({tolerances_[i], decided_by_[i], outputs_[i].path().string(), outputs_[i].summary().faces,
                              outputs_[i].distance(), line_report(outputs_[i], tolerances_[i]),
                              checksums_.empty() ? "" : checksums_[i]});
  report_.threads = threads();
  if (options_.workers != nullptr) report_.communication = options_.workers->communication();
  report_.seconds.total = watch_.seconds();
  if (!options_.common.json.empty()) write_text(options_.common.json, to_json(report_));
  if (report_.deviation) deviation_->write(to_json(report_));
  const bool is_stdout_taken = options_.common.json == "-" || is_stream_path(options_.output);
  if (!is_stdout_taken && !options_.common.quiet)
    print_summary({options_, report_, result_, outputs_, decided_by_, ended_by_time(), diagonal_});
  if (verdict_ == Verdict::Within && ended_by_time())
    std::fprintf(stderr, "%s: the time limit came first: %s is the best mesh that was proven by then\n",
                 provenance().tool.c_str(), as_typed(options_.output).c_str());
  if (verdict_ != Verdict::Within)
    std::fprintf(
        stderr,
        "%s: the tolerance is smaller than the rounding of the output format; use PLY, OFF or OBJ; nothing was "
        "written\n",
        provenance().tool.c_str());
}

bool Run::ended_by_time() const {
  if (!options_.common.has_time_limit) return false;
  const bool was_late = std::any_of(decided_by_.begin(), decided_by_.end(), [](DecidedBy how) {
    return how == DecidedBy::SmallerLevel || how == DecidedBy::Original;
  });
  return result_.last().ended_by == EndedBy::TimeLimit || (was_late && remaining(1) == 0);
}

}  // namespace

int run_simplify(const SimplifyArguments& options) {
  if (!options.memory.empty()) limit_memory(parse_memory("--memory", options.memory));
  return Run(options)();
}

}  // namespace meshbound::tools
