// SPDX-License-Identifier: MIT
#include "deviation/deviation_request.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string>
#include <vector>

#include "deviation/report_file.h"
#include "mesh/output_target.h"
#include "meshbound/error.h"
#include "meshbound/io.h"

namespace meshbound::tools {

namespace {

/// A name without one is none of another kind of file.
void require_extension(const NamedPath& output, const std::vector<std::string>& extensions) {
  const std::string extension = CLI::detail::to_lower(output.path.extension().string());
  if (!extension.empty() && std::find(extensions.begin(), extensions.end(), extension) == extensions.end())
    throw InvalidInput(output.role + ": " + output.path.string() + " must be a " + extensions.front() + " file");
}

}  // namespace

std::vector<NamedPath> DeviationRequest::outputs() const {
  std::vector<NamedPath> all{
      {"--heatmap", heatmap}, {"--heatmap-original", original_heatmap}, {"--report", report}, {"--image", image}};
  std::erase_if(all, [](const NamedPath& output) { return output.path.empty(); });
  return all;
}

void DeviationRequest::check() const {
  if (!units.empty() && !has_any())
    throw InvalidInput("--units names the unit of deviations, and none is asked for: add --report, or leave it out");
  if (up && report.empty() && image.empty())
    throw InvalidInput("--up is for reports and pictures, and none is asked for: add --report, or leave it out");
  if (!report.empty()) require_report_page("--report");
  for (const NamedPath& output : outputs()) {
    if (output.role.starts_with("--heatmap") && format_of(output.path) != FileFormat::Ply)
      throw InvalidInput(output.role + ": " + output.path.string() +
                         " must be a .ply file: of the formats here only PLY holds numbers and colours of vertices");
    if (output.role == "--image") require_extension(output, {".png"});
    if (output.role == "--report") require_extension(output, {".html", ".htm"});
    (void)output_target(output.path);
  }
}

void add_report_options(CLI::App& app, DeviationRequest& request) {
  app.add_option("--report", request.report,
                 "Write a report as one HTML file: the meshes in 3D with their deviation, statistics, and the JSON "
                 "document");
  app.add_option("--units", request.units, "Name of the unit of lengths in reports and pictures, such as mm");
  app.add_option_function<std::string>(
         "--up",
         [&request](const std::string& axis) {
           request.up = axis == "x" ? UpAxis::X : (axis == "y" ? UpAxis::Y : UpAxis::Z);
         },
         "Axis that points up in reports and pictures (default z)")
      ->check(CLI::IsMember({"x", "y", "z"}, CLI::ignore_case));
}

void add_deviation_options(CLI::App& app, DeviationRequest& request, const std::string& original,
                           const std::string& result) {
  app.add_option(
      "--heatmap", request.heatmap,
      "Write " + result + " as PLY with the distance of each vertex to " + original +
          " (quality) and its colour, from 0 to the tolerance, or to the proven maximum where there is none");
  app.add_option("--heatmap-original", request.original_heatmap,
                 "Write " + original + " as PLY with the distance of each vertex to " + result);
  app.add_option("--image", request.image, "Write a PNG picture of both meshes and the deviation; needs no display");
  add_report_options(app, request);
}

}  // namespace meshbound::tools
