// SPDX-License-Identifier: MIT
#include "decimation/original.h"

#include <string>
#include <utility>

#include "attributes/seams.h"
#include "common/mesh_input.h"
#include "common/standard_streams.h"
#include "decimation/dropped_attributes.h"
#include "decimation/edge_file.h"
#include "mesh/writers.h"
#include "meshbound/error.h"
#include "meshbound/io.h"

namespace meshbound::tools {
namespace {

/// What --strict says of attributes that would not come along, and what to do.
std::string lost_attributes(const DecimationOptions& options, const std::filesystem::path& output,
                            const DroppedAttributes& dropped) {
  const std::string lost =
      as_typed(options.input) + ": " + as_typed(output.string()) + " would not carry " + listed(dropped);
  return options.workers == nullptr
             ? lost + "; choose another format, or leave out --strict"
             : lost +
                   ": --memory and MPI work on bare triangles; use simplify_with_bound without --memory, or leave "
                   "out --strict";
}

/// Drops the attributes that a file of this format does not carry; an STL file of text carries solids.
void drop_uncarried(FileFormat format, MeshAttributes& attributes, DroppedAttributes& dropped) {
  const bool carries_solids = format == FileFormat::Stl;
  TriangleLabels solids = carries_solids ? std::exchange(attributes.groups, {}) : TriangleLabels();
  attributes = carried_by(format, std::move(attributes), dropped);
  if (carries_solids) attributes.groups = std::move(solids);
}

}  // namespace

Original read_original(const DecimationOptions& options, const std::filesystem::path& output, bool with_checksum,
                       const StopToken& stop, MeshReport& report) {
  Original original;
  MeshAttributes& attributes = original.attributes;
  const FileFormat format = format_of(output);
  const bool carries =
      !options.drop_attributes && (carries_attributes(format) || (format == FileFormat::Stl && options.write.ascii));
  if (options.workers != nullptr) {
    original.stored = read_stored_input(options.input, with_checksum, report, stop, *options.workers);
  } else {
    original.mesh = read_input(options.input, with_checksum, report, stop, carries ? &attributes : nullptr);
    validate(original.mesh);
  }
  const bool bounds_texture = !options.texture_tolerance.empty();
  if (bounds_texture) {
    original.texture_as_read.texture_coordinates = attributes.texture_coordinates;
    original.texture_as_read.texture_precision = attributes.texture_precision;
  }
  if (carries) drop_uncarried(format, attributes, *report.dropped);
  if (bounds_texture) original.texture_as_read.materials = attributes.materials;
  if (options.strict && *report.dropped != DroppedAttributes{})
    throw InvalidInput(lost_attributes(options, output, *report.dropped));
  if (!attributes.empty()) {
    ChartPartition all = charts(original.mesh, attributes);
    original.feature_edges = seams(original.mesh, attributes, all);
    original.looks = std::move(all.layers.look);
  }
  if (!options.feature_edges.empty()) {
    const std::vector<Edge> given = read_edges(options.feature_edges, original.mesh.vertices.size(), stop);
    original.feature_edges.insert(original.feature_edges.end(), given.begin(), given.end());
  }
  original.rounding = placement_rounding(original.mesh, attributes);
  original.diagonal = report.summary.bbox_diagonal;
  return original;
}

}  // namespace meshbound::tools
