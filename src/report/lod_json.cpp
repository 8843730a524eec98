// SPDX-License-Identifier: MIT
#include <numbers>

#include "meshbound/report.h"
#include "report/json_parts.h"

namespace meshbound {
namespace {

report::Json level_json(std::size_t index, const LodReport::Level& level, double diagonal) {
  using namespace report;
  Json json = {{"level", index},
               {"tolerance", number(level.tolerance)},
               {"percent_of_diagonal", length(level.tolerance, diagonal)["percent_of_diagonal"]}};
  if (level.pixels) json["pixels"] = number(*level.pixels);
  if (level.view_distance) json["view_distance"] = number(*level.view_distance);
  json["path"] = level.path;
  json["file"] = level.file;
  if (!level.sha256.empty()) json["sha256"] = level.sha256;
  json["vertices"] = level.vertices;
  json["faces"] = level.faces;
  json["turned_faces"] = level.turned_faces;
  json["decided_by"] = to_string(level.decided_by);
  json["stopped_by"] = level.stopped_by;
  json["distance"] = symmetric(level.distance);
  add_appearance(level, diagonal, json);
  return json;
}

}  // namespace

std::string to_json(const LodReport& from) {
  using namespace report;
  Json json = {{"schema", "meshbound/lod/1"}, {"verdict", to_string(from.verdict)}};
  if (from.provenance) json["provenance"] = provenance(*from.provenance);
  json["driver"] = from.driver;
  json["original"] = mesh(from.original);
  if (from.view) {
    json["view"] = {{"pixels", number(from.view->pixels)},
                    {"screen_height", number(from.view->screen.height_pixels)},
                    {"fov_degrees", number(from.view->screen.vertical_field_of_view / std::numbers::pi * 180)}};
  }
  json["locked_vertices"] = from.locked_vertices;
  json["levels"] = Json::array();
  for (const LodReport::Level& level : from.levels)
    json["levels"].push_back(level_json(json["levels"].size(), level, from.original.summary.bbox_diagonal));
  if (from.deviation)
    json["deviation"] = deviation(*from.deviation, "original_to_simplified", "simplified_to_original");
  json["seconds"] = seconds(from.seconds);
  json["threads"] = from.threads;
  return text(json);
}

}  // namespace meshbound
