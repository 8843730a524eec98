// SPDX-License-Identifier: MIT
#include "penetration/arguments.h"

#include <CLI/CLI.hpp>

#include "common/distinct_files.h"
#include "common/output.h"
#include "meshbound/error.h"
#include "penetration/parts_file.h"

namespace meshbound::tools {

void add_arguments(CLI::App& app, PenetrationArguments& arguments) {
  app.add_option("A", arguments.a, "A closed mesh: OFF, OBJ, PLY, STL, GLB or glTF")->required();
  app.add_option("B", arguments.b, "The other one")->required();
  const char* const map = "Affine map for the vertices: 16 numbers, row-major, or a file that holds them";
  app.add_option("--transform-a", arguments.transform_a, map);
  app.add_option("--transform-b", arguments.transform_b, map);
  app.add_option("--error-bound", arguments.error_bound,
                 "Wanted width of each depth's interval: model units, or '0.1%' of A's bounding-box diagonal (default "
                 "0.0001%)");
  app.add_option("--tolerance", arguments.tolerance,
                 "Decide whether no volume is deeper than this (units as above): exit 0 none, 1 one is, 3 undecided. "
                 "Depths are narrowed no further than that needs, unless --error-bound is given too");
  app.add_option(
      "--output", arguments.output,
      "Write the parts of both surfaces and the lines between the deepest points as a mesh: OBJ with groups, "
      "or PLY with colours and edges");
  add_common_options(app, arguments.common);
  add_examples(app, {"generate_mesh icosphere --size 5120 -o sphere.ply",
                     "penetration_depth sphere.ply sphere.ply --transform-b \"1 0 0 1.5  0 1 0 0  0 0 1 0.2  0 0 0 1\" "
                     "--output parts.obj"});
}

PenetrationLengths check_arguments(const PenetrationArguments& arguments) {
  PenetrationLengths lengths;
  if (!arguments.error_bound.empty()) lengths.error_bound = parse_length("--error-bound", arguments.error_bound);
  if (!arguments.tolerance.empty()) lengths.tolerance = parse_length("--tolerance", arguments.tolerance);
  require_distinct_files({{"A", arguments.a},
                          {"B", arguments.b},
                          {"--transform-a", arguments.transform_a},
                          {"--transform-b", arguments.transform_b}},
                         {{"--json", arguments.common.json}, {"--output", arguments.output}});
  check_writable(arguments.common.json);
  if (!arguments.output.empty()) {
    require_parts_format(arguments.output);
    check_writable(arguments.output);
  }
  return lengths;
}

}  // namespace meshbound::tools
