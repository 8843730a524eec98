// SPDX-License-Identifier: MIT
#include "tiles/tile_run.h"

#include "mesh/round_to_floats.h"
#include "numeric/numbers_below.h"
#include "simplify/decimation.h"

namespace meshbound {
namespace {

/// The original covers itself, triangle by triangle.
ProvenMesh covered_by_itself(const TriangleMesh& original) {
  ProvenMesh proven;
  proven.mesh = original;
  proven.near = proven.cover.numbers = numbers_below(original.triangles.size());
  proven.cover.begin = numbers_below(original.triangles.size() + 1);
  return proven;
}

TileOutput as_it_was(const TileInput& input, const SimplifyOptions& options, EndedBy ended_by) {
  TileOutput output;
  output.proven = input.start ? *input.start : covered_by_itself(input.original);
  if (options.precision == Precision::Single) round_to_floats(output.proven.mesh);
  output.source_vertex = numbers_below(output.proven.mesh.vertices.size());
  output.source_triangle = numbers_below(output.proven.mesh.triangles.size());
  output.ended_by = ended_by;
  return output;
}

/// Moves what is not part of the proven mesh from the end of a level to the output.
void split_off_kept(SimplifiedLevel& level, std::size_t proven_triangles, TileOutput& output) {
  output.kept.assign(level.source_triangle.begin() + static_cast<std::ptrdiff_t>(proven_triangles),
                     level.source_triangle.end());
  const std::size_t vertices = level.mesh.vertices.size() - 3 * output.kept.size();
  level.mesh.triangles.resize(proven_triangles);
  level.source_triangle.resize(proven_triangles);
  level.mesh.vertices.resize(vertices);
  level.source_vertex.resize(vertices);
}

}  // namespace

TileOutput simplify_tile(const TileInput& input, const SimplifyOptions& options, const StopToken& stop) {
  SimplifyOptions of_tile = options;
  of_tile.locked_vertices = input.locked;
  of_tile.progress = {};
  try {
    Decimation decimation = input.start ? Decimation(input.original, *input.start, of_tile, stop, input.at_rim)
                                        : Decimation(input.original, of_tile, stop, input.at_rim);
    const EndedBy ended_by = decimation.run(options.tolerance, 0, stop);
    if (ended_by == EndedBy::Rounding) return as_it_was(input, options, ended_by);
    TileOutput output;
    SimplifiedLevel level;
    decimation.current_mesh(level);
    decimation.current_proof(output.proven);
    split_off_kept(level, output.proven.near.size(), output);
    output.proven.mesh = std::move(level.mesh);
    output.source_vertex = std::move(level.source_vertex);
    output.source_triangle = std::move(level.source_triangle);
    output.turned = decimation.turned_faces();
    output.ended_by = ended_by;
    output.counts = decimation.counts();
    SimplifyResult facts;
    decimation.describe(facts);
    output.dropped_triangles = facts.dropped_triangles;
    output.split = facts.split;
    return output;
  } catch (const Stopped&) {
    return as_it_was(input, options, stop.cancelled() ? EndedBy::Cancelled : EndedBy::TimeLimit);
  }
}

}  // namespace meshbound
