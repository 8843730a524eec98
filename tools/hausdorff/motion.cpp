// SPDX-License-Identifier: MIT
#include "hausdorff/motion.h"

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "common/distance_text.h"
#include "common/distinct_files.h"
#include "common/mesh_input.h"
#include "common/output.h"
#include "common/progress.h"
#include "common/provenance.h"
#include "common/run_clock.h"
#include "common/signals.h"
#include "hausdorff/answer.h"
#include "hausdorff/pose_file.h"
#include "meshbound/error.h"
#include "meshbound/motion.h"
#include "meshbound/pose.h"
#include "report/json_parts.h"

namespace meshbound::tools {
namespace {

/// What the report of a motion says.
struct Motion {
  MeshReport a, b;
  Question question;
  std::size_t poses = 0;
  std::vector<Answer> steps;  ///< of the poses that were reached in time
  std::uint64_t queries = 0;
  double seconds_of_steps = 0;
  double seconds = 0;
  ExitCode exit_code = ExitDone;
};

void check_motion_paths(const Arguments& arguments) {
  require_distinct_files({{"A", arguments.a}, {"B", arguments.b}, {"--poses", arguments.poses}},
                         {{"--json", arguments.common.json}});
  check_writable(arguments.common.json);
}

Answer answer_at(MovingPair& pair, const Pose& pose, const Question& question, DistanceOptions options) {
  const Pose identity = Pose::Identity();
  Answer answer;
  const auto take = [&answer](const auto& result) {
    answer.bounds = result.bounds;
    answer.a_to_b = result.a_to_b;
    answer.b_to_a = result.b_to_a;
  };
  if (question.error_bound) {
    options.error_bound = question.error_bound;
    options.tolerance = question.tolerance;
    take(pair.hausdorff_distance(identity, pose, options));
  } else {
    take(pair.check_tolerance(identity, pose, *question.tolerance, options));
  }
  conclude(answer, question);
  return answer;
}

/// Exceeding one step is exceeding; what was not reached is undecided.
ExitCode worse(ExitCode x, ExitCode y) {
  if (x == ExitExceeds || y == ExitExceeds) return ExitExceeds;
  return x == ExitDone ? y : x;
}

void follow(Motion& motion, const Bvh& a, const Bvh& b, const std::vector<Pose>& poses, const Arguments& arguments,
            const RunClock& clock) {
  ProgressBar bar("measuring", arguments.common.quiet);
  MovingPair pair(a, b);
  DistanceOptions options;
  options.method = arguments.method;
  options.threads = arguments.common.threads;
  options.cancel = &interrupted();
  for (const Pose& pose : poses) {
    options.budget.seconds = clock.seconds_left();
    if (interrupted() || options.budget.seconds == 0) break;
    motion.steps.push_back(answer_at(pair, pose, motion.question, options));
    const Answer& step = motion.steps.back();
    motion.exit_code = worse(motion.exit_code, step.exit_code);
    motion.queries += step.a_to_b.stats.closest_point_queries + step.b_to_a->stats.closest_point_queries;
    bar.show(static_cast<double>(motion.steps.size()) / static_cast<double>(poses.size()));
  }
  if (interrupted()) throw Error("interrupted after " + std::to_string(motion.steps.size()) + " poses");
  if (motion.steps.size() < poses.size()) motion.exit_code = worse(motion.exit_code, ExitUndecided);
}

std::string verdict_of(const Motion& motion) {
  if (motion.exit_code == ExitExceeds) return "exceeds";
  if (motion.exit_code == ExitUndecided) return "undecided";
  return motion.question.tolerance ? "within" : "done";
}

std::string to_json(const Motion& motion) {
  using namespace report;
  const double diagonal = motion.a.summary.bbox_diagonal;
  Json json = {{"schema", "meshbound/motion/1"}, {"verdict", verdict_of(motion)}};
  json["provenance"] = report::provenance(tools::provenance());
  json["error_bound"] = motion.question.error_bound ? number(*motion.question.error_bound) : Json(nullptr);
  if (motion.question.tolerance) json["tolerance"] = length(*motion.question.tolerance, diagonal);
  json["a"] = mesh(motion.a);
  json["b"] = mesh(motion.b);
  json["poses"] = motion.poses;
  json["steps"] = Json::array();
  for (const Answer& step : motion.steps) {
    Json entry = {{"verdict", step.verdict}, {"outcome", to_string(step.outcome)}, {"distance", bounds(step.bounds)}};
    entry["distance"]["a_to_b"] = one_sided(step.a_to_b);
    entry["distance"]["b_to_a"] = one_sided(*step.b_to_a);
    json["steps"].push_back(std::move(entry));
  }
  json["closest_point_queries"] = motion.queries;
  json["seconds"] = {{"steps", number(motion.seconds_of_steps)}, {"total", number(motion.seconds)}};
  return text(json);
}

/// "FAIL step 7: 0.71 > 0.7", of the first step that exceeds the tolerance, or "UNDECIDED ..."; empty for a success.
std::string closing_line(const Motion& motion) {
  if (motion.exit_code == ExitDone) return "";
  const auto step = std::find_if(motion.steps.begin(), motion.steps.end(),
                                 [&](const Answer& answer) { return answer.exit_code == motion.exit_code; });
  if (step == motion.steps.end())
    return "UNDECIDED the time limit came after " + std::to_string(motion.steps.size()) + " of " +
           std::to_string(motion.poses) + " poses";
  const std::string name = "step " + std::to_string(step - motion.steps.begin()) + ": ";
  if (motion.exit_code == ExitUndecided)
    return "UNDECIDED " + name + interval(step->bounds) + (step->reason.empty() ? "" : ": " + step->reason);
  const auto [distance, tolerance] = told_apart(step->bounds.lower, *motion.question.tolerance);
  return "FAIL " + name + distance + " > " + tolerance;
}

void print(const Motion& motion) {
  print_line("step", "distance, verdict");
  for (std::size_t i = 0; i < motion.steps.size(); ++i)
    print_line(std::to_string(i), interval(motion.steps[i].bounds) + " " + motion.steps[i].verdict);
  if (motion.steps.size() < motion.poses)
    print_line("stopped", "the time limit came after " + std::to_string(motion.steps.size()) + " of " +
                              std::to_string(motion.poses) + " poses");
  print_line("verdict", verdict_of(motion));
  print_line("queries", std::to_string(motion.queries));
  print_line("seconds",
             "steps " + rounded_seconds(motion.seconds_of_steps) + ", total " + rounded_seconds(motion.seconds));
  if (const std::string line = closing_line(motion); !line.empty()) std::printf("%s\n", line.c_str());
}

}  // namespace

ExitCode run_motion(const Arguments& arguments) {
  RunClock clock(arguments.common);
  const TypedLengths lengths = parse_lengths(arguments);
  check_motion_paths(arguments);
  const std::vector<Pose> poses = read_poses(arguments.poses);
  const bool with_checksums = !arguments.common.json.empty();
  Motion motion;
  const StopToken stop = clock.stop_of_reading();
  const TriangleMesh a = read_input(arguments.a, with_checksums, motion.a, stop);
  const TriangleMesh b = read_input(arguments.b, with_checksums, motion.b, stop);
  motion.a.dropped.reset();  // nothing is written again
  motion.b.dropped.reset();
  const double diagonal = motion.a.summary.bbox_diagonal;
  motion.question = question_about(default_error_bound(a, b, diagonal), arguments, lengths, diagonal, 0);
  motion.poses = poses.size();
  const auto [tree_a, tree_b] = build_trees(a, b, {arguments.common.threads, clock.stop(patience)});
  clock.lap();
  follow(motion, tree_a, tree_b, poses, arguments, clock);
  motion.seconds_of_steps = clock.lap();
  motion.seconds = clock.seconds();
  if (!arguments.common.json.empty()) write_text(arguments.common.json, to_json(motion));
  tell(arguments.common, closing_line(motion), [&] { print(motion); });
  return motion.exit_code;
}

}  // namespace meshbound::tools
