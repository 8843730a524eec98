// SPDX-License-Identifier: MIT
// generate_mesh KIND --size N -o FILE: one of our own analytic meshes as a file.
#include <cstdio>
#include <string>

#include "common/tool_main.h"
#include "datasets/analytic_meshes.h"
#include "meshbound/io.h"

int main(int argc, char** argv) {
  namespace datasets = meshbound::datasets;
  CLI::App app("Writes a mesh of known shape and unit size; the format follows the extension of FILE.",
               "generate_mesh");
  std::string kind;
  std::string path;
  std::size_t faces = 100'000;
  std::string names;
  for (const std::string_view name : datasets::kinds()) names += (names.empty() ? "" : ", ") + std::string(name);
  app.add_option("KIND", kind, "one of " + names)->required();
  app.add_option("--size", faces, "about how many triangles, never more")->capture_default_str();
  app.add_option("-o,--output", path, "OFF, OBJ, PLY or STL file to write")->required();
  app.footer("Exit codes: 0 written, 2 bad usage or a file that cannot be written.");
  return meshbound::tools::tool_main(app, argc, argv, [&] {
    const meshbound::TriangleMesh mesh = datasets::mesh_of_size(kind, faces);
    meshbound::write_mesh(path, mesh);
    std::printf("%s: %zu vertices, %zu faces\n", path.c_str(), mesh.vertices.size(), mesh.triangles.size());
    return 0;
  });
}
