// SPDX-License-Identifier: MIT
// The Hausdorff distance between two meshes as a proven interval, or the decision whether it is at most a tolerance.
#include "hausdorff/distance_run.h"

#include <algorithm>
#include <cstdio>
#include <optional>
#include <string>

#include "common/affine_argument.h"
#include "common/distinct_files.h"
#include "common/length.h"
#include "common/memory.h"
#include "common/mesh_input.h"
#include "common/output.h"
#include "common/progress.h"
#include "common/provenance.h"
#include "common/run_clock.h"
#include "common/run_limits.h"
#include "common/signals.h"
#include "common/threads.h"
#include "common/tile_workers.h"
#include "common/tool_main.h"
#include "deviation/deviation_outputs.h"
#include "hausdorff/answer.h"
#include "hausdorff/motion.h"
#include "hausdorff/nearest.h"
#include "hausdorff/question.h"
#include "hausdorff/text_report.h"
#include "mesh/atomic_file.h"
#include "mesh/texture_transform.h"
#include "meshbound/certificate.h"
#include "meshbound/error.h"
#include "meshbound/io.h"
#include "meshbound/mesh_summary.h"
#include "meshbound/pose.h"
#include "meshbound/report.h"
#include "meshbound/texture_certificate.h"
#include "meshbound/texture_deviation.h"
#include "meshbound/transform.h"
#include "tiles/measure_in_tiles.h"

namespace meshbound::tools {
namespace {

/// Reads a mesh and, if there is a map, maps it. Returns a bound of how far rounding has moved its vertices.
double load(const std::string& path, const std::optional<AffineMap>& map, bool with_checksum, const StopToken& stop,
            TriangleMesh& mesh, MeshReport& report, MeshAttributes* attributes) {
  mesh = read_input(path, with_checksum, report, stop, attributes);
  report.dropped.reset();  // nothing is written again
  double displacement = 0;
  if (map) {
    TransformedMesh image = transformed(mesh, *map);
    mesh = std::move(image.mesh);
    displacement = image.displacement_bound;
    report.summary = summarise(mesh);
  }
  return displacement;
}

DistanceOptions engine_options(const Arguments& arguments, const RunClock& clock, ProgressBar& bar) {
  DistanceOptions options;
  options.method = arguments.method;
  set_run_limits(options, arguments.common, clock, bar);
  return options;
}

/// Answers by searching trees. Building these may take until `patience` after the time limit, since the bounds that a
/// search gives at once are worth more than that time; later, nothing is searched.
Answer searched_answer(const Question& question, const TriangleMesh& a, const TriangleMesh& b,
                       const Arguments& arguments, RunClock& clock, double& build_seconds) {
  try {
    const auto [tree_a, tree_b] = build_trees(a, b, {arguments.common.threads, clock.stop(patience)});
    build_seconds = clock.lap();
    ProgressBar bar("measuring", arguments.common.quiet);
    return answer_by_trees(question, tree_a, tree_b, engine_options(arguments, clock, bar));
  } catch (const Stopped&) {
    return unsearched_answer(question);
  }
}

/// The threads that work on tiles within the memory. A proof takes as much as what makes a mesh that it is of.
int threads_on_tiles(const Arguments& arguments, const StoredMesh& a, const StoredMesh& b) {
  if (arguments.memory.empty()) return arguments.common.threads;
  return threads_within(parse_memory("--memory", arguments.memory), "--memory " + arguments.memory,
                        a.triangle_count() + b.triangle_count(), TileOptions{arguments.tile_triangles},
                        arguments.certificate.empty() ? cost_of_measuring : cost_of_simplifying,
                        arguments.common.threads);
}

/// The answer without trees for two meshes with equally many triangles: small ones are loaded, blocks of large ones are
/// compared where they are.
std::optional<Answer> answer_without_tiles(const Question& question, const StoredMesh& a, const StoredMesh& b,
                                           const Arguments& arguments) {
  const TileOptions tiles{arguments.tile_triangles};
  if (fits_to_compare(a.vertex_count() + b.vertex_count(), a.triangle_count() + b.triangle_count(), tiles))
    return answer_without_trees(question, loaded(a), loaded(b), arguments.method);
  return answer_without_trees(question, a, b, arguments.method);
}

/// As `searched_answer`, tile by tile.
Answer answer_by_tiles(const Question& question, const StoredMesh& a, const StoredMesh& b, const Arguments& arguments,
                       const RunClock& clock) {
  ProgressBar bar("measuring", arguments.common.quiet);
  DistanceOptions options = engine_options(arguments, clock, bar);
  options.threads = threads_on_tiles(arguments, a, b);
  return answer_in_tiles(question, a, b, options, *arguments.workers);
}

/// Checks, before any work, that no output replaces an input and that every output can be written.
void check_paths(const Arguments& arguments) {
  std::vector<NamedPath> outputs = arguments.deviation.outputs();
  outputs.push_back({"--json", arguments.common.json});
  outputs.push_back({"--certificate", arguments.certificate});
  require_distinct_files({{"A", arguments.a}, {"B", arguments.b}, {"--transform-b", arguments.transform_b}}, outputs);
  arguments.deviation.check();
  check_writable(arguments.common.json);
}

/// What is compared, as read.
struct Meshes {
  TriangleMesh a, b;                                ///< empty where there are workers on tiles
  std::unique_ptr<StoredMesh> stored_a, stored_b;   ///< for these
  MeshAttributes attributes_of_a, attributes_of_b;  ///< empty unless textures are compared
  double displacement = 0;                          ///< how far rounding has moved the image of B at most, model units

  [[nodiscard]] std::array<TexturedMesh, 2> textured() const {
    return textured_meshes(a, attributes_of_a, b, attributes_of_b);
  }
};

std::optional<Certificate> certificate_of(const Arguments& arguments, const Meshes& meshes, double tolerance,
                                          CertificateOptions options) {
  if (arguments.workers == nullptr) return build_certificate(meshes.a, meshes.b, tolerance, options);
  const StoredMesh &a = *meshes.stored_a, &b = *meshes.stored_b;
  options.threads = threads_on_tiles(arguments, a, b);
  return arguments.workers->certify(a, b, tolerance, options);
}

/// Writes the proof of tolerances that were found to hold, that of the texture where there is one, under no name yet.
/// False if there was no time for it.
bool write_certificate(AtomicFile& file, const Arguments& arguments, const Meshes& meshes, double tolerance,
                       const std::optional<double>& texture_tolerance, const RunClock& clock) {
  ProgressBar bar("proving", arguments.common.quiet);
  CertificateOptions options;
  options.threads = arguments.common.threads;
  options.cancel = &interrupted();
  options.progress = bar.callback();
  options.seconds = clock.seconds_left();
  auto certificate = certificate_of(arguments, meshes, tolerance, options);
  if (!certificate) return false;
  if (texture_tolerance) {
    options.seconds = clock.seconds_left();
    auto with_texture = with_texture_proof(*certificate, meshes.textured(), *texture_tolerance, options);
    if (!with_texture) return false;
    certificate = std::move(with_texture->certificate);
  }
  file.write({reinterpret_cast<const char*>(certificate->bytes.data()), certificate->bytes.size()});
  file.complete();
  return true;
}

/// How a browser repeats the search for the answer.
RepeatedMeasurement repeated(const Answer& answer, const Question& question, const Arguments& arguments) {
  RepeatedMeasurement repeated;
  repeated.decides = question.tolerance && (question.decide_first || !question.error_bound);
  repeated.error_bound = question.error_bound;
  repeated.tolerance = question.tolerance;
  repeated.one_sided = question.one_sided;
  const char* reason = nullptr;
  if (question.displacement > 0) reason = "--transform-b moved B.";
  if (arguments.method != Method::CellWalking) reason = "by another --method.";
  if (answer.outcome == Outcome::BudgetExhausted) reason = "a limit of time ended it.";
  if (reason != nullptr)
    repeated.obstacle = std::string("The engine of this page cannot repeat how this was measured: ") + reason;
  return repeated;
}

/// Measures what heatmaps, pictures and reports show. False if there was no time for it.
bool measure_deviation(DeviationOutputs& outputs, const Answer& answer, const Question& question, const TriangleMesh& a,
                       const TriangleMesh& b, const Arguments& arguments, const RunClock& clock) {
  const ProgressBar bar("measuring deviations", arguments.common.quiet);
  DeviationSubject subject(a, b, question.tolerance.value_or(0), answer.bounds, answer.a_to_b,
                           answer.b_to_a ? &*answer.b_to_a : nullptr);
  subject.original_name = "A";
  subject.result_name = "B";
  subject.measurement = repeated(answer, question, arguments);
  try {
    outputs.measure(subject, {arguments.common.threads, clock.stop()});
    return true;
  } catch (const Stopped&) {
    if (interrupted()) throw Error("interrupted before the deviation was measured; none of its files was written");
    return false;
  }
}

void fill(DistanceReport& report, const Answer& answer, const Question& question, const Arguments& arguments) {
  report.provenance = provenance();
  report.verdict = answer.verdict;
  report.outcome = answer.outcome;
  report.reason = answer.reason;
  report.error_bound = question.error_bound;
  report.tolerance = question.tolerance;
  report.bounds = answer.bounds;
  report.a_to_b = answer.a_to_b;
  report.b_to_a = answer.b_to_a;
  report.worst_was_wanted = arguments.worst;
  report.texture_was_wanted = arguments.texture;
  report.worst = worst_spot(answer.bounds, answer.a_to_b, answer.b_to_a ? &*answer.b_to_a : nullptr);
}

/// Makes all files appear, the JSON document last: everything that a full disk can prevent comes before the first one.
void publish(std::optional<AtomicFile>& certificate, std::optional<DeviationOutputs>& deviation,
             const DistanceReport& report, const Arguments& arguments) {
  std::optional<StagedText> json;
  if (!arguments.common.json.empty()) json.emplace(arguments.common.json, to_json(report), stop_at_signal());
  if (deviation) deviation->stage(to_json(report));
  const UninterruptedScope together;
  if (certificate) certificate->commit();
  if (deviation) deviation->publish();
  if (json) json->publish();
}

/// Reports the bounds proven before an interruption: they may have taken an hour.
[[noreturn]] void throw_interrupted(const Bounds& bounds) {
  throw Error("interrupted; proven until then: " + exact_number(bounds.lower) +
              " <= distance <= " + exact_number(bounds.upper));
}

void widen(TextureDeviation& deviation, double displacement) {
  deviation.bounds = widened(deviation.bounds, displacement);
  deviation.a_to_b.bounds = widened(deviation.a_to_b.bounds, displacement);
  deviation.b_to_a.bounds = widened(deviation.b_to_a.bounds, displacement);
}

void require_texture(const std::string& path, const MeshAttributes& attributes) {
  if (attributes.texture_coordinates.empty())
    throw InvalidInput(path + ": no texture coordinates were found, which --texture needs");
}

/// Makes the exit code the worse of the two answers: exceeding one tolerance counts whatever else is undecided.
void join(Answer& answer, Verdict texture) {
  if (texture == Verdict::Within || answer.exit_code == ExitExceeds) return;
  answer.exit_code = exit_code(texture);
  answer.verdict = to_string(texture);
  if (texture == Verdict::Exceeds) answer.outcome = Outcome::ExceedsTolerance;
}

/// Width of the interval that a texture deviation with a tolerance is measured to, as a share of that.
constexpr double share_of_texture_tolerance = 0.01;

/// To the error bound that is wanted. Where only a tolerance counts, to a small share of that, and where this does not
/// tell, to the error bound of measurements without a tolerance.
TextureDeviation deviation_of(const std::array<TexturedMesh, 2>& meshes, const TextureDeviationOptions& options,
                              const std::optional<double>& tolerance) {
  if (tolerance && !options.error_bound) {
    TextureDeviationOptions rough = options;
    rough.error_bound = share_of_texture_tolerance * *tolerance;
    const TextureDeviation deviation = texture_deviation(meshes[0], meshes[1], rough);
    if (verdict_of(deviation.bounds, *tolerance) != Verdict::Undecided) return deviation;
  }
  return texture_deviation(meshes[0], meshes[1], options);
}

void measure_texture(DistanceReport& report, const Arguments& arguments, const TypedLengths& lengths,
                     const Meshes& compared, const RunClock& clock, Answer& answer) {
  TextureReport texture;
  const std::array<TexturedMesh, 2> meshes = compared.textured();
  texture.compares_floats = compared.attributes_of_a.texture_precision != compared.attributes_of_b.texture_precision;
  const double diagonal = report.a.summary.bbox_diagonal;
  texture.texture_size = arguments.texture_size;
  if (texture.texture_size)
    texture.texel_length = texel_length(meshes[0], *texture.texture_size * texture_scale(compared.attributes_of_a));
  if (lengths.texture_tolerance)
    texture.tolerance = lengths.texture_tolerance->in_model_units(diagonal, texture.texel_length);
  TextureDeviationOptions options;
  options.threads = arguments.common.threads;
  options.stop = clock.stop(patience);
  if (lengths.error_bound) options.error_bound = lengths.error_bound->in_model_units(diagonal);
  const bool decides = texture.tolerance && !arguments.worst;
  try {
    texture.deviation = deviation_of(meshes, options, decides ? texture.tolerance : std::nullopt);
  } catch (const Stopped&) {
    if (interrupted()) throw_interrupted(answer.bounds);
    join(answer, Verdict::Undecided);
    answer.outcome = Outcome::BudgetExhausted;
    answer.reason = "the time limit came before the texture deviation was measured";
    return;
  }
  if (report.transform_displacement) widen(texture.deviation, *report.transform_displacement);
  if (texture.tolerance) join(answer, verdict_of(texture.deviation.bounds, *texture.tolerance));
  report.texture = texture;
}

/// Reads B for workers on tiles. As `load`.
double load_for_tiles(const Arguments& arguments, const std::optional<AffineMap>& map, bool with_checksum,
                      const StopToken& stop, Meshes& meshes, MeshReport& report) {
  if (!map) {
    meshes.stored_b = read_stored_input(arguments.b, with_checksum, report, stop, *arguments.workers);
    return 0;
  }
  TriangleMesh image;
  const double displacement = load(arguments.b, map, with_checksum, stop, image, report, nullptr);
  meshes.stored_b = std::make_unique<MeshInSpace>(arguments.workers->space(), image);
  return displacement;
}

Meshes read_meshes(const Arguments& arguments, const RunClock& clock, DistanceReport& report) {
  std::optional<AffineMap> map;
  if (!arguments.transform_b.empty()) map = parse_affine("--transform-b", arguments.transform_b);
  const bool with_checksums = !arguments.common.json.empty() || !arguments.deviation.report.empty();
  const StopToken stop = clock.stop_of_reading();
  Meshes meshes;
  if (arguments.workers != nullptr) {
    meshes.stored_a = read_stored_input(arguments.a, with_checksums, report.a, stop, *arguments.workers);
    meshes.displacement = load_for_tiles(arguments, map, with_checksums, stop, meshes, report.b);
    report.a.dropped.reset();  // nothing is written again
    report.b.dropped.reset();
  } else {
    run_both(
        arguments.common.threads,
        [&] {
          load(arguments.a, std::nullopt, with_checksums, stop, meshes.a, report.a,
               arguments.texture ? &meshes.attributes_of_a : nullptr);
        },
        [&] {
          meshes.displacement = load(arguments.b, map, with_checksums, stop, meshes.b, report.b,
                                     arguments.texture ? &meshes.attributes_of_b : nullptr);
        });
  }
  if (map) report.transform_displacement = meshes.displacement;
  return meshes;
}

/// The width of the interval where no other is asked for.
double default_width(const Meshes& meshes, double diagonal) {
  return meshes.stored_a ? default_error_bound(*meshes.stored_a, *meshes.stored_b, diagonal)
                         : default_error_bound(meshes.a, meshes.b, diagonal);
}

Answer answer_to(const Question& question, const Meshes& meshes, const Arguments& arguments, RunClock& clock,
                 double& build_seconds) {
  std::optional<Answer> found;
  if (arguments.workers == nullptr) {
    found = answer_without_trees(question, meshes.a, meshes.b, arguments.method);
    if (!found) found = searched_answer(question, meshes.a, meshes.b, arguments, clock, build_seconds);
  } else {
    const StoredMesh &a = *meshes.stored_a, &b = *meshes.stored_b;
    if (a.triangle_count() == b.triangle_count()) found = answer_without_tiles(question, a, b, arguments);
    if (!found) found = answer_by_tiles(question, a, b, arguments, clock);
  }
  conclude(*found, question);
  if (interrupted() && found->exit_code == ExitUndecided) throw_interrupted(found->bounds);
  return std::move(*found);
}

/// Writes the certificate of a tolerance that was found to hold, or drops the file; the answer is undecided if there
/// was no time for it.
void certify(std::optional<AtomicFile>& file, const Arguments& arguments, const Meshes& meshes, double tolerance,
             const std::optional<double>& texture_tolerance, const RunClock& clock, Answer& answer) {
  const bool holds = answer.exit_code == ExitDone;
  if (holds && write_certificate(*file, arguments, meshes, tolerance, texture_tolerance, clock)) return;
  file.reset();
  if (!holds) return;
  if (interrupted()) throw Error("interrupted before the certificate was complete; it was not written");
  std::fprintf(stderr, "%s: no time was left for the certificate; it was not written\n", provenance().tool.c_str());
  answer.exit_code = ExitUndecided;
  answer.outcome = Outcome::BudgetExhausted;
  answer.reason = "the time limit came before the certificate was complete";
}

}  // namespace

int run_distance(const Arguments& arguments) {
  RunClock clock(arguments.common);
  const TypedLengths lengths = parse_lengths(arguments);
  if (!arguments.memory.empty()) limit_memory(parse_memory("--memory", arguments.memory));
  if (!arguments.nearest.empty()) return run_nearest(arguments);
  if (!arguments.poses.empty()) return run_motion(arguments);
  check_paths(arguments);
  std::optional<AtomicFile> certificate;
  std::optional<DeviationOutputs> deviation;
  if (arguments.deviation.has_any()) deviation.emplace(arguments.deviation);
  if (!arguments.certificate.empty())
    certificate.emplace(arguments.certificate, AtomicFile::Stream::Staged, stop_at_signal());

  DistanceReport report;
  const Meshes meshes = read_meshes(arguments, clock, report);
  const Question question = question_about(default_width(meshes, report.a.summary.bbox_diagonal), arguments, lengths,
                                           report.a.summary.bbox_diagonal, meshes.displacement);
  report.seconds.read = clock.lap();
  Answer answer = answer_to(question, meshes, arguments, clock, report.seconds.build);
  report.seconds.query = clock.lap();
  if (arguments.texture) {
    require_texture(arguments.a, meshes.attributes_of_a);
    require_texture(arguments.b, meshes.attributes_of_b);
    measure_texture(report, arguments, lengths, meshes, clock, answer);
  }
  if (certificate) {
    const auto texture_tolerance = report.texture ? report.texture->tolerance : std::nullopt;
    certify(certificate, arguments, meshes, *question.tolerance, texture_tolerance, clock, answer);
  }
  if (deviation && measure_deviation(*deviation, answer, question, meshes.a, meshes.b, arguments, clock)) {
    report.deviation = deviation->report();
  } else if (deviation) {
    deviation.reset();
    std::fprintf(stderr, "%s: no time was left to measure deviations; their files were not written\n",
                 provenance().tool.c_str());
    answer.exit_code = ExitUndecided;
  }
  report.threads = arguments.common.threads;
  if (arguments.workers != nullptr) report.communication = arguments.workers->communication();
  report.seconds.total = clock.seconds();
  fill(report, answer, question, arguments);
  publish(certificate, deviation, report, arguments);
  tell(arguments.common, closing_line(report), [&] { print_report(report, arguments.profile); });
  return answer.exit_code;
}

}  // namespace meshbound::tools
