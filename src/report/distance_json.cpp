// SPDX-License-Identifier: MIT
#include "meshbound/report.h"
#include "report/json_parts.h"

namespace meshbound {

std::string to_json(const DistanceReport& from) {
  using namespace report;
  const double diagonal = from.a.summary.bbox_diagonal;
  std::vector<const OneSidedDistance*> directions = {&from.a_to_b};
  if (from.b_to_a) directions.push_back(&*from.b_to_a);

  Json json = {{"schema", "meshbound/distance/1"}, {"verdict", from.verdict}, {"outcome", to_string(from.outcome)}};
  if (from.provenance) json["provenance"] = provenance(*from.provenance);
  if (!from.reason.empty()) json["reason"] = from.reason;
  json["error_bound"] = from.error_bound ? number(*from.error_bound) : Json(nullptr);
  if (from.tolerance) json["tolerance"] = length(*from.tolerance, diagonal);
  json["a"] = mesh(from.a);
  json["b"] = mesh(from.b);
  if (from.transform_displacement) json["b"]["transform_displacement"] = number(*from.transform_displacement);
  json["distance"] = bounds(from.bounds);
  json["distance"]["a_to_b"] = one_sided(from.a_to_b);
  if (from.b_to_a) json["distance"]["b_to_a"] = one_sided(*from.b_to_a);
  if (from.texture) json["texture"] = texture(*from.texture, diagonal, "a_to_b", "b_to_a");
  if (from.worst) json["worst"] = worst(*from.worst, "a_to_b", "b_to_a");
  if (from.deviation) json["deviation"] = deviation(*from.deviation, "a_to_b", "b_to_a");
  json["stats"] = stats(directions);
  json["seconds"] = {{"read", number(from.seconds.read)},
                     {"build", number(from.seconds.build)},
                     {"query", number(from.seconds.query)},
                     {"total", number(from.seconds.total)}};
  json["threads"] = from.threads;
  if (from.communication) json["communication"] = communication(*from.communication);
  return text(json);
}

}  // namespace meshbound
