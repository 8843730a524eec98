// SPDX-License-Identifier: MIT
#include "simplify/arguments.h"

#include <CLI/CLI.hpp>
#include <array>
#include <filesystem>

#include "common/checks.h"
#include "common/length.h"
#include "common/standard_streams.h"
#include "decimation/texture_tolerance.h"
#include "meshbound/error.h"

namespace meshbound::tools {
namespace {

/// Says what to use in place of an effort of earlier versions.
std::string is_effort(const std::string& effort) {
  return effort == "fast" ? "there is no fast any more: use normal, which is faster than it was" : "";
}

/// Throws `InvalidInput` for an effort that would have no effect.
void check_effort(const SimplifyArguments& arguments) {
  if (arguments.effort == "high" && arguments.on_exceed == "stop")
    throw InvalidInput(
        "--effort high goes on where nothing collapses any more, and --on-exceed stop ends there; leave "
        "out one of them");
}

/// Throws `InvalidInput` for the format of a stream that no mesh is on.
void check_formats(const SimplifyArguments& arguments) {
  const bool reads = arguments.input == "-", writes = arguments.output == "-";
  if (!reads && !writes && !arguments.format.empty())
    throw InvalidInput("--format is for a mesh on standard input or output, which is called -; leave it out");
  if (!reads && !arguments.input_format.empty())
    throw InvalidInput("--input-format is for a mesh on standard input: IN is then -");
  if (!writes && !arguments.output_format.empty())
    throw InvalidInput("--output-format is for a mesh on standard output: OUT is then -");
}

/// What needs the mesh in one piece, so that it does not go with --memory.
constexpr std::array options_of_whole_meshes =
    std::to_array<const char*>({"--levels", "--target-faces", "--target-ratio", "--on-exceed", "--prune", "--batch",
                                "--texture-tolerance", "--normal-tolerance", "--feature-angle", "--feature-edges",
                                "--line-tolerance", "--heatmap", "--heatmap-original", "--image", "--report"});

/// What speaks of one of these, or of an attribute.
constexpr std::array options_without_use_for_tiles =
    std::to_array<const char*>({"--output-dir", "--texture-size", "--drop-attributes", "--dry-run", "--units", "--up",
                                "--batch-merge", "--jobs", "--shard", "--memory-limit"});

void add_mesh_options(CLI::App& app, SimplifyArguments& arguments) {
  app.add_option("IN", arguments.input, "Mesh to simplify: OFF, OBJ, PLY, STL, GLB or glTF; - for standard input");
  app.add_option("OUT", arguments.output,
                 "File for the result; its extension chooses the format; - for standard output, where nothing else is "
                 "printed then");
  add_stream_format(app, "--format", arguments.format, "input and output");
  add_stream_format(app, "--input-format", arguments.input_format, "input, where it is not that of --format");
  add_stream_format(app, "--output-format", arguments.output_format, "output, where it is not that of --format");
}

/// How far the result goes.
void add_limit_options(CLI::App& app, SimplifyArguments& arguments) {
  app.add_option("--tolerance", arguments.tolerance,
                 "Largest symmetric Hausdorff distance to IN: model units, or 0.1% of the bounding-box diagonal");
  auto* faces = app.add_option("--target-faces", arguments.target_faces, "End at this many faces, tolerance permitting")
                    ->check(number_of_faces);
  app.add_option("--target-ratio", arguments.target_ratio, "The same as a share of the faces of IN: 0.1 or 10%")
      ->excludes(faces);
  app.add_option("--on-exceed", arguments.on_exceed,
                 "At a collapse that would exceed the tolerance: skip it and go on, or stop there")
      ->check(CLI::IsMember({"skip", "stop"}))
      ->capture_default_str();
}

void add_result_options(CLI::App& app, SimplifyArguments& arguments, bool is_in_tiles) {
  app.add_option("--levels", arguments.levels,
                 "Smaller tolerances to write levels of detail for as well: T1,T2,...; the finest is OUT_level_0, OUT "
                 "itself the coarsest")
      ->delimiter(',')
      ->allow_extra_args(false);  // so that IN may follow
  app.add_option("--output-dir", arguments.output_dir,
                 "Folder for the levels (default: that of OUT), or for the results of --batch");
  app.add_option("--certificate", arguments.certificate,
                 is_in_tiles ? "Write the proof that OUT is within the tolerance, for verify_certificate"
                             : "Write the proof that OUT is within the tolerance, and the texture within its own, for "
                               "verify_certificate; of levels beside it, as FILE_level_0 and so on")
      ->check(no_mesh_name);
  app.add_option(
         "--effort", arguments.effort,
         std::string("How long to look for fewer faces at the same bound: high also moves vertices and flips edges") +
             (is_in_tiles ? "" : "; with a tolerance of the texture or normals it is normal"))
      ->check(is_effort)
      ->check(CLI::IsMember({"normal", "high"}))
      ->capture_default_str();
  app.add_flag("--prune", arguments.prune, "Drop whole components that lie within the tolerance of what remains");
  app.add_flag(
      "--dry-run", arguments.dry_run,
      "Read and check IN, options and outputs as a run does before its work, say what that would take in memory and "
      "time, and write nothing");
}

/// `is_in_tiles`: with and without --memory.
void add_options(CLI::App& app, SimplifyArguments& arguments, bool is_in_tiles) {
  add_mesh_options(app, arguments);
  add_limit_options(app, arguments);
  add_result_options(app, arguments, is_in_tiles);
  add_batch_options(app, arguments.batch);
  add_appearance_options(app, arguments);
  auto* const memory = app.add_option(
      "--memory", arguments.memory,
      "Work tile by tile within this memory, such as 4G; the result is the same for every limit. Bare triangles, "
      "without attributes, which stand in files without names in the folder of --scratch, else in $TMPDIR or /var/tmp");
  add_deviation_options(app, arguments.deviation, "IN", "OUT");
  add_decimation_options(app, arguments);
  auto* const tile = app.add_option("--tile-triangles", arguments.tile_triangles,
                                    "Triangles of IN that a tile stands for; the result depends on them")
                         ->check(CLI::Range(std::size_t{1}, std::size_t{1} << 30))
                         ->capture_default_str();
  auto* const scratch = app.add_option("--scratch", arguments.scratch,
                                       "Keep the results of finished tiles in this folder until the run has ended, so "
                                       "that one that was killed can be resumed");
  auto* const resume = app.add_flag("--resume", arguments.resume,
                                    "Go on from what a run of the same mesh and options left in the folder of "
                                    "--scratch when it was killed")
                           ->needs(scratch);
  if (is_in_tiles) return;
  for (CLI::Option* const option : {tile, scratch, resume}) option->needs(memory);
  app.get_option("--feature-edges")->excludes(app.get_option("--batch"));
  for (const char* const name : options_of_whole_meshes) memory->excludes(app.get_option(name));
}

}  // namespace

void add_simplify_arguments(CLI::App& app, SimplifyArguments& arguments) {
  add_options(app, arguments, false);
  add_examples(app,
               {"simplify_with_bound bunny.ply small.ply --tolerance 0.1%",
                "simplify_with_bound bunny.ply part.stl --tolerance 0.05 --feature-angle 30 --line-tolerance 0.01",
                "simplify_with_bound bunny.ply small.ply --tolerance 0.1% --certificate small.cert --json small.json",
                "simplify_with_bound --batch models --output-dir small --tolerance 0.1% --jobs 2"});
}

TileSetting tile_setting(const SimplifyArguments& arguments) {
  return {{arguments.tile_triangles}, arguments.driver, arguments.cost, arguments.scratch, arguments.resume};
}

void add_tile_arguments(CLI::App& app, SimplifyArguments& arguments) {
  const std::string description = app.get_description();
  add_options(app, arguments, true);
  app.description(description);  // without what it says of attributes
  for (const char* const name : options_of_whole_meshes) (void)app.remove_option(app.get_option(name));
  for (const char* const name : options_without_use_for_tiles) (void)app.remove_option(app.get_option(name));
  for (const char* const name : {"IN", "OUT"}) app.get_option(name)->required();
  add_examples(app, {"mpirun -n 4 simplify_with_bound_mpi bunny.ply small.ply --tolerance 0.1%",
                     "srun simplify_with_bound_mpi terrain.ply small.ply --tolerance 0.02% --memory 16G --threads 8"});
}

void refuse_folder(const std::string& input) {
  std::error_code error;
  if (std::filesystem::is_directory(input, error))
    throw InvalidInput("IN: " + input + " is a folder; name a mesh in it, or simplify all with --batch " + input +
                       " --output-dir FOLDER");
}

void check_lengths(const SimplifyArguments& arguments) {
  check_effort(arguments);
  if (arguments.tolerance.empty()) throw InvalidInput(missing_tolerance);
  (void)parse_length("--tolerance", arguments.tolerance);
  if (!arguments.line_tolerance.empty()) (void)parse_length("--line-tolerance", arguments.line_tolerance);
  if (!arguments.error_bound.empty()) (void)parse_length("--error-bound", arguments.error_bound);
  if (!arguments.target_ratio.empty()) (void)parse_share("--target-ratio", arguments.target_ratio);
  if (!arguments.texture_tolerance.empty())
    (void)parse_texture_tolerance(arguments.texture_tolerance, arguments.texture_size.has_value());
}

void resolve_streams(SimplifyArguments& arguments) {
  check_formats(arguments);
  check_effort(arguments);
  const bool writes = arguments.output == "-";
  if (writes && arguments.common.json == "-") throw InvalidInput("OUT and --json cannot both be standard output");
  if (arguments.dry_run && !arguments.common.json.empty())
    throw InvalidInput("--dry-run prints an estimate and has no result for --json; leave out one of them");
  if (writes && !arguments.levels.empty())
    throw InvalidInput("--levels are files named after OUT, which is -; name OUT");
  arguments.input = stream_path("IN", arguments.input, StandardStream::Input,
                                arguments.input_format.empty() ? arguments.format : arguments.input_format);
  arguments.output = stream_path("OUT", arguments.output, StandardStream::Output,
                                 arguments.output_format.empty() ? arguments.format : arguments.output_format);
}

}  // namespace meshbound::tools
