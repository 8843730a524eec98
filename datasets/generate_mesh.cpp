// SPDX-License-Identifier: MIT
// generate_mesh KIND --size N -o FILE: one of our own analytic meshes as a file.
#include <CLI/CLI.hpp>
#include <Eigen/Geometry>
#include <cstdio>
#include <string>

#include "common/tool_main.h"
#include "datasets/analytic_meshes.h"
#include "meshbound/error.h"
#include "meshbound/io.h"

namespace {

/// x and y of the vertices, from 0 to 1 over the bounding box.
meshbound::CornerAttribute texture_seen_along_z(const meshbound::TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : mesh.vertices) box.extend(p);
  const Eigen::Array2d size = box.sizes().head<2>();
  meshbound::CornerAttribute texture;
  texture.index = mesh.triangles;
  for (const Eigen::Vector3d& p : mesh.vertices) {
    const Eigen::Array2d at = (p - box.min()).head<2>().array() / size;
    texture.values.emplace_back(at.x(), at.y(), 0);
  }
  return texture;
}

void require_texture_format(const std::string& path) {
  const meshbound::FileFormat format = meshbound::format_of(path);
  if (format == meshbound::FileFormat::Off || format == meshbound::FileFormat::Stl)
    throw meshbound::InvalidInput("--texture: " + path + " carries no texture coordinates; OBJ, PLY and glTF do");
}

}  // namespace

int main(int argc, char** argv) {
  namespace datasets = meshbound::datasets;
  CLI::App app("Writes a mesh of known shape and unit size; the format follows the extension of FILE.",
               "generate_mesh");
  std::string kind;
  std::string path;
  std::size_t faces = 100'000;
  bool has_texture = false;
  meshbound::WriteOptions options;
  app.add_option("KIND", kind, "Shape: " + datasets::kind_names())->required();
  app.add_option("--size", faces,
                 "Largest number of triangles, 1000 to 100000000: the mesh has as many as its grid can, at least half "
                 "(icosphere: a quarter)")
      ->capture_default_str();
  app.add_option("-o,--output", path, "OFF, OBJ, PLY, STL, GLB or glTF file to write")->required();
  app.add_flag("--texture", has_texture,
               "With texture coordinates: the bounding box seen along z, from 0 to 1 in x and y (OBJ, PLY and glTF)");
  meshbound::tools::add_write_options(app, options);
  std::string footer = "Kinds, closed unless said otherwise, in model units:\n";
  for (const datasets::Kind& known : datasets::kinds())
    footer += "  " + std::string(known.name) + ": " + std::string(known.description) + "\n";
  app.footer(footer + "Exit codes: 0 written, 2 bad usage or a file that cannot be written.");
  app.set_version_flag("--version", "generate_mesh " MESHBOUND_VERSION);
  return meshbound::tools::tool_main(app, argc, argv, [&] {
    if (has_texture) require_texture_format(path);
    const meshbound::TriangleMesh mesh = datasets::mesh_of_size(kind, faces);
    meshbound::MeshAttributes attributes;
    if (has_texture) attributes.texture_coordinates = texture_seen_along_z(mesh);
    meshbound::write_mesh(path, mesh, options, attributes);
    std::printf("%s: %zu vertices, %zu faces\n", path.c_str(), mesh.vertices.size(), mesh.triangles.size());
    return 0;
  });
}
