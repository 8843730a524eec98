// SPDX-License-Identifier: GPL-3.0-or-later
// Levels of detail for the vertex and index buffers of an engine: float positions inside a larger vertex, indices of 16
// bits where they suffice, tolerances from what a viewer can see.
// Usage: engine_lods IN
#include <meshbound/cgal/lod_chain.h>
#include <meshbound/distance.h>
#include <meshbound/io.h>
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
  meshbound::MeshView view() const {
    return {vertices[0].position, vertices.size(), sizeof(Vertex), indices.data(), indices.size() / 3};
  }
};

template <class Index>
bool make_levels(const Buffers<Index>& model) {
  const meshbound::Bvh original(model.view());
  const double size = original.bounding_box_diagonal();
  const meshbound::Screen screen{1080, 1.0};
  const std::vector<double> distances = {2 * size, 8 * size, 32 * size};

  meshbound::cgal::LodOptions options;
  // Positions become floats again: half an ulp in each coordinate, kept free within the tolerance.
  const double largest = original.bounding_box().min().cwiseAbs().cwiseMax(original.bounding_box().max()).maxCoeff();
  options.output_rounding = 2 * (largest + size) * 0x1p-24;
  options.measure = false;  // the buffers are what the viewer gets: they are measured below

  bool all_hold = true;
  const auto tolerances = meshbound::screen_space_tolerances(screen, 1, distances);
  meshbound::cgal::build_lod_chain(
      model.view(), tolerances, options, [&](std::size_t i, meshbound::cgal::LodLevel&& level) {
        const Buffers<Index> lod(level.mesh);
        const auto check = meshbound::check_symmetric(original, meshbound::Bvh(lod.view()), level.tolerance);
        std::printf("from distance %.6g: %zu of %zu faces, %zu-byte indices, H <= %.6g of %.6g\n", distances[i],
                    level.faces(), model.indices.size() / 3, sizeof(Index), check.bounds.upper, level.tolerance);
        all_hold = all_hold && check.verdict == meshbound::Verdict::Within;
        return all_hold && level.faces() > 16;  // coarser ones would show nothing: they are not computed
      });
  return all_hold;
}

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const meshbound::TriangleMesh mesh = meshbound::read_mesh(argv[1]).mesh;
  const bool is_short = mesh.vertices.size() <= 0x10000;
  const bool hold = is_short ? make_levels(Buffers<std::uint16_t>(mesh)) : make_levels(Buffers<std::uint32_t>(mesh));
  return hold ? 0 : 1;
}
