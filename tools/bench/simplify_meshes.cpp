// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify_meshes.h"

#include <algorithm>
#include <array>

#include "meshbound/error.h"
#include "meshbound/io.h"
#include "meshbound/mesh_summary.h"
#include "meshes.h"

namespace meshbound::bench {
namespace {

namespace fs = std::filesystem;

/// Marks in pairs/ of levels, which are simplified already, and of copies of meshes in the other folders.
constexpr std::array<const char*, 4> marks = {"__lod", "_res", "_simplified", "__orig"};

bool is_level_or_copy(const std::string& name) {
  return std::any_of(marks.begin(), marks.end(),
                     [&](const char* mark) { return name.find(mark) != std::string::npos; });
}

/// The number of triangles of a file, 0 where it is no mesh.
std::size_t triangles_in(const fs::path& path) {
  try {
    return read_mesh(path).mesh.triangles.size();
  } catch (const Error&) {
    return 0;
  }
}

}  // namespace

std::vector<MeshFile> meshes_to_simplify() {
  constexpr std::size_t min_triangles = 1000;
  std::vector<MeshFile> meshes;
  for (const char* folder : {"cad", "game", "organic", "scan", "pairs"}) {
    for (const fs::path& path : list_dataset(folder)) {
      const std::string name = folder + ('/' + path.filename().string());
      if (is_level_or_copy(name)) continue;
      if (const std::size_t triangles = triangles_in(path); triangles >= min_triangles)
        meshes.push_back({name, path, triangles});
    }
  }
  std::stable_sort(meshes.begin(), meshes.end(),
                   [](const MeshFile& a, const MeshFile& b) { return a.triangles < b.triangles; });
  return meshes;
}

double tolerance_of(const TriangleMesh& mesh, double percent) {
  return 0.01 * percent * used_bounding_box(mesh).diagonal().norm();
}

}  // namespace meshbound::bench
