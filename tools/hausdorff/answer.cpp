// SPDX-License-Identifier: MIT
#include "hausdorff/answer.h"

#include <algorithm>
#include <array>
#include <limits>

#include "mesh/stored_mesh.h"
#include "meshbound/report.h"
#include "meshbound/stop_token.h"
#include "meshbound/transform.h"

namespace meshbound::tools {
namespace {

using Clock = StopToken::Clock;

Answer answer_of(const Bounds& bounds, const OneSidedDistance& a_to_b, const OneSidedDistance& b_to_a,
                 const Question& question) {
  Answer answer;
  answer.bounds = question.one_sided ? a_to_b.bounds : bounds;
  answer.a_to_b = a_to_b;
  if (!question.one_sided) answer.b_to_a = b_to_a;
  return answer;
}

ToleranceCheck check(const Bvh& a, const Bvh& b, double tolerance, const Question& question,
                     const DistanceOptions& options) {
  return question.one_sided ? check_one_sided_tolerance(a, b, tolerance, options)
                            : check_tolerance(a, b, tolerance, options);
}

/// The distance 0 of a mesh from a copy of it.
OneSidedDistance distance_to_itself(const StoredMesh& mesh) {
  std::array<Triangle, 1> triangle;
  mesh.read_triangles(0, triangle);
  std::array<Vec3, 1> corner;
  mesh.read_vertices(triangle[0][0], corner);
  const SurfacePoint point{to_eigen(corner[0]), 0};
  OneSidedDistance result;
  result.bounds = {0, 0};
  result.witness = {point, point, 0};
  result.stats.triangles = result.stats.matched = mesh.triangle_count();
  result.stats.culled_on_a_percent = result.stats.culled_on_b_percent = 100;
  return result;
}

/// The options with what is left of their time at `now` when they were valid at `start`.
DistanceOptions continued(DistanceOptions options, Clock::time_point start) {
  options.budget.seconds = std::max(0.0, options.budget.seconds - seconds_since(start));
  return options;
}

/// Decides for the exact image of B from its rounded one, which is at most `displacement` away.
Answer decide(const Bvh& a, const Bvh& b, const Question& question, const DistanceOptions& options) {
  const Clock::time_point start = Clock::now();
  const double tolerance = *question.tolerance;
  ToleranceCheck result = check(a, b, question.tolerance_of_image(), question, options);
  if (question.displacement > 0 && result.verdict == Verdict::Exceeds &&
      !(widened(result.bounds, question.displacement).lower > tolerance))
    result =
        check(a, b, widened({tolerance, tolerance}, question.displacement).upper, question, continued(options, start));
  return answer_of(result.bounds, result.a_to_b, result.b_to_a, question);
}

Answer measure(const Bvh& a, const Bvh& b, const Question& question, DistanceOptions options) {
  options.error_bound = question.error_bound_of_image();
  if (question.tolerance) options.tolerance = question.tolerance_of_image();
  if (question.one_sided) {
    const OneSidedDistance result = one_sided_hausdorff_distance(a, b, options);
    return answer_of(result.bounds, result, {}, question);
  }
  const HausdorffDistance result = hausdorff_distance(a, b, options);
  return answer_of(result.bounds, result.a_to_b, result.b_to_a, question);
}

/// Both proven: the higher lower bound with its witness, the lower upper bound.
void narrow_by(OneSidedDistance& measured, const OneSidedDistance& decided) {
  if (!was_searched(decided)) return;
  if (decided.bounds.lower > measured.bounds.lower) {
    measured.bounds.lower = decided.bounds.lower;
    measured.witness = decided.witness;
  }
  measured.bounds.upper = std::min(measured.bounds.upper, decided.bounds.upper);
}

Answer decide_then_measure(const Bvh& a, const Bvh& b, const Question& question, const DistanceOptions& options) {
  const Clock::time_point start = Clock::now();
  const Answer decision = decide(a, b, question, options);
  Answer answer = measure(a, b, question, continued(options, start));
  narrow_by(answer.a_to_b, decision.a_to_b);
  if (answer.b_to_a) narrow_by(*answer.b_to_a, *decision.b_to_a);
  answer.bounds.lower = std::max(answer.bounds.lower, decision.bounds.lower);
  answer.bounds.upper = std::min(answer.bounds.upper, decision.bounds.upper);
  return answer;
}

void widen(Answer& answer, double displacement) {
  answer.bounds = widened(answer.bounds, displacement);
  answer.a_to_b.bounds = widened(answer.a_to_b.bounds, displacement);
  if (answer.b_to_a) answer.b_to_a->bounds = widened(answer.b_to_a->bounds, displacement);
}

bool out_of_budget(const Answer& answer) {
  return answer.a_to_b.outcome == Outcome::BudgetExhausted ||
         (answer.b_to_a && answer.b_to_a->outcome == Outcome::BudgetExhausted);
}

/// How the whole question ended, whatever ended the search of one direction.
Outcome outcome_of(const Answer& answer, const Question& question, Verdict verdict) {
  if (question.error_bound) {
    const bool narrow = answer.bounds.upper - answer.bounds.lower <= *question.error_bound;
    if (narrow && (!question.tolerance || verdict != Verdict::Undecided)) return Outcome::Converged;
  } else if (verdict != Verdict::Undecided) {
    return verdict == Verdict::Exceeds ? Outcome::ExceedsTolerance : Outcome::Converged;
  }
  return out_of_budget(answer) ? Outcome::BudgetExhausted : Outcome::PrecisionReached;
}

std::string reason_of(const Answer& answer) {
  if (answer.outcome == Outcome::BudgetExhausted) return "the time limit came first";
  const std::uint64_t given_up = answer.a_to_b.stats.given_up + (answer.b_to_a ? answer.b_to_a->stats.given_up : 0);
  if (given_up > 0)
    return "the search gave up " + std::to_string(given_up) + " piece" + (given_up == 1 ? "" : "s") +
           "; try the other --method";
  return "rounding errors of doubles of this magnitude are larger than what is left of the interval";
}

}  // namespace

std::optional<Answer> answer_without_trees(const Question& question, const TriangleMesh& a, const TriangleMesh& b,
                                           Method method) {
  if (method != Method::CellWalking) return std::nullopt;
  double limit = std::numeric_limits<double>::infinity();
  if (question.error_bound) limit = question.error_bound_of_image();
  if (question.tolerance) limit = std::min(limit, question.tolerance_of_image());
  const std::optional<HausdorffDistance> distance = distance_without_trees(a, b, limit);
  if (!distance) return std::nullopt;
  return answer_of(distance->bounds, distance->a_to_b, distance->b_to_a, question);
}

std::optional<Answer> answer_without_trees(const Question& question, const StoredMesh& a, const StoredMesh& b,
                                           Method method) {
  if (method != Method::CellWalking || !same_arrays(a, b)) return std::nullopt;
  const OneSidedDistance nothing = distance_to_itself(a);
  return answer_of({0, 0}, nothing, nothing, question);
}

Answer unsearched_answer(const Question& question) {
  OneSidedDistance nothing;
  nothing.outcome = Outcome::BudgetExhausted;
  return answer_of(nothing.bounds, nothing, nothing, question);
}

Answer answer_by_trees(const Question& question, const Bvh& a, const Bvh& b, const DistanceOptions& options) {
  if (question.decide_first) return decide_then_measure(a, b, question, options);
  return question.error_bound ? measure(a, b, question, options) : decide(a, b, question, options);
}

Answer answer_in_tiles(const Question& question, const StoredMesh& a, const StoredMesh& b, const DistanceOptions& from,
                       TileWorkers& workers) {
  DistanceOptions options = from;
  if (question.error_bound) options.error_bound = question.error_bound_of_image();
  if (question.tolerance) options.tolerance = question.tolerance_of_image();
  if (question.one_sided) {
    const OneSidedDistance result = workers.measure_one_side(a, b, options);
    return answer_of(result.bounds, result, {}, question);
  }
  const HausdorffDistance result = workers.measure(a, b, options);
  return answer_of(result.bounds, result.a_to_b, result.b_to_a, question);
}

void conclude(Answer& answer, const Question& question) {
  widen(answer, question.displacement);
  const Verdict verdict = question.tolerance ? verdict_of(answer.bounds, *question.tolerance) : Verdict::Undecided;
  answer.outcome = outcome_of(answer, question, verdict);
  answer.exit_code = exit_code(verdict);
  answer.verdict = to_string(verdict);
  if (!question.tolerance && answer.outcome == Outcome::Converged) {
    answer.exit_code = ExitDone;
    answer.verdict = "done";
  }
  if (answer.outcome == Outcome::BudgetExhausted || answer.outcome == Outcome::PrecisionReached)
    answer.reason = reason_of(answer);
}

}  // namespace meshbound::tools
