// SPDX-License-Identifier: MIT
#include "lod/one_file.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <utility>

#include "mesh/file_bytes.h"
#include "mesh/gltf_document.h"
#include "mesh/writers.h"

namespace meshbound::tools {
namespace {

/// The diagonals of the boxes around what the nodes show, by node. A mesh of another format becomes that of node 0.
std::map<std::size_t, double> sizes_of_nodes(const TriangleMesh& mesh, const MeshAttributes& attributes) {
  std::map<std::size_t, Eigen::AlignedBox3d> boxes;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::size_t node = attributes.document ? attributes.document->placed_of(attributes.part[t]).node : 0;
    for (const std::uint32_t v : mesh.triangles[t]) boxes[node].extend(mesh.vertices[v]);
  }
  std::map<std::size_t, double> sizes;
  for (const auto& [node, box] : boxes) sizes[node] = box.diagonal().norm();
  return sizes;
}

/// An error of e units on a model of size d that covers the share s of a screen of h pixels covers s h e / d pixels.
NodeCoverage coverage(std::size_t node, double size, const std::vector<GatedOutput>& outputs, const PixelLimit& limit) {
  NodeCoverage result{node, {}};
  double error = 0;  // a coarser level may by chance be nearer to the original
  for (std::size_t level = 1; level < outputs.size(); ++level) {
    error = std::max(error, outputs[level].distance().bounds.upper);
    const double share = error > 0 ? limit.pixels * size / (limit.screen_height * error) : 1;
    result.shares.push_back(std::min(1.0, share));
  }
  result.shares.push_back(0);
  return result;
}

}  // namespace

void write_levels(AtomicFile& file, const std::vector<GatedOutput>& outputs, const TriangleMesh& original,
                  const MeshAttributes& attributes, const PixelLimit& limit, LevelVertices vertices) {
  std::vector<FileBytes> files;
  std::vector<GltfLevel> levels;
  for (const GatedOutput& output : outputs) {
    const MeshSource source{output.path(), files.emplace_back(output.staged()).bytes(), 0, {}, false};
    levels.push_back({source, read_gltf_document(source)});
  }
  std::vector<NodeCoverage> nodes;
  for (const auto& [node, size] : sizes_of_nodes(original, attributes))
    nodes.push_back(coverage(node, size, outputs, limit));
  write_gltf(file, FileFormat::Glb, with_levels(levels, nodes, vertices));
}

}  // namespace meshbound::tools
