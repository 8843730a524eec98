// SPDX-License-Identifier: MIT
#include "penetration/report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "common/distance_text.h"
#include "common/length.h"
#include "report/json_parts.h"

namespace meshbound::tools {
namespace {

using report::Json;

const char* name_of(Overlap overlap) {
  switch (overlap) {
    case Overlap::AInsideB:
      return "a_inside_b";
    case Overlap::BInsideA:
      return "b_inside_a";
    case Overlap::Crossing:
      break;
  }
  return "crossing";
}

Json point(const Eigen::Vector3d& p) {
  return Json::array({report::number(p.x()), report::number(p.y()), report::number(p.z())});
}

Json volume_json(const PenetrationVolume& volume) {
  return {{"depth", report::bounds(volume.depth)},
          {"outcome", to_string(volume.outcome)},
          {"witness",
           {{"on_a", point(volume.on_a.position)},
            {"on_b", point(volume.on_b.position)},
            {"triangle_of_a", volume.on_a.triangle},
            {"triangle_of_b", volume.on_b.triangle}}},
          {"overlap", name_of(volume.overlap)},
          {"faces_on_a", volume.faces_on_a},
          {"faces_on_b", volume.faces_on_b},
          {"volume", report::bounds(volume.volume)}};
}

Json stats_json(const PenetrationStats& stats) {
  return {{"node_pairs", stats.node_pairs},
          {"triangle_pairs", stats.triangle_pairs},
          {"crossings", stats.crossings},
          {"clipped", stats.clipped},
          {"exact_decisions", stats.exact_decisions}};
}

void print_volume(std::size_t index, const PenetrationVolume& volume, double diagonal) {
  print_line("volume " + std::to_string(index), "depth " + interval(volume.depth));
  print_line("", share_of_diagonal(volume.depth, diagonal));
  const auto spot = [](const SurfacePoint& p) {
    return exact_point(p.position) + ", triangle " + std::to_string(p.triangle);
  };
  print_line("", "deepest on A " + spot(volume.on_a));
  print_line("", "        on B " + spot(volume.on_b));
  const std::string faces =
      std::to_string(volume.faces_on_a) + " faces on A, " + std::to_string(volume.faces_on_b) + " on B";
  const char* const how = volume.overlap == Overlap::Crossing
                              ? ""
                              : (volume.overlap == Overlap::AInsideB ? "; A inside B" : "; B inside A");
  print_line("", "content " + interval(volume.volume) + "; " + faces + how);
}

const char* unreached_reason(const PenetrationDepth& result) {
  if (!result.volumes_known) return "the time limit came before the volumes were known";
  for (const PenetrationVolume& volume : result.volumes)
    if (volume.outcome == Outcome::BudgetExhausted) return "the time limit came";
  return "doubles cannot narrow the interval further";
}

}  // namespace

ExitCode conclude(PenetrationReport& report) {
  const PenetrationDepth& result = report.result;
  const auto is_open = [](const PenetrationVolume& volume) {
    return volume.outcome == Outcome::BudgetExhausted || volume.outcome == Outcome::PrecisionReached;
  };
  if (!result.volumes_known ||
      (report.error_bound && std::any_of(result.volumes.begin(), result.volumes.end(), is_open)))
    report.reason = unreached_reason(result);
  if (!report.tolerance) {
    report.verdict = report.reason.empty() ? "done" : "undecided";
    return report.reason.empty() ? ExitDone : ExitUndecided;
  }
  switch (verdict_of(result.depth, *report.tolerance)) {
    case Verdict::Within:
      report.verdict = "within";
      return ExitDone;
    case Verdict::Exceeds:
      report.verdict = "exceeds";
      return ExitExceeds;
    case Verdict::Undecided:
      break;
  }
  report.verdict = "undecided";
  if (report.reason.empty()) report.reason = unreached_reason(result);
  return ExitUndecided;
}

std::string to_json(const PenetrationReport& from) {
  const double diagonal = from.a.summary.bbox_diagonal;
  Json json = {{"schema", "meshbound/penetration/1"}, {"verdict", from.verdict}};
  json["provenance"] = report::provenance(from.provenance);
  if (!from.reason.empty()) json["reason"] = from.reason;
  json["error_bound"] = from.error_bound ? report::number(*from.error_bound) : Json(nullptr);
  if (from.tolerance) json["tolerance"] = report::length(*from.tolerance, diagonal);
  json["a"] = report::mesh(from.a);
  json["b"] = report::mesh(from.b);
  if (from.displacement_a) json["a"]["transform_displacement"] = report::number(*from.displacement_a);
  if (from.displacement_b) json["b"]["transform_displacement"] = report::number(*from.displacement_b);
  json["contact"] = from.contact;
  json["depth"] = report::bounds(from.result.depth);
  json["volumes"] = Json::array();
  for (const PenetrationVolume& volume : from.result.volumes) json["volumes"].push_back(volume_json(volume));
  json["stats"] = stats_json(from.result.stats);
  json["seconds"] = {{"read", report::number(from.seconds.read)},
                     {"check", report::number(from.seconds.check)},
                     {"query", report::number(from.seconds.query)},
                     {"write", report::number(from.seconds.write)},
                     {"total", report::number(from.seconds.total)}};
  json["threads"] = from.threads;
  return report::text(json);
}

void print_report(const PenetrationReport& report) {
  const double diagonal = report.a.summary.bbox_diagonal;
  print_question(report.a, report.b, report.tolerance, report.error_bound, report.reason);
  for (std::size_t i = 0; i < report.result.volumes.size(); ++i) print_volume(i, report.result.volumes[i], diagonal);
  print_line("depth", interval(report.result.depth));
  print_line("contact", report.contact);
  print_line("verdict", report.verdict);
  print_line("seconds", "read " + rounded_seconds(report.seconds.read) + ", check " +
                            rounded_seconds(report.seconds.check) + ", query " + rounded_seconds(report.seconds.query) +
                            ", total " + rounded_seconds(report.seconds.total) + thread_count(report.threads));
  if (const std::string line = closing_line(report); !line.empty()) std::printf("%s\n", line.c_str());
}

std::string closing_line(const PenetrationReport& report) {
  const Bounds& depth = report.result.depth;
  if (report.verdict == "exceeds") {
    const auto [deep, tolerance] = told_apart(depth.lower, *report.tolerance);
    const SurfacePoint& deepest = report.result.volumes[0].on_a;
    return "FAIL " + deep + " > " + tolerance + " at " + short_point(deepest.position) + ", triangle " +
           std::to_string(deepest.triangle);
  }
  return report.verdict == "undecided" ? "UNDECIDED depth in " + interval(depth) + ": " + report.reason : "";
}

}  // namespace meshbound::tools
