// SPDX-License-Identifier: MIT
#include "report/json_parts.h"

#include <cmath>

#include "distance/distance_stats.h"

namespace meshbound::report {
namespace {

Json point(const Eigen::Vector3d& p) { return Json::array({number(p.x()), number(p.y()), number(p.z())}); }

Json dropped(const DroppedAttributes& dropped) {
  return {{"texture_coordinates", dropped.texture_coordinates},
          {"normals", dropped.normals},
          {"colours", dropped.colours},
          {"materials", dropped.materials},
          {"groups", dropped.groups},
          {"smoothing_groups", dropped.smoothing_groups},
          {"facet_attributes", dropped.facet_attributes},
          {"other_properties", dropped.other_properties},
          {"scene_objects", dropped.scene_objects},
          {"other_elements", dropped.other_elements}};
}

Json texture_one_sided(const OneSidedTextureDeviation& from) {
  Json json = bounds(from.bounds);
  json["outcome"] = to_string(from.outcome);
  json["uncovered"] = bounds(from.uncovered);
  if (!from.witness) return json;
  const TextureWitness& w = *from.witness;
  json["witness"] = witness({w.from, w.nearest, w.distance});
  json["witness"]["coordinate"] = Json::array({number(w.coordinate.x()), number(w.coordinate.y())});
  return json;
}

Json statistics(const DeviationStatistics& from) {
  return {{"samples", from.samples},
          {"mean", number(from.mean)},
          {"root_mean_square", number(from.root_mean_square)},
          {"percentile_95", number(from.percentile_95)},
          {"largest_sample", number(from.largest_sample)},
          {"histogram", from.histogram},
          {"beyond_scale", from.beyond_scale}};
}

}  // namespace

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json length(double absolute, double diagonal) {
  return {{"absolute", number(absolute)}, {"percent_of_diagonal", number(absolute / diagonal * 100)}};
}

Json communication(const CommunicationReport& communication) {
  return {{"ranks", communication.ranks}, {"input_bytes", communication.input_bytes}, {"bytes", communication.bytes}};
}

Json mesh(const MeshReport& mesh) {
  Json json = {{"path", mesh.path},
               {"vertices", mesh.summary.vertices},
               {"faces", mesh.summary.faces},
               {"components", mesh.summary.components},
               {"closed", mesh.summary.closed},
               {"bbox_diagonal", number(mesh.summary.bbox_diagonal)},
               {"triangulated_polygons", mesh.triangulated_polygons},
               {"decoded_strips", mesh.decoded_strips},
               {"ignored_elements", mesh.ignored_elements}};
  if (mesh.dropped) json["dropped"] = dropped(*mesh.dropped);
  if (mesh.rest_pose_parts > 0) json["rest_pose_parts"] = mesh.rest_pose_parts;
  if (!mesh.sha256.empty()) json["sha256"] = mesh.sha256;
  return json;
}

Json provenance(const Provenance& from) {
  return {{"tool", from.tool}, {"version", from.version}, {"date", from.date}, {"command", from.command}};
}

Json bounds(const Bounds& bounds) { return {{"lower", number(bounds.lower)}, {"upper", number(bounds.upper)}}; }

Json witness(const Witness& witness) {
  return {{"from", point(witness.from.position)},
          {"to", point(witness.nearest.position)},
          {"from_triangle", witness.from.triangle},
          {"to_triangle", witness.nearest.triangle},
          {"distance", number(witness.distance)}};
}

Json one_sided(const OneSidedDistance& distance) {
  Json json = bounds(distance.bounds);
  json["searched"] = was_searched(distance);
  if (!was_searched(distance)) return json;
  json["outcome"] = to_string(distance.outcome);
  json["witness"] = witness(distance.witness);
  return json;
}

Json worst(const WorstSpot& spot, const char* from_a, const char* from_b) {
  return {{"direction", spot.on_a ? from_a : from_b},
          {"point", point(spot.point.position)},
          {"triangle", spot.point.triangle},
          {"nearest", point(spot.nearest.position)},
          {"distance", bounds(spot.distance)}};
}

Json symmetric(const HausdorffDistance& distance) {
  Json json = bounds(distance.bounds);
  json["original_to_simplified"] = one_sided(distance.a_to_b);
  json["simplified_to_original"] = one_sided(distance.b_to_a);
  return json;
}

Json deviation(const DeviationReport& report, const char* from_a, const char* from_b) {
  Json json = {{"scale", number(report.scale)}, {"scale_meaning", report.scale_meaning}};
  if (!report.unit.empty()) json["unit"] = report.unit;
  json[from_a] = statistics(report.a_to_b);
  json[from_b] = statistics(report.b_to_a);
  return json;
}

Json lines(const LineReport& lines, double diagonal) {
  return {{"tolerance", length(lines.tolerance, diagonal)},
          {"original_edges", lines.original_edges},
          {"edges", lines.edges},
          {"distance", symmetric(lines.distance)}};
}

Json texture(const TextureReport& from, double diagonal, const char* from_a, const char* from_b) {
  const TextureDeviation& deviation = from.deviation;
  Json json = bounds(deviation.bounds);
  if (from.tolerance) json["tolerance"] = length(*from.tolerance, diagonal);
  json[from_a] = texture_one_sided(deviation.a_to_b);
  json[from_b] = texture_one_sided(deviation.b_to_a);
  if (from.compares_floats) json["compares_floats"] = true;
  if (from.texture_size) {
    json["texture_size"] = number(*from.texture_size);
    json["texel_length"] = number(from.texel_length);
    json["texels"] = bounds({deviation.bounds.lower / from.texel_length, deviation.bounds.upper / from.texel_length});
  }
  return json;
}

Json normals(const NormalReport& from) {
  Json json = {{"tolerance", number(from.tolerance)}, {"max_degrees", number(from.deviation.degrees)}};
  if (!from.deviation.worst) return json;
  const FaceTurn& turn = *from.deviation.worst;
  json["witness"] = {{"from", point(turn.from.position)},
                     {"to", point(turn.nearest.position)},
                     {"from_triangle", turn.from.triangle},
                     {"to_triangle", turn.nearest.triangle}};
  return json;
}

void add_appearance(const LevelReport& level, double diagonal, Json& to) {
  if (level.lines) to["lines"] = lines(*level.lines, diagonal);
  if (level.texture)
    to["texture"] = texture(*level.texture, diagonal, "original_to_simplified", "simplified_to_original");
  if (level.normals) to["normals"] = normals(*level.normals);
}

Json stats(const std::vector<const OneSidedDistance*>& directions) {
  DistanceStats sum;
  double culled_triangles = 0;
  double culled_queries = 0;
  for (const OneSidedDistance* direction : directions) {
    const DistanceStats& one = direction->stats;
    add(sum, one);
    culled_triangles += one.culled_on_a_percent * static_cast<double>(one.triangles);
    culled_queries += one.culled_on_b_percent * static_cast<double>(one.closest_point_queries);
  }
  const auto mean = [](double weighted, std::uint64_t weight) {
    return weight == 0 ? 0.0 : weighted / static_cast<double>(weight);
  };
  return {{"culled_on_a_percent", number(mean(culled_triangles, sum.triangles))},
          {"culled_on_b_percent", number(mean(culled_queries, sum.closest_point_queries))},
          {"closest_point_queries", sum.closest_point_queries},
          {"subdivisions", sum.subdivisions},
          {"triangles", sum.triangles},
          {"matched", sum.matched},
          {"culled_by_node", sum.culled_by_node},
          {"culled_by_vertices", sum.culled_by_vertices},
          {"walked", sum.walked},
          {"nodes_visited", sum.nodes_visited},
          {"triangles_tested", sum.triangles_tested},
          {"deepest_subdivision", sum.deepest_subdivision},
          {"pieces", sum.pieces},
          {"resolved", sum.resolved},
          {"enclosed", sum.enclosed},
          {"given_up", sum.given_up},
          {"phase_seconds",
           {{"matching", number(sum.phases.matching)},
            {"culling_on_a", number(sum.phases.culling_on_a)},
            {"culling_on_b", number(sum.phases.culling_on_b)},
            {"subdivision", number(sum.phases.subdivision)}}}};
}

Json seconds(const SimplifyReport::Seconds& seconds) {
  return {{"read", number(seconds.read)},
          {"simplify", number(seconds.simplify)},
          {"certify", number(seconds.certify)},
          {"write", number(seconds.write)},
          {"total", number(seconds.total)}};
}

std::string text(const Json& document) { return document.dump(2, ' ', false, Json::error_handler_t::replace) + '\n'; }

}  // namespace meshbound::report

namespace meshbound {

std::string to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::Within:
      return "within";
    case Verdict::Exceeds:
      return "exceeds";
    case Verdict::Undecided:
      break;
  }
  return "undecided";
}

std::string to_string(DecidedBy how) {
  switch (how) {
    case DecidedBy::Measurement:
      return "measurement";
    case DecidedBy::SecondMethod:
      return "second_method";
    case DecidedBy::SmallerTolerance:
      return "smaller_tolerance";
    case DecidedBy::SmallerLevel:
      return "smaller_level";
    case DecidedBy::Original:
      break;
  }
  return "original";
}

std::string to_string(Outcome outcome) {
  switch (outcome) {
    case Outcome::Converged:
      return "converged";
    case Outcome::ExceedsTolerance:
      return "exceeds";
    case Outcome::BudgetExhausted:
      return "budget";
    case Outcome::PrecisionReached:
      break;
  }
  return "precision";
}

}  // namespace meshbound
