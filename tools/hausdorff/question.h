// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <string>

#include "common/length.h"
#include "common/texture_length.h"
#include "common/tool_main.h"
#include "deviation/deviation_request.h"
#include "meshbound/distance.h"
#include "meshbound/tiles.h"
#include "meshbound/triangle_mesh.h"

namespace meshbound::tools {

class TileWorkers;

/// The command line of hausdorff_distance.
struct Arguments {
  std::string a;
  std::string b;
  std::string format;  ///< of a mesh on standard input
  std::string error_bound;
  std::string tolerance;
  std::string transform_b;
  std::string poses;
  std::string nearest;
  bool align = false;
  std::size_t count = 1;
  bool one_sided = false;
  bool worst = false;
  bool profile = false;
  bool texture = false;
  std::string texture_tolerance;
  std::optional<double> texture_size;
  std::string certificate;
  std::string memory;  ///< as typed; empty: no limit, and trees of whole meshes
  std::size_t tile_triangles = meshbound::TileOptions().max_triangles;
  Method method = Method::CellWalking;
  DeviationRequest deviation;
  CommonOptions common;
  TileWorkers* workers = nullptr;  ///< who works on tiles; null: trees of whole meshes are searched
};

void add_arguments(CLI::App& app, Arguments& arguments);

/// Adds those that a measurement in tiles knows, of which --memory may be left out.
void add_tile_arguments(CLI::App& app, Arguments& arguments);

/// Puts what "-" stands for in place of it. Throws `InvalidInput` where it cannot be used, or not without --format.
void resolve_streams(Arguments& arguments);

/// The lengths of the command line as typed. They are parsed before any mesh is read, so that a typing error does not
/// cost a long read.
struct TypedLengths {
  std::optional<Length> error_bound;
  std::optional<Length> tolerance;
  std::optional<TextureLength> texture_tolerance;
};

/// Throws `InvalidInput` for lengths that are none and for options that exclude each other.
[[nodiscard]] TypedLengths parse_lengths(const Arguments& arguments);

/// What is asked about two meshes; lengths in model units.
struct Question {
  std::optional<double> error_bound;  ///< wanted width of the interval; absent: only the decision is wanted
  std::optional<double> tolerance;    ///< to decide against
  bool decide_first = false;          ///< both: the decision, with no time lost on the interval, then the interval
  bool one_sided = false;
  double displacement = 0;  ///< rounding of the transformed B: every bound is widened by it

  /// Largest tolerance which, met by the rounded image of B, is met by the exact one.
  [[nodiscard]] double tolerance_of_image() const;
  /// Width that is left for the interval of the rounded image of B.
  [[nodiscard]] double error_bound_of_image() const;
};

/// The question about these meshes; `diagonal` is that of A.
[[nodiscard]] Question question_about(double default_error_bound, const Arguments& arguments,
                                      const TypedLengths& lengths, double diagonal, double displacement);

}  // namespace meshbound::tools
