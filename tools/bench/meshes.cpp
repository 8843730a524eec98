// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes.h"

#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <random>
#include <stdexcept>
#include <unordered_map>

#include "cgal_functions.h"
#include "child_process.h"
#include "mesh/round_to_floats.h"
#include "meshbound/io.h"
#include "meshbound/mesh_summary.h"

namespace meshbound::bench {
namespace {

namespace fs = std::filesystem;

TriangleMesh one_midpoint_subdivision(const TriangleMesh& mesh) {
  TriangleMesh result;
  result.vertices = mesh.vertices;
  result.triangles.reserve(4 * mesh.triangles.size());
  std::unordered_map<std::uint64_t, std::uint32_t> midpoints;
  midpoints.reserve(2 * mesh.triangles.size());
  const auto midpoint = [&](std::uint32_t u, std::uint32_t v) {
    const std::uint64_t edge = (std::uint64_t{std::min(u, v)} << 32) | std::max(u, v);
    const auto [found, is_new] = midpoints.try_emplace(edge, static_cast<std::uint32_t>(result.vertices.size()));
    if (is_new) result.vertices.emplace_back((mesh.vertices[u] + mesh.vertices[v]) / 2);
    return found->second;
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::uint32_t ab = midpoint(a, b), bc = midpoint(b, c), ca = midpoint(c, a);
    result.triangles.insert(result.triangles.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  return result;
}

TriangleMesh normalised(const Recipe& recipe) {
  TriangleMesh mesh = read_mesh(recipe.file).mesh;
  const bool own_frame = recipe.frame.empty() || recipe.frame == recipe.file;
  const TriangleMesh frame_mesh = own_frame ? TriangleMesh{} : read_mesh(recipe.frame).mesh;
  const Eigen::AlignedBox3d box = used_bounding_box(own_frame ? mesh : frame_mesh);
  const double diagonal = box.diagonal().norm();
  const Eigen::Vector3d corner = box.min();
  for (Eigen::Vector3d& p : mesh.vertices) p = (p - corner) / diagonal;
  return mesh;
}

void shuffle(TriangleMesh& mesh, std::mt19937& random) {
  std::vector<std::uint32_t> new_index(mesh.vertices.size());
  std::iota(new_index.begin(), new_index.end(), 0U);
  std::shuffle(new_index.begin(), new_index.end(), random);
  std::vector<Eigen::Vector3d> vertices(new_index.size());
  for (std::size_t v = 0; v < new_index.size(); ++v) vertices[new_index[v]] = mesh.vertices[v];
  mesh.vertices = std::move(vertices);
  for (Triangle& t : mesh.triangles)
    for (std::uint32_t& v : t) v = new_index[v];
  std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), random);
}

void vary(TriangleMesh& mesh, Variation variation) {
  std::mt19937 random(2009);
  std::uniform_real_distribution<double> offset(-1e-9, 1e-9);
  if (variation == Variation::OtherOrder) shuffle(mesh, random);
  for (Eigen::Vector3d& p : mesh.vertices) {
    if (variation == Variation::Jittered) p += Eigen::Vector3d(offset(random), offset(random), offset(random));
    if (variation == Variation::Float) p = rounded_to_float(p);
  }
}

TriangleMesh undecimated(const Recipe& recipe) { return midpoint_subdivision(normalised(recipe), recipe.subdivisions); }

/// The decimation from the cache, where a child process puts it first.
TriangleMesh cached_decimation(const Recipe& recipe, const fs::path& cache) {
  const std::string name = recipe.file.parent_path().filename().string() + '-' + recipe.file.filename().string() +
                           "-s" + std::to_string(recipe.subdivisions) + "-r" + std::to_string(recipe.ratio) + ".ply";
  const fs::path path = cache / name;
  if (!fs::exists(path)) {
    fs::create_directories(cache);
    constexpr double limit_seconds = 600;
    const ChildResult made = run_in_child(limit_seconds, [&] {
      write_mesh(path, decimated(undecimated(recipe), recipe.ratio));
      return std::vector<double>{};
    });
    if (made.status != ChildResult::Status::Done)
      throw std::runtime_error("decimating " + recipe.file.string() + ": " +
                               (made.error.empty() ? "took too long" : made.error));
  }
  return read_mesh(path).mesh;
}

}  // namespace

std::vector<fs::path> dataset_folders() {
  const fs::path source = MESHBOUND_SOURCE_DIR;
  const char* const named = std::getenv("MESHBOUND_DATASETS");
  std::vector<fs::path> folders;
  for (const fs::path& folder :
       {fs::path(named != nullptr ? named : ""), source / "../shared/datasets", source / "datasets/cache"})
    if (!folder.empty() && fs::is_directory(folder)) folders.push_back(folder);
  return folders;
}

std::optional<fs::path> find_dataset(const std::vector<std::string>& candidates) {
  for (const std::string& candidate : candidates)
    for (const fs::path& folder : dataset_folders())
      if (fs::exists(folder / candidate)) return folder / candidate;
  return std::nullopt;
}

std::vector<fs::path> list_dataset(const std::string& name) {
  std::vector<fs::path> files;
  for (const fs::path& folder : dataset_folders()) {
    if (!fs::is_directory(folder / name)) continue;
    for (const auto& entry : fs::directory_iterator(folder / name)) {
      const bool seen = std::any_of(files.begin(), files.end(),
                                    [&](const fs::path& file) { return file.filename() == entry.path().filename(); });
      if (entry.is_regular_file() && !seen) files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

TriangleMesh midpoint_subdivision(TriangleMesh mesh, int times) {
  for (int i = 0; i < times; ++i) mesh = one_midpoint_subdivision(mesh);
  return mesh;
}

TriangleMesh make(const Recipe& recipe, const fs::path& cache) {
  TriangleMesh mesh = recipe.ratio < 1 ? cached_decimation(recipe, cache) : undecimated(recipe);
  vary(mesh, recipe.variation);
  for (Eigen::Vector3d& p : mesh.vertices) p += recipe.offset;
  return mesh;
}

double longest_dimension(const TriangleMesh& mesh) { return used_bounding_box(mesh).sizes().maxCoeff(); }

}  // namespace meshbound::bench
