// SPDX-License-Identifier: MIT
#include "deviation/heatmap_file.h"

#include <algorithm>

#include "common/length.h"
#include "mesh/writers.h"

namespace meshbound::tools {
namespace {

/// Replaces line ends: a comment of a PLY header is one line.
std::string comment(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < ' '; }, ' ');
  return "comment " + text + "\n";
}

std::string header_of(const TriangleMesh& mesh, const DeviationScale& scale, const std::string& description) {
  return "ply\nformat binary_little_endian 1.0\n" + comment(description) +
         comment("quality: no more than this far away, model units") +
         comment("colours: viridis from 0 to " + exact_number(scale.end) + ", the " + scale.meaning +
                 "; 255 0 144 beyond it") +
         "element vertex " + std::to_string(mesh.vertices.size()) +
         "\nproperty double x\nproperty double y\nproperty double z\nproperty double quality\n"
         "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face " +
         std::to_string(mesh.triangles.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
}

}  // namespace

void write_heatmap(AtomicFile& file, const TriangleMesh& mesh, const std::vector<Bounds>& deviations,
                   const DeviationScale& scale, const std::string& description) {
  file.write(header_of(mesh, scale, description));
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    for (const double x : mesh.vertices[v]) put_little_endian(file, x);
    put_little_endian(file, deviations[v].upper);
    for (const std::uint8_t value : scale.colour(deviations[v])) put_little_endian(file, value);
  }
  for (const Triangle& t : mesh.triangles) {
    put_little_endian(file, std::uint8_t{3});
    for (const std::uint32_t v : t) put_little_endian(file, v);
  }
}

}  // namespace meshbound::tools
