// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "batch/batch_run.h"
#include "common/tile_workers.h"
#include "decimation/decimation_options.h"
#include "deviation/deviation_request.h"

namespace meshbound::tools {

/// What the command line of simplify_with_bound says.
struct SimplifyArguments : DecimationOptions {
  std::string output, format, input_format, output_format, tolerance, on_exceed = "skip", effort = "normal", output_dir,
                                                                      certificate;
  std::vector<std::string> levels;
  std::optional<std::int64_t> target_faces;
  std::string target_ratio;
  bool prune = false;
  bool dry_run = false;
  std::string memory;  ///< as typed; empty: no limit, and the mesh in one piece
  std::size_t tile_triangles = meshbound::TileOptions().max_triangles;
  std::string scratch;  ///< folder; empty: none
  bool resume = false;
  BatchOptions batch;
  DeviationRequest deviation;
};

/// What to say where no tolerance is given.
inline constexpr const char* missing_tolerance =
    "--tolerance is missing: say how far the result may be from IN, such as --tolerance 0.1%, or --tolerance 100% "
    "where only the number of faces counts";

/// Puts what "-" stands for in place of it. Throws `InvalidInput` where it cannot be used, or not without --format, and
/// for options that do not go together.
void resolve_streams(SimplifyArguments& arguments);

/// Throws `InvalidInput` where IN is a folder.
void refuse_folder(const std::string& input);

/// Throws `InvalidInput` where the tolerance of OUT is missing, for lengths and shares that are none, and for an effort
/// that would have no effect.
void check_lengths(const SimplifyArguments& arguments);

/// Adds all options of simplify_with_bound; `arguments` must outlive the parsing.
void add_simplify_arguments(CLI::App& app, SimplifyArguments& arguments);

/// What they say of tiles.
[[nodiscard]] TileSetting tile_setting(const SimplifyArguments& arguments);

/// Adds those that a run in tiles knows, of which --memory may be left out.
void add_tile_arguments(CLI::App& app, SimplifyArguments& arguments);

}  // namespace meshbound::tools
