// SPDX-License-Identifier: MIT
#include "decimation/decimation_options.h"

#include <CLI/CLI.hpp>

#include "common/checks.h"
#include "decimation/drivers.h"

namespace meshbound::tools {

void add_decimation_options(CLI::App& app, DecimationOptions& options) {
  options.driver = default_driver();
  app.add_option(
         "--driver", options.driver,
         "Who orders and makes the collapses that are proven one by one: CGAL's edge_collapse, or our own queue")
      ->check(CLI::IsMember({"cgal", "core"}))
      ->capture_default_str();
  app.add_option("--cost", options.cost, "What makes a collapse cheap; lindstrom-turk needs --driver cgal")
      ->check(CLI::IsMember({"garland-heckbert", "lindstrom-turk"}))
      ->capture_default_str();
  app.add_flag("--preserve-boundary", options.preserve_boundary, "Leave edges with one face as they are");
  app.add_option("--feature-angle", options.feature_angle,
                 "Leave edges as they are where the normals of the faces are further apart than this, in degrees; both "
                 "ends of such an edge are locked, and the output says how many vertices that are. With "
                 "--line-tolerance they are lines instead")
      ->check(number_of_degrees);
  app.add_option(
      "--feature-edges", options.feature_edges,
      "File of edges that are feature lines, as borders are then: two vertices of IN a line, counted from 0; "
      "pairs that no triangle has as an edge say nothing");
  app.add_option("--line-tolerance", options.line_tolerance,
                 "Keep borders, and with --feature-angle creases, within this distance of where they were, both ways: "
                 "vertices of these lines move only along them");
  app.add_option("--placement", options.placement,
                 "Where vertices of the result stand: where they cost least, or only where the original has vertices")
      ->check(CLI::IsMember({"optimal", "subset"}))
      ->capture_default_str();
  auto* const drop = app.add_flag("--drop-attributes", options.drop_attributes,
                                  "Write bare triangles also where attributes could come along, and do not keep seams")
                         ->excludes(app.get_option("--texture-tolerance"));
  app.add_flag("--strict", options.strict,
               "Refuse an input that holds what the format of the output does not carry; nothing is written")
      ->excludes(drop);
  app.add_option("--error-bound", options.error_bound,
                 "Width of the interval that the distance of a result is measured to, once it is proven to be within "
                 "its tolerance (default: 1% of that)");
  add_write_options(app, options.write);
  add_common_options(app, options.common);
  app.description(
      app.get_description() +
      " Texture coordinates, normals, colours, materials and what else the format of the output carries come "
      "along; whatever it does not carry is counted and dropped.");
}

void add_appearance_options(CLI::App& app, DecimationOptions& options) {
  app.add_option("--texture-tolerance", options.texture_tolerance,
                 "Largest distance that the texture may move on the surface, between points of equal texture "
                 "coordinates, measured on what was written: a length as above, '2texels' with --texture-size, or '1x' "
                 "for as much as the tolerance of each level");
  app.add_option("--texture-size", options.texture_size, "Width of the texture, which counts as square, in texels")
      ->check(number_of_texels);
  app.add_option("--normal-tolerance", options.normal_tolerance,
                 "Largest angle by which a face may turn, in degrees: between each face of IN and the face of what is "
                 "written nearest to its centroid")
      ->check(number_of_degrees);
}

}  // namespace meshbound::tools
