// SPDX-License-Identifier: MIT
#include "meshbound/report.h"
#include "report/json_parts.h"

namespace meshbound {
std::string to_json(const SimplifyReport& from) {
  using namespace report;
  Json json = {{"schema", "meshbound/simplify/1"}, {"verdict", to_string(from.verdict)}};
  if (from.provenance) json["provenance"] = provenance(*from.provenance);
  json["tolerance"] = length(from.tolerance, from.original.summary.bbox_diagonal);
  json["original"] = mesh(from.original);
  json["simplified"] = mesh(from.simplified);
  json["distance"] = symmetric(from.distance);
  if (from.lines) json["lines"] = lines(*from.lines, from.original.summary.bbox_diagonal);
  if (from.texture)
    json["texture"] =
        texture(*from.texture, from.original.summary.bbox_diagonal, "original_to_simplified", "simplified_to_original");
  if (from.deviation)
    json["deviation"] = deviation(*from.deviation, "original_to_simplified", "simplified_to_original");
  if (from.normals) json["normals"] = normals(*from.normals);
  json["decided_by"] = to_string(from.decided_by);
  const HausdorffDistance& distance = from.distance;
  if (const auto spot = worst_spot(distance.bounds, distance.a_to_b, &distance.b_to_a))
    json["worst"] = worst(*spot, "original_to_simplified", "simplified_to_original");
  json["stopped_by"] = from.stopped_by;
  json["effort"] = from.effort;
  json["driver"] = from.driver;
  json["pruned"] = {{"components", from.pruned.components}, {"faces", from.pruned.faces}};
  json["locked_vertices"] = from.locked_vertices;
  json["turned_faces"] = from.turned_faces;
  json["input"] = {{"split", from.input.split},
                   {"dropped_triangles", from.input.dropped_triangles},
                   {"kept_triangles", from.input.kept_triangles}};
  if (from.resumed_tiles) json["resumed_tiles"] = *from.resumed_tiles;
  if (from.memory)
    json["memory"] = {{"peak_bytes", from.memory->peak_bytes}, {"limit_bytes", from.memory->limit_bytes}};
  json["levels"] = Json::array();
  for (const LevelReport& level : from.levels) {
    Json& entry = json["levels"].emplace_back();
    entry["tolerance"] = number(level.tolerance);
    entry["path"] = level.path;
    if (!level.sha256.empty()) entry["sha256"] = level.sha256;
    entry["faces"] = level.faces;
    entry["turned_faces"] = level.turned_faces;
    entry["decided_by"] = to_string(level.decided_by);
    entry["distance"] = symmetric(level.distance);
    add_appearance(level, from.original.summary.bbox_diagonal, entry);
  }
  if (!from.certificates.empty()) {
    json["certificates"] = Json::array();
    for (const CertificateReport& certificate : from.certificates)
      json["certificates"].push_back({{"path", certificate.path}, {"bytes", certificate.bytes}});
  }
  json["collapses"] = {{"performed", from.collapses.performed},       {"refused", from.collapses.refused},
                       {"estimated", from.collapses.proven_together}, {"restarts", 0},
                       {"taken_back", from.collapses.taken_back},     {"proven_alone", from.collapses.proven_alone}};
  json["stats"] = stats({&from.distance.a_to_b, &from.distance.b_to_a});
  json["seconds"] = seconds(from.seconds);
  if (!from.certificates.empty()) json["seconds"]["certificate"] = number(from.seconds.certificate);
  json["threads"] = from.threads;
  if (from.communication) json["communication"] = communication(*from.communication);
  return text(json);
}

}  // namespace meshbound
