// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "meshbound/triangle_mesh.h"

namespace meshbound::bench {

/// A mesh that the README's table of simplification names, and the faces to reach at 0.1%.
struct NamedMesh {
  const char* name;
  std::string_view file;  ///< in the data sets
  int normal, high;       ///< 0 where no figure was set
};

inline constexpr NamedMesh named_meshes[] = {
    {"fandisk", "cad/c3d_fandisk.obj", 350, 300},         {"rocker-arm", "cad/c3d_rocker-arm.obj", 2350, 1700},
    {"bunny", "scan/c3d_stanford-bunny.obj", 3800, 3000}, {"armadillo", "scan/igl_armadillo.obj", 0, 0},
    {"horse", "scan/c3d_horse.ply", 2750, 2100},          {"igea", "scan/c3d_igea.ply", 3650, 2850}};

/// A mesh of the data sets.
struct MeshFile {
  std::string name;  ///< folder and file
  std::filesystem::path path;
  std::size_t triangles = 0;
};

/// Every mesh of cad, game, organic, scan and pairs with 1,000 triangles or more, small ones first. Left out of pairs:
/// levels that were simplified from another mesh there, and copies of meshes in the other folders.
[[nodiscard]] std::vector<MeshFile> meshes_to_simplify();

/// Tolerance in model units: `percent` of the diagonal of the bounding box.
[[nodiscard]] double tolerance_of(const TriangleMesh& mesh, double percent);

}  // namespace meshbound::bench
