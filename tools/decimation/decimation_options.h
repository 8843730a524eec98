// SPDX-License-Identifier: MIT
/// Options that every tool that decimates has.
#pragma once
#include <optional>
#include <string>

#include "common/tool_main.h"

namespace meshbound::tools {

class TileWorkers;

struct DecimationOptions {
  std::string input, driver, cost = "garland-heckbert";
  bool preserve_boundary = false;
  std::optional<double> feature_angle;  ///< degrees
  std::string feature_edges;            ///< a file of edges; empty: none
  std::string line_tolerance;           ///< a length as typed; empty: no feature lines
  std::string placement = "optimal";
  std::string texture_tolerance;           ///< as typed; empty: the texture may move as far as it likes
  std::optional<double> texture_size;      ///< texels of a side
  std::optional<double> normal_tolerance;  ///< degrees
  bool drop_attributes = false;
  bool strict = false;  ///< refuse an input of which outputs would not carry everything
  WriteOptions write;
  std::string error_bound;  ///< of the measurements, a length as typed; empty: the default
  CommonOptions common;
  TileWorkers* workers = nullptr;  ///< who works on tiles; null: meshes are decimated and measured in one piece
};

/// Adds --driver, --cost, --preserve-boundary, --feature-angle, --feature-edges, --line-tolerance, --placement,
/// --drop-attributes, --strict, --error-bound, what `add_write_options` and what `add_common_options` adds, and says in
/// the description what outputs do not carry. Comes after `add_appearance_options`, which --drop-attributes excludes.
void add_decimation_options(CLI::App& app, DecimationOptions& options);

/// Adds --texture-tolerance, --texture-size and --normal-tolerance.
void add_appearance_options(CLI::App& app, DecimationOptions& options);

}  // namespace meshbound::tools
