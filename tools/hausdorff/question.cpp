// SPDX-License-Identifier: MIT
#include "hausdorff/question.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>

#include "common/checks.h"
#include "common/standard_streams.h"
#include "meshbound/distance.h"
#include "meshbound/error.h"
#include "meshbound/mesh_summary.h"
#include "meshbound/transform.h"

namespace meshbound::tools {

namespace {

/// What needs trees of whole meshes, so that it does not go with --memory.
constexpr std::array options_of_whole_meshes = std::to_array<const char*>(
    {"--poses", "--nearest", "--texture", "--heatmap", "--heatmap-original", "--image", "--report"});

/// What speaks of one of these.
constexpr std::array options_without_use_for_tiles =
    std::to_array<const char*>({"--align", "--count", "--texture-tolerance", "--texture-size", "--units", "--up"});

void add_mesh_options(CLI::App& app, Arguments& arguments, bool is_in_tiles) {
  app.add_option("A", arguments.a, "The original: OFF, OBJ, PLY, STL, GLB or glTF; - for standard input")->required();
  app.add_option(
      "B", arguments.b,
      std::string("The mesh to compare with it; - for standard input") + (is_in_tiles ? "" : "; not with --nearest"));
  add_stream_format(app, "--format", arguments.format, "input");
}

void add_question_options(CLI::App& app, Arguments& arguments, bool is_in_tiles) {
  const std::string of_shapes =
      "; with --nearest in units of normalised shapes (default: 0.001, or half of an upper bound if that is more)";
  app.add_option("--error-bound", arguments.error_bound,
                 "Wanted width of the interval: model units, or '0.1%' of A's bounding-box diagonal (default 0.0001%)" +
                     (is_in_tiles ? "" : of_shapes));
  app.add_option("--tolerance", arguments.tolerance,
                 "Decide whether the distance is at most this (units as above): exit 0 within, 1 exceeds, 3 undecided. "
                 "Stops as soon as that is known, unless --error-bound or --worst is given too");
  app.add_flag("--worst", arguments.worst,
               "Find the worst spot to the error bound and print it; with --tolerance after the decision, which ends "
               "with the first spot beyond");
  app.add_flag("--one-sided", arguments.one_sided, "Only from A to B");
}

void add_motion_options(CLI::App& app, Arguments& arguments) {
  app.add_option("--transform-b", arguments.transform_b,
                 "Affine map for the vertices of B: 16 numbers, row-major, or a file that holds them");
  app.add_option("--poses", arguments.poses,
                 "Measure, or decide with --tolerance, at each pose of B in this file: a line of 16 numbers for each, "
                 "row-major, rigid. Each pose starts from the results of the one before");
}

void add_nearest_options(CLI::App& app, Arguments& arguments) {
  CLI::Option* nearest = app.add_option("--nearest", arguments.nearest,
                                        "Instead of B: find the meshes below this folder that are most like A, by the "
                                        "distance after both are moved to the "
                                        "centroid and scaled to mean radius 1");
  app.add_flag(
         "--align", arguments.align,
         "With --nearest: also turn each mesh so that its principal axes lie on those of A, in the best of 4 ways")
      ->needs(nearest);
  app.add_option("--count", arguments.count, "With --nearest: number of meshes to find (default 1)")
      ->needs(nearest)
      ->check(CLI::Range(1, 1000000));
}

void add_texture_options(CLI::App& app, Arguments& arguments) {
  app.add_flag(
      "--texture", arguments.texture,
      "Also measure how far the texture moves on the surface: the largest distance from a point to the nearest "
      "one of the other mesh with the same texture coordinate");
  app.add_option("--texture-tolerance", arguments.texture_tolerance,
                 "With --texture: also decide whether the texture moves at most this far: a length as above, or "
                 "'2texels' with --texture-size. How far it moves is found to 1% of that then, unless --error-bound or "
                 "--worst is given too");
  app.add_option("--texture-size", arguments.texture_size,
                 "With --texture: width of the texture, which counts as square, in texels, to print lengths in texels "
                 "of A as well")
      ->check(number_of_texels);
}

/// `is_in_tiles`: with and without --memory.
void add_options(CLI::App& app, Arguments& arguments, bool is_in_tiles) {
  add_mesh_options(app, arguments, is_in_tiles);
  add_question_options(app, arguments, is_in_tiles);
  add_motion_options(app, arguments);
  add_nearest_options(app, arguments);
  app.add_flag("--profile", arguments.profile, "Print culling rates, queries, subdivisions and the time of each phase");
  add_texture_options(app, arguments);
  app.add_option(
         "--certificate", arguments.certificate,
         std::string("With --tolerance: write the proof that the distance is within it, for verify_certificate") +
             (is_in_tiles ? "" : "; with --texture-tolerance also that of the texture"))
      ->check(no_mesh_name);
  app.add_option_function<std::string>(
         "--method",
         [&arguments](const std::string& name) {
           arguments.method = name == "cross-culling" ? Method::CrossCulling : Method::CellWalking;
         },
         "cell-walking (default), or cross-culling: the method of Tang, Lee, Kim 2009, Lemma 4 in a sound form")
      ->check(CLI::IsMember({"cell-walking", "cross-culling"}));
  auto* const memory =
      app.add_option("--memory", arguments.memory,
                     "Work tile by tile within this memory, such as 4G, where the trees of whole meshes would not fit; "
                     "the meshes stand in files without names in $TMPDIR, else in /var/tmp");
  add_deviation_options(app, arguments.deviation, "A", "B");
  auto* const tile = app.add_option("--tile-triangles", arguments.tile_triangles,
                                    "Triangles of a tile; the interval may depend on them")
                         ->check(CLI::Range(std::size_t{1}, std::size_t{1} << 30))
                         ->capture_default_str();
  if (!is_in_tiles) tile->needs(memory);
  for (const char* const name : options_of_whole_meshes) memory->excludes(app.get_option(name));
  add_common_options(app, arguments.common);
}

}  // namespace

void add_arguments(CLI::App& app, Arguments& arguments) {
  add_options(app, arguments, false);
  add_examples(
      app, {"hausdorff_distance bunny.ply small.ply", "hausdorff_distance bunny.ply small.ply --tolerance 0.1% --quiet",
            "hausdorff_distance bunny.ply --nearest models"});
}

void add_tile_arguments(CLI::App& app, Arguments& arguments) {
  add_options(app, arguments, true);
  for (const char* const name : options_without_use_for_tiles) (void)app.remove_option(app.get_option(name));
  for (const char* const name : options_of_whole_meshes) (void)app.remove_option(app.get_option(name));
  app.get_option("B")->required();
  add_examples(app, {"mpirun -n 4 hausdorff_distance_mpi bunny.ply small.ply --tolerance 0.1%"});
}

void resolve_streams(Arguments& arguments) {
  if (arguments.a == "-" && arguments.b == "-") throw InvalidInput("A and B cannot both be standard input");
  if (arguments.a != "-" && arguments.b != "-" && !arguments.format.empty())
    throw InvalidInput("--format is for a mesh on standard input, which is called -; leave it out");
  arguments.a = stream_path("A", arguments.a, StandardStream::Input, arguments.format);
  arguments.b = stream_path("B", arguments.b, StandardStream::Input, arguments.format);
}

TypedLengths parse_lengths(const Arguments& arguments) {
  TypedLengths lengths;
  if (!arguments.error_bound.empty()) lengths.error_bound = parse_length("--error-bound", arguments.error_bound);
  if (!arguments.tolerance.empty()) lengths.tolerance = parse_length("--tolerance", arguments.tolerance);
  if (!arguments.texture_tolerance.empty())
    lengths.texture_tolerance =
        parse_texture_length("--texture-tolerance", arguments.texture_tolerance, arguments.texture_size.has_value());
  if (!arguments.texture && (lengths.texture_tolerance || arguments.texture_size))
    throw InvalidInput("--texture-tolerance and --texture-size go with --texture");
  if (arguments.texture && (arguments.one_sided || !arguments.nearest.empty() || !arguments.poses.empty()))
    throw InvalidInput("--texture measures both directions of two meshes: not with --one-sided, --nearest or --poses");
  if (arguments.b.empty() == arguments.nearest.empty())
    throw InvalidInput(arguments.b.empty() ? "B is missing: name a second mesh, or a folder with --nearest (see --help)"
                                           : "--nearest takes the place of B; leave one of them out");
  if (!arguments.nearest.empty() &&
      (arguments.one_sided || arguments.worst || arguments.profile || !arguments.tolerance.empty() ||
       !arguments.transform_b.empty() || !arguments.poses.empty() || !arguments.certificate.empty()))
    throw InvalidInput("--nearest goes with --align, --count, --error-bound and --method, not with other questions");
  if (!arguments.poses.empty() && (arguments.one_sided || arguments.worst || arguments.profile ||
                                   !arguments.transform_b.empty() || !arguments.certificate.empty()))
    throw InvalidInput(
        "--poses goes with --error-bound, --tolerance and --method, not with --one-sided, --worst, --profile, "
        "--transform-b or --certificate");
  if (arguments.deviation.has_any() && (!arguments.nearest.empty() || !arguments.poses.empty()))
    throw InvalidInput(arguments.deviation.outputs().front().role + " shows one pair of meshes; leave out " +
                       (arguments.nearest.empty() ? "--poses" : "--nearest"));
  if (arguments.certificate.empty()) return lengths;
  if (arguments.tolerance.empty() || arguments.one_sided || !arguments.transform_b.empty())
    throw InvalidInput("--certificate needs --tolerance, both directions and the meshes as they are in the files");
  return lengths;
}

double Question::tolerance_of_image() const { return widened({*tolerance, *tolerance}, displacement).lower; }

double Question::error_bound_of_image() const {
  // Both ends of the interval move by the displacement, and are rounded outward.
  return std::max(0.0, *error_bound - 4 * displacement);
}

Question question_about(double default_error_bound, const Arguments& arguments, const TypedLengths& lengths,
                        double diagonal, double displacement) {
  Question question;
  question.one_sided = arguments.one_sided;
  question.displacement = displacement;
  if (lengths.tolerance) question.tolerance = lengths.tolerance->in_model_units(diagonal);
  if (lengths.error_bound) question.error_bound = lengths.error_bound->in_model_units(diagonal);
  question.decide_first = arguments.worst && question.tolerance;
  const bool decision_only = question.tolerance && !arguments.worst;
  if (!question.error_bound && !decision_only) question.error_bound = default_error_bound;
  return question;
}

}  // namespace meshbound::tools
