// SPDX-License-Identifier: MIT
#include "decimation/decimation_text.h"

#include <cstdio>

#include "common/distance_text.h"
#include "common/length.h"
#include "decimation/dropped_attributes.h"

namespace meshbound::tools {

void print_dropped(const MeshReport& original) {
  if (original.dropped && *original.dropped != DroppedAttributes{})
    std::printf("dropped: %s\n", listed(*original.dropped).c_str());
  if (original.rest_pose_parts > 0)
    std::printf("rest pose: %zu parts have a skin or morph targets, and the bound is of how they are without these\n",
                original.rest_pose_parts);
}

std::string explanation(DecidedBy how) {
  switch (how) {
    case DecidedBy::Measurement:
      return "";
    case DecidedBy::SecondMethod:
      return "the measurement was undecided; a second method decided it";
    case DecidedBy::SmallerTolerance:
      return "the distance of the first result could not be decided: made again for 99% of the tolerance";
    case DecidedBy::SmallerLevel:
      return "no result for this tolerance could be decided or has fewer faces: it is that of the next smaller one";
    case DecidedBy::Original:
      break;
  }
  return "no result for this tolerance could be decided: it is the original";
}

void print_locked(std::size_t vertices, const MeshSummary& original) {
  if (vertices == 0) return;
  print_line("locked", std::to_string(vertices) + " of " + std::to_string(original.vertices) +
                           " vertices: they stay where they are, for edges");
}

void print_turned(std::size_t faces) {
  if (faces == 0) return;
  print_line("turned", face_count(faces) + " of the result, wound the other way than in the input, as neighbours are");
}

void print_lines(const std::optional<LineReport>& lines, double diagonal) {
  if (!lines) return;
  print_line("lines", std::to_string(lines->original_edges) + " -> " + std::to_string(lines->edges) +
                          " edges, tolerance " + both_units(lines->tolerance, diagonal));
  print_interval("", "distance ", lines->distance.bounds, diagonal);
}

void print_seconds(const SimplifyReport::Seconds& seconds, int threads) {
  print_line("seconds", "read " + rounded_seconds(seconds.read) + ", simplify " + rounded_seconds(seconds.simplify) +
                            ", write " + rounded_seconds(seconds.write) + ", certify " +
                            rounded_seconds(seconds.certify) + ", total " + rounded_seconds(seconds.total) +
                            thread_count(threads));
}

}  // namespace meshbound::tools
