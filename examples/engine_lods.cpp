// SPDX-License-Identifier: MIT
// Levels of detail for the vertex and index buffers of an engine: float positions inside a larger vertex, indices of 16
// bits where they suffice, tolerances from what a viewer can see.
// Usage: engine_lods IN
#include <meshbound/bvh.h>
#include <meshbound/error.h>
#include <meshbound/io.h>
#include <meshbound/lod_chain.h>
#include <meshbound/screen_space.h>

#include <cstdint>
#include <cstdio>
#include <vector>

struct Vertex {
  float normal[3];
  float position[3];
  float uv[2];
};

template <class Index>
struct Buffers {
  std::vector<Vertex> vertices;
  std::vector<Index> indices;

  explicit Buffers(const meshbound::TriangleMesh& mesh) {
    for (const auto& p : mesh.vertices)
      vertices.push_back({{}, {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())}, {}});
    for (const auto& triangle : mesh.triangles)
      for (const std::uint32_t v : triangle) indices.push_back(static_cast<Index>(v));
  }
  // Nothing is copied: the view reads the buffers where they are.
  meshbound::MeshView view() const { return {vertices[0].position, vertices.size(), sizeof(Vertex), indices}; }
};

bool has_short_indices(const meshbound::TriangleMesh& mesh) { return mesh.vertices.size() <= 0x10000; }

template <class Index>
bool make_levels(const Buffers<Index>& model) {
  const double size = meshbound::Bvh(model.view()).bounding_box_diagonal();
  const meshbound::Screen screen{1080, 1.0};
  const std::vector<double> distances = {2 * size, 8 * size, 32 * size};

  meshbound::LodOptions options;
  options.precision = meshbound::Precision::Single;  // positions become floats again, and the bound is that of these

  bool all_hold = true;
  const auto tolerances = meshbound::screen_space_tolerances(screen, 1, distances);
  meshbound::build_lod_chain(model.view(), tolerances, options, [&](std::size_t i, meshbound::LodLevel&& level) {
    // A level may have more vertices than its original: where a mesh is not manifold, its parts come apart.
    const bool is_short = has_short_indices(level.mesh);
    const std::size_t indices = is_short ? Buffers<std::uint16_t>(level.mesh).indices.size()
                                         : Buffers<std::uint32_t>(level.mesh).indices.size();
    std::printf("from distance %.6g: %zu of %zu faces, %d-byte indices, H <= %.6g of %.6g\n", distances[i], indices / 3,
                model.indices.size() / 3, is_short ? 2 : 4, level.distance->bounds.upper, level.tolerance);
    all_hold = all_hold && level.verdict == meshbound::Verdict::Within;
    return all_hold && level.faces() > 16;  // coarser ones would show nothing: they are not computed
  });
  return all_hold;
}

int main(int argc, char** argv) try {
  if (argc != 2) return 2;
  const meshbound::TriangleMesh mesh = meshbound::read_mesh(argv[1]).mesh;
  const bool hold =
      has_short_indices(mesh) ? make_levels(Buffers<std::uint16_t>(mesh)) : make_levels(Buffers<std::uint32_t>(mesh));
  return hold ? 0 : 1;
} catch (const meshbound::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
