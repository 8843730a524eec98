// SPDX-License-Identifier: MIT
// The Hausdorff distance between two meshes as a proven interval, or the decision whether it is at most a tolerance.
#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <optional>
#include <string>

#include "common/affine_argument.h"
#include "common/length.h"
#include "common/output.h"
#include "common/pending_file.h"
#include "common/progress.h"
#include "common/signals.h"
#include "common/threads.h"
#include "common/tool_main.h"
#include "meshbound/certificate.h"
#include "meshbound/distance.h"
#include "meshbound/error.h"
#include "meshbound/io.h"
#include "meshbound/report.h"
#include "meshbound/transform.h"

namespace {

using namespace meshbound;
using namespace meshbound::tools;

struct Arguments {
  std::string a;
  std::string b;
  std::string error_bound;
  std::string tolerance;
  std::string transform_b;
  bool one_sided = false;
  bool profile = false;
  std::string certificate;
  Method method = Method::CellWalking;
  CommonOptions common;
};

/// Seconds since the last call, and since the start.
class Stopwatch {
 public:
  double lap() {
    const auto now = Clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return seconds;
  }
  [[nodiscard]] double total() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_ = start_;
};

/// The lengths of the question in model units.
struct Question {
  std::optional<double> error_bound;
  std::optional<double> tolerance;
  bool error_bound_was_given = false;
  bool one_sided = false;
  double displacement = 0;  ///< rounding of the transformed B: every bound is widened by it
};

struct Answer {
  Bounds bounds;
  OneSidedDistance a_to_b;
  std::optional<OneSidedDistance> b_to_a;
  std::string verdict;
  ExitCode exit_code = ExitUndecided;
};

void add_arguments(CLI::App& app, Arguments& arguments) {
  app.add_option("A", arguments.a, "The original: OFF, OBJ, PLY or STL")->required();
  app.add_option("B", arguments.b, "The mesh to compare with it")->required();
  app.add_option("--error-bound", arguments.error_bound,
                 "Wanted width of the interval: model units, or '0.1%' of A's bounding-box diagonal (default 0.0001%)");
  app.add_option("--tolerance", arguments.tolerance,
                 "Decide whether the distance is at most this (units as above): exit 0 within, 1 exceeds, 3 undecided. "
                 "Stops as soon as that is known, unless --error-bound is given too");
  app.add_flag("--one-sided", arguments.one_sided, "Only from A to B");
  app.add_option("--transform-b", arguments.transform_b,
                 "Affine map for the vertices of B: 16 numbers, row-major, or a file that holds them");
  app.add_flag("--profile", arguments.profile, "Print culling rates, queries, subdivisions and the time of each phase");
  app.add_option("--certificate", arguments.certificate,
                 "With --tolerance: write the proof that the distance is within it, for verify_certificate");
  const std::map<std::string, Method> methods{{"cell-walking", Method::CellWalking},
                                              {"cross-culling", Method::CrossCulling}};
  app.add_option("--method", arguments.method,
                 "cell-walking (default), or cross-culling: the method of Tang, Lee, Kim 2009, Lemma 4 in a sound form")
      ->transform(CLI::CheckedTransformer(methods));
  add_common_options(app, arguments.common);
}

/// Default width of the interval: 1e-6 of the diagonal of A; of both meshes together when A is a single point.
double default_error_bound(const TriangleMesh& a, const TriangleMesh& b, double diagonal) {
  if (diagonal > 0) return 1e-6 * diagonal;
  const Eigen::AlignedBox3d box = used_bounding_box(a).merged(used_bounding_box(b));
  return 1e-6 * (box.max() - box.min()).stableNorm();
}

Verdict verdict_of(const Bounds& bounds, double tolerance) {
  if (bounds.upper <= tolerance) return Verdict::Within;
  return bounds.lower > tolerance ? Verdict::Exceeds : Verdict::Undecided;
}

ToleranceCheck check(const Bvh& a, const Bvh& b, double tolerance, const Question& question,
                     const DistanceOptions& options) {
  return question.one_sided ? check_one_sided(a, b, tolerance, options) : check_symmetric(a, b, tolerance, options);
}

/// At or below this for the rounded image of B, the distance to the exact one is within the tolerance.
double shrunk_tolerance(const Question& question) {
  return widened({*question.tolerance, *question.tolerance}, question.displacement).lower;
}

/// Decides for the exact image of B from its rounded one, which is at most `displacement` away.
Answer decide(const Bvh& a, const Bvh& b, const Question& question, DistanceOptions options) {
  const double tolerance = *question.tolerance;
  ToleranceCheck result = check(a, b, shrunk_tolerance(question), question, options);
  if (question.displacement > 0 && result.verdict == Verdict::Exceeds &&
      !(widened(result.bounds, question.displacement).lower > tolerance)) {
    const double used = result.a_to_b.stats.seconds + result.b_to_a.stats.seconds;
    options.budget.seconds = std::max(0.0, options.budget.seconds - used);
    result = check(a, b, widened({tolerance, tolerance}, question.displacement).upper, question, options);
  }
  Answer answer{result.bounds, result.a_to_b, std::nullopt, {}, ExitUndecided};
  if (!question.one_sided) answer.b_to_a = result.b_to_a;
  return answer;
}

Answer measure(const Bvh& a, const Bvh& b, const Question& question, const DistanceOptions& options) {
  if (question.one_sided) {
    OneSidedDistance result = one_sided_distance(a, b, options);
    return {result.bounds, result, std::nullopt, {}, ExitUndecided};
  }
  const SymmetricDistance result = symmetric_distance(a, b, options);
  return {result.bounds, result.a_to_b, result.b_to_a, {}, ExitUndecided};
}

void widen(Answer& answer, double displacement) {
  answer.bounds = widened(answer.bounds, displacement);
  answer.a_to_b.bounds = widened(answer.a_to_b.bounds, displacement);
  if (answer.b_to_a) answer.b_to_a->bounds = widened(answer.b_to_a->bounds, displacement);
}

/// Whether a measurement is what was asked for. A default error bound that doubles cannot reach is no failure; one that
/// was asked for is.
bool is_done(const Answer& answer, const Question& question) {
  if (answer.bounds.upper - answer.bounds.lower <= *question.error_bound) return true;
  const auto stopped_early = [](const OneSidedDistance& d) { return d.outcome == Outcome::BudgetExhausted; };
  const bool cut_short = stopped_early(answer.a_to_b) || (answer.b_to_a && stopped_early(*answer.b_to_a));
  return !question.error_bound_was_given && !cut_short;
}

/// What needs no trees: the same surface, or a copy of it that has hardly moved. Then the build takes no time.
std::optional<Answer> answer_without_trees(const Question& question, const TriangleMesh& a, const TriangleMesh& b,
                                           Method method) {
  if (method != Method::CellWalking) return std::nullopt;
  double limit = std::numeric_limits<double>::infinity();
  if (question.error_bound) limit = *question.error_bound;
  if (question.tolerance) limit = std::min(limit, shrunk_tolerance(question));
  const std::optional<SymmetricDistance> distance = distance_without_trees(a, b, limit);
  if (!distance) return std::nullopt;
  if (question.one_sided) return Answer{distance->a_to_b.bounds, distance->a_to_b, std::nullopt, {}, ExitUndecided};
  return Answer{distance->bounds, distance->a_to_b, distance->b_to_a, {}, ExitUndecided};
}

Answer answer_by_trees(const Question& question, const Bvh& a, const Bvh& b, const DistanceOptions& options) {
  const bool decision_only = question.tolerance && !question.error_bound_was_given;
  return decision_only ? decide(a, b, question, options) : measure(a, b, question, options);
}

/// Allows for the rounding of B's image, and says what came of it.
void conclude(Answer& answer, const Question& question) {
  widen(answer, question.displacement);
  if (question.tolerance) {
    const Verdict verdict = verdict_of(answer.bounds, *question.tolerance);
    answer.verdict = to_string(verdict);
    answer.exit_code = exit_code(verdict);
  } else {
    const bool done = is_done(answer, question);
    answer.verdict = done ? "done" : "undecided";
    answer.exit_code = done ? ExitDone : ExitUndecided;
  }
}

void print_mesh(const char* name, const MeshReport& mesh) {
  const MeshSummary& s = mesh.summary;
  std::printf("%s  %s: %zu triangles, %zu vertices, %zu component%s, %s, diagonal %s\n", name, mesh.path.c_str(),
              s.faces, s.vertices, s.components, s.components == 1 ? "" : "s", s.closed ? "closed" : "open",
              short_number(s.bbox_diagonal).c_str());
  if (mesh.triangulated_polygons > 0) std::printf("   %zu polygons split into triangles\n", mesh.triangulated_polygons);
  if (mesh.decoded_strips > 0) std::printf("   %zu triangle strips decoded\n", mesh.decoded_strips);
  if (mesh.ignored_elements > 0) std::printf("   %zu lines, points or empty faces ignored\n", mesh.ignored_elements);
}

void print_bounds(const char* label, const Bounds& bounds, double diagonal) {
  std::printf("%-20s lower %.17g, upper %.17g\n", label, bounds.lower, bounds.upper);
  std::printf("%-20s %s to %s\n", "", both_units(bounds.lower, diagonal).c_str(),
              both_units(bounds.upper, diagonal).c_str());
}

void print_direction(const char* label, const OneSidedDistance& distance, double diagonal) {
  print_bounds(label, distance.bounds, diagonal);
  if (distance.stats.closest_point_queries == 0 && distance.stats.matched == 0) return;
  const Eigen::Vector3d& from = distance.witness.from.position;
  const Eigen::Vector3d& to = distance.witness.nearest.position;
  std::printf("%-20s from (%.17g %.17g %.17g) to (%.17g %.17g %.17g)\n", "  witness", from.x(), from.y(), from.z(),
              to.x(), to.y(), to.z());
}

unsigned long long count(std::uint64_t n) { return n; }  // printf has no portable letter for it

/// The statistics that the paper reports in its Table 2 and Fig. 9, and what came of the triangles of one direction.
void print_profile(const char* label, const OneSidedDistance& distance) {
  const DistanceStats& s = distance.stats;
  std::printf("%-20s %.3f%% culled on A, %.5f%% culled on B\n", label, s.culled_on_a_percent, s.culled_on_b_percent);
  std::printf("%-20s %llu triangles: %llu identical, %llu culled by node, %llu by their corners, %llu subdivided\n", "",
              count(s.triangles), count(s.matched), count(s.culled_by_node), count(s.culled_by_vertices),
              count(s.walked));
  std::printf("%-20s %llu queries, %llu nodes, %llu triangles tested\n", "", count(s.closest_point_queries),
              count(s.nodes_visited), count(s.triangles_tested));
  std::printf("%-20s %llu subdivisions into %llu pieces, %u deep; %llu resolved, %llu enclosed, %llu given up\n", "",
              count(s.subdivisions), count(s.pieces), s.deepest_subdivision, count(s.resolved), count(s.enclosed),
              count(s.given_up));
  std::printf("%-20s matching %.4f s, culling on A %.4f s, on B %.4f s, subdivision %.4f s\n", "", s.phases.matching,
              s.phases.culling_on_a, s.phases.culling_on_b, s.phases.subdivision);
}

void print_report(const DistanceReport& report) {
  const double diagonal = report.a.summary.bbox_diagonal;
  print_mesh("A", report.a);
  print_mesh("B", report.b);
  print_direction("A to B", report.a_to_b, diagonal);
  if (report.b_to_a) print_direction("B to A", *report.b_to_a, diagonal);
  if (report.b_to_a) print_bounds("Hausdorff distance", report.bounds, diagonal);
  if (report.error_bound) std::printf("%-20s %s\n", "error bound", both_units(*report.error_bound, diagonal).c_str());
  if (report.tolerance) std::printf("%-20s %s\n", "tolerance", both_units(*report.tolerance, diagonal).c_str());
  if (report.transform_displacement)
    std::printf("%-20s %s, within the bounds\n", "transform rounding",
                short_number(*report.transform_displacement).c_str());
  std::printf("%-20s %s\n", "verdict", report.verdict.c_str());
  std::printf("%-20s read %.3f s, build %.3f s, query %.3f s, total %.3f s; %d thread%s\n", "time", report.seconds.read,
              report.seconds.build, report.seconds.query, report.seconds.total, report.threads,
              report.threads == 1 ? "" : "s");
}

/// Reads a mesh, and maps it if there is a map. Returns how far rounding has moved its image at most.
double load(const std::string& path, const std::optional<Eigen::Affine3d>& map, TriangleMesh& mesh,
            MeshReport& report) {
  MeshFile file = read_mesh(path);
  mesh = std::move(file.mesh);
  double displacement = 0;
  if (map) {
    TransformedMesh image = transformed(mesh, *map);
    mesh = std::move(image.mesh);
    displacement = image.displacement_bound;
  }
  report = {path, summarise(mesh), file.triangulated_polygons, file.decoded_strips, file.ignored_elements};
  return displacement;
}

DistanceOptions engine_options(const Arguments& arguments, const Question& question, const Stopwatch& watch,
                               ProgressBar& bar) {
  DistanceOptions options;
  options.error_bound = question.error_bound;
  if (question.error_bound && question.tolerance) options.tolerance = shrunk_tolerance(question);
  options.method = arguments.method;
  options.threads = arguments.common.threads;
  options.cancel = &watch_interrupts();
  options.progress = [&bar](double fraction) { bar.show(fraction); };
  if (arguments.common.has_time_limit)
    options.budget.seconds = std::max(0.0, arguments.common.time_limit - watch.total());
  return options;
}

/// Parses what does not need a mesh first, so that a typing error does not cost a long read.
Question parse_question(const Arguments& arguments, std::optional<Length>& error_bound,
                        std::optional<Length>& tolerance) {
  Question question;
  question.one_sided = arguments.one_sided;
  question.error_bound_was_given = !arguments.error_bound.empty();
  if (!arguments.error_bound.empty()) error_bound = parse_length("--error-bound", arguments.error_bound);
  if (!arguments.tolerance.empty()) tolerance = parse_length("--tolerance", arguments.tolerance);
  if (arguments.certificate.empty()) return question;
  if (arguments.tolerance.empty() || arguments.one_sided || !arguments.transform_b.empty())
    throw InvalidInput("--certificate needs --tolerance, both directions and the meshes as they are in the files");
  return question;
}

/// The proof of a tolerance that was found to hold. False when there was no time for it.
bool write_certificate(PendingFile& file, const Arguments& arguments, const TriangleMesh& a, const TriangleMesh& b,
                       double tolerance, const Stopwatch& watch) {
  ProgressBar bar("proving", arguments.common.quiet);
  CertificateOptions options;
  options.threads = arguments.common.threads;
  options.cancel = &watch_interrupts();
  options.progress = [&bar](double fraction) { bar.show(fraction); };
  if (arguments.common.has_time_limit) options.seconds = std::max(0.0, arguments.common.time_limit - watch.total());
  const auto certificate = build_certificate(a, b, tolerance, options);
  if (!certificate) return false;
  file.write(certificate->bytes);
  file.publish();
  return true;
}

/// What was proven until then may have taken an hour, so it is said.
[[noreturn]] void throw_interrupted(const Bounds& bounds) {
  char proven[80];
  std::snprintf(proven, sizeof proven, "%.17g <= distance <= %.17g", bounds.lower, bounds.upper);
  throw Error(std::string("interrupted; proven until then: ") + proven);
}

int run(const Arguments& arguments) {
  Stopwatch watch;
  const std::atomic<bool>& interrupted = watch_interrupts();
  std::optional<Length> error_bound;
  std::optional<Length> tolerance;
  Question question = parse_question(arguments, error_bound, tolerance);
  std::optional<PendingFile> certificate;
  if (!arguments.certificate.empty()) certificate.emplace(arguments.certificate);
  if (certificate && (certificate->is_at(arguments.a) || certificate->is_at(arguments.b)))
    throw InvalidInput("--certificate: " + arguments.certificate + " is one of the meshes");
  std::optional<Eigen::Affine3d> map;
  if (!arguments.transform_b.empty()) map = parse_affine("--transform-b", arguments.transform_b);

  DistanceReport report;
  TriangleMesh a, b;
  run_both(
      arguments.common.threads, [&] { load(arguments.a, std::nullopt, a, report.a); },
      [&] { question.displacement = load(arguments.b, map, b, report.b); });
  if (map) report.transform_displacement = question.displacement;
  const double diagonal = report.a.summary.bbox_diagonal;
  if (tolerance) question.tolerance = tolerance->in_model_units(diagonal);
  if (error_bound) question.error_bound = error_bound->in_model_units(diagonal);
  if (!tolerance && !error_bound) question.error_bound = default_error_bound(a, b, diagonal);
  report.seconds.read = watch.lap();

  std::optional<Answer> found = answer_without_trees(question, a, b, arguments.method);
  if (!found) {
    const auto [tree_a, tree_b] = build_trees(a, b, {arguments.common.threads});
    report.seconds.build = watch.lap();
    ProgressBar bar("measuring", arguments.common.quiet);
    found = answer_by_trees(question, tree_a, tree_b, engine_options(arguments, question, watch, bar));
  }
  Answer& answer = *found;
  conclude(answer, question);
  if (interrupted && answer.exit_code == ExitUndecided) throw_interrupted(answer.bounds);
  report.seconds.query = watch.lap();
  if (certificate && answer.exit_code == ExitDone &&
      !write_certificate(*certificate, arguments, a, b, *question.tolerance, watch)) {
    if (interrupted) throw Error("interrupted before the certificate was complete; it was not written");
    std::fprintf(stderr, "hausdorff_distance: no time was left for the certificate; it was not written\n");
    answer.exit_code = ExitUndecided;
  }
  report.verdict = answer.verdict;
  report.error_bound = question.error_bound;
  report.tolerance = question.tolerance;
  report.bounds = answer.bounds;
  report.a_to_b = answer.a_to_b;
  report.b_to_a = answer.b_to_a;
  report.threads = arguments.common.threads > 0 ? arguments.common.threads : omp_get_max_threads();
  report.seconds.total = watch.total();

  if (!arguments.common.json.empty()) write_text(arguments.common.json, to_json(report));
  if (arguments.common.json != "-" && !arguments.common.quiet) {
    print_report(report);
    if (arguments.profile) print_profile("profile A to B", report.a_to_b);
    if (arguments.profile && report.b_to_a) print_profile("profile B to A", *report.b_to_a);
  }
  return answer.exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Hausdorff distance between two triangle meshes as a proven interval [lower, upper] with witnesses, "
      "rounding included.\nExit: 0 done or within, 1 exceeds, 2 bad usage or input, 3 undecided.",
      "hausdorff_distance");
  Arguments arguments;
  add_arguments(app, arguments);
  return tool_main(app, argc, argv, [&arguments] { return run(arguments); });
}
