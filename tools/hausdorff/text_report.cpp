// SPDX-License-Identifier: MIT
#include "hausdorff/text_report.h"

#include <cmath>
#include <cstdio>

#include "common/distance_text.h"
#include "common/length.h"
#include "common/texture_text.h"
#include "deviation/deviation_outputs.h"

namespace meshbound::tools {
namespace {

/// The mesh is named where it is B: a reader of a log expects A, the original.
std::string spot(const WorstSpot& worst) {
  return short_point(worst.point.position) + ", triangle " + std::to_string(worst.point.triangle) +
         (worst.on_a ? "" : " of B");
}

unsigned long long count(std::uint64_t n) { return n; }  // printf has no portable letter for it

void print_profile(const char* label, const OneSidedDistance& distance) {
  const DistanceStats& s = distance.stats;
  std::printf("%s\n", label);
  const auto indent = [] { std::printf("%12s", ""); };
  indent();
  std::printf("%.3f%% culled on A, %.5f%% culled on B\n", s.culled_on_a_percent, s.culled_on_b_percent);
  indent();
  std::printf("%llu triangles: %llu identical, %llu culled by node, %llu by their corners, %llu subdivided\n",
              count(s.triangles), count(s.matched), count(s.culled_by_node), count(s.culled_by_vertices),
              count(s.walked));
  indent();
  std::printf("%llu queries, %llu nodes, %llu triangles tested\n", count(s.closest_point_queries),
              count(s.nodes_visited), count(s.triangles_tested));
  indent();
  std::printf("%llu subdivisions into %llu pieces, %u deep; %llu resolved, %llu enclosed, %llu given up\n",
              count(s.subdivisions), count(s.pieces), s.deepest_subdivision, count(s.resolved), count(s.enclosed),
              count(s.given_up));
  indent();
  std::printf("matching %.4f s, culling on A %.4f s, on B %.4f s, subdivision %.4f s\n", s.phases.matching,
              s.phases.culling_on_a, s.phases.culling_on_b, s.phases.subdivision);
}

std::string failure(const DistanceReport& report) {
  const auto [distance, tolerance] = told_apart(report.bounds.lower, *report.tolerance);
  const std::string line = "FAIL " + distance + " > " + tolerance;
  return report.worst ? line + " at " + spot(*report.worst) : line;
}

std::string undecided(const DistanceReport& report) {
  const Bounds& bounds = report.bounds;
  std::string line = "UNDECIDED";
  if (!std::isfinite(bounds.upper)) {
    line += " no upper bound yet";
  } else if (report.tolerance) {
    line += " tolerance " + exact_number(*report.tolerance) + " in [" + exact_number(bounds.lower) + ", " +
            exact_number(bounds.upper) + "]";
  } else {
    const auto [width, wanted] = told_apart(bounds.upper - bounds.lower, *report.error_bound);
    line += " width " + width + " > " + wanted;
  }
  return line + ": " + report.reason;
}

/// What is left to say once the distance itself is no reason: of the texture. Empty where there is nothing to say.
std::string texture_line(const DistanceReport& report) {
  if (!report.texture) return report.texture_was_wanted ? "UNDECIDED texture deviation: " + report.reason : "";
  const TextureReport& texture = *report.texture;
  if (!texture.tolerance) return "";
  const TextureDeviation& deviation = texture.deviation;
  const Verdict verdict = verdict_of(deviation.bounds, *texture.tolerance);
  if (verdict == Verdict::Within) return "";
  if (verdict == Verdict::Undecided)
    return "UNDECIDED texture tolerance " + exact_number(*texture.tolerance) + " in " + interval(deviation.bounds);
  const auto [distance, tolerance] = told_apart(deviation.bounds.lower, *texture.tolerance);
  const bool is_on_a = deviation.a_to_b.bounds.lower >= deviation.b_to_a.bounds.lower;
  const auto& witness = is_on_a ? deviation.a_to_b.witness : deviation.b_to_a.witness;
  return "FAIL texture " + distance + " > " + tolerance + " at " + short_point(witness->from.position) + ", triangle " +
         std::to_string(witness->from.triangle) + (is_on_a ? "" : " of B");
}

/// Whether the distance between the surfaces alone is within the tolerance, or as narrow as wanted.
bool surface_distance_holds(const DistanceReport& report) {
  if (report.tolerance && verdict_of(report.bounds, *report.tolerance) != Verdict::Within) return false;
  return !report.error_bound || report.bounds.upper - report.bounds.lower <= *report.error_bound;
}

}  // namespace

void print_report(const DistanceReport& report, bool profile) {
  const double diagonal = report.a.summary.bbox_diagonal;
  print_question(report.a, report.b, report.tolerance, report.error_bound, report.reason);
  print_distance(report.bounds, report.a_to_b, report.b_to_a ? &*report.b_to_a : nullptr, {"A to B", "B to A"},
                 diagonal);
  if (report.worst_was_wanted && report.worst)
    print_line("worst spot", spot(*report.worst) + (report.worst->on_a ? " of A" : ""));
  if (report.texture) print_texture(*report.texture, {"A to B", "B to A"}, diagonal);
  if (report.deviation) print_deviation(*report.deviation, "A to B", "B to A");
  if (report.transform_displacement)
    print_line("transform", "coordinates of B rounded by at most " + exact_number(*report.transform_displacement) +
                                ", which the bounds include");
  print_line("verdict", report.verdict);
  print_line("seconds", "read " + rounded_seconds(report.seconds.read) + ", build " +
                            rounded_seconds(report.seconds.build) + ", query " + rounded_seconds(report.seconds.query) +
                            ", total " + rounded_seconds(report.seconds.total) + thread_count(report.threads));
  if (profile) print_profile("profile A to B", report.a_to_b);
  if (profile && report.b_to_a) print_profile("profile B to A", *report.b_to_a);
  if (const std::string line = closing_line(report); !line.empty()) std::printf("%s\n", line.c_str());
}

std::string closing_line(const DistanceReport& report) {
  if (surface_distance_holds(report)) return texture_line(report);
  if (report.tolerance && report.bounds.lower > *report.tolerance) return failure(report);
  if (report.verdict == "exceeds") return texture_line(report);
  return report.verdict == "undecided" ? undecided(report) : "";
}

}  // namespace meshbound::tools
