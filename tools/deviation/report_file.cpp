// SPDX-License-Identifier: MIT
#include "deviation/report_file.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "deviation/packed_numbers.h"
#include "deviation/report_page.h"
#include "meshbound/error.h"
#include "meshbound/mesh_summary.h"

namespace meshbound::tools {
namespace {

using Json = nlohmann::ordered_json;

/// Bytes of a report at most, also where the meshes are in it for its reader to measure.
constexpr std::size_t max_report_size = 20'000'000;

/// Coordinates of the view: the box of the original is centred at 0 and its diagonal is 1, so that floats can hold any
/// model.
struct ViewFrame {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double size = 1;

  explicit ViewFrame(const TriangleMesh& original) {
    const Eigen::AlignedBox3d box = used_bounding_box(original);
    if (box.isEmpty()) return;
    centre = box.min() / 2 + box.max() / 2;
    if (const double diagonal = diagonal_of(box); diagonal > 0) size = diagonal;
  }
};

std::string positions(const TriangleMesh& mesh, const ViewFrame& frame) {
  PackedNumbers numbers;
  for (const Eigen::Vector3d& p : mesh.vertices) {
    for (int k = 0; k < 3; ++k) {
      const double x = (p[k] - frame.centre[k]) / frame.size;
      numbers.add(static_cast<float>(std::isfinite(x) ? std::clamp(x, -1e30, 1e30) : 0));
    }
  }
  return numbers.text();
}

/// Deviations as 16-bit numbers: 0 to 65534 on the scale, 65535 beyond it.
std::string coded(const std::vector<Bounds>& deviations, const DeviationScale& scale) {
  constexpr std::uint16_t beyond = 65535;
  PackedNumbers numbers;
  for (const Bounds& deviation : deviations) {
    const double share = std::min(1.0, deviation.upper / scale.end);
    numbers.add(deviation.lower > scale.end ? beyond : static_cast<std::uint16_t>(std::lround(share * (beyond - 1))));
  }
  return numbers.text();
}

Json mesh_json(const DisplayMesh& display, const char* role, const std::string& name, const ReportScene& scene,
               const ViewFrame& frame) {
  return {{"role", role},
          {"name", name},
          {"faces", display.faces},
          {"shown", display.mesh.triangles.size()},
          {"reduced", display.is_reduced},
          {"positions", positions(display.mesh, frame)},
          {"triangles", packed_indices(display.mesh.triangles)},
          {"edges", packed_indices(display.edges)},
          {"deviations", coded(display.deviations, scene.scale)}};
}

std::string scene_json(const ReportScene& scene) {
  const ViewFrame frame(scene.original.mesh);
  Json json = {{"frame", {{"centre", {frame.centre.x(), frame.centre.y(), frame.centre.z()}}, {"size", frame.size}}},
               {"scale", {{"end", scene.scale.end}, {"meaning", scene.scale.meaning}}},
               {"unit", scene.unit},
               {"up", {scene.up == UpAxis::X ? 1 : 0, scene.up == UpAxis::Y ? 1 : 0, scene.up == UpAxis::Z ? 1 : 0}},
               {"beyond", colour_beyond}};
  for (const Colour& stop : colour_stops()) json["stops"].push_back(stop);
  json["meshes"].push_back(mesh_json(scene.original, "first", scene.original_name, scene, frame));
  for (std::size_t i = 0; i < scene.levels.size(); ++i) {
    const bool is_result = i + 1 == scene.levels.size();
    const std::string name = is_result ? scene.result_name : "level " + std::to_string(i);
    Json& mesh = json["meshes"].emplace_back(mesh_json(scene.levels[i].display, "second", name, scene, frame));
    mesh["first_deviations"] = coded(scene.levels[i].first, scene.scale);
  }
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// JSON that an HTML parser cannot take for the end of its element: "<", which occurs in strings only, is escaped.
std::string in_html(std::string json) {
  std::string text;
  text.reserve(json.size());
  for (const char c : json) {
    if (c == '<')
      text += "\\u003c";
    else
      text += c;
  }
  return text;
}

/// Writes `page` up to `mark` and returns what follows.
std::string_view write_until(AtomicFile& file, std::string_view page, std::string_view mark) {
  const std::size_t at = page.find(mark);
  file.write(page.substr(0, at));
  return page.substr(at + mark.size());
}

}  // namespace

void require_report_page(const std::string& option) {
  if (!report_page())
    throw InvalidInput(option +
                       ": this build has no report page, which needs three.js from npm; install Node.js and npm, then "
                       "configure and build again");
}

void write_report(AtomicFile& file, const std::string& document, const ReportScene& scene) {
  require_report_page("--report");
  const std::string shown = in_html(scene_json(scene)), text = in_html(document);
  std::string_view rest = *report_page();
  const std::size_t size = rest.size() + shown.size() + text.size();
  const MeasureHere here = scene.measure_here.within(max_report_size - std::min(max_report_size, size));
  const std::string measurement = here.measurement();
  for (const auto& [mark, content] : {std::pair<std::string_view, std::string_view>("@@DOCUMENT@@", text),
                                      {"@@SCENE@@", shown},
                                      {"@@MEASUREMENT@@", measurement},
                                      {"@@ENGINE@@", here.engine}}) {
    rest = write_until(file, rest, mark);
    file.write(content);
  }
  file.write(rest);
}

}  // namespace meshbound::tools
