// SPDX-License-Identifier: GPL-3.0-or-later
// scaling: cost of a close pair against its size, 10k to 10M triangles a side: time on 1 and 2 threads, the exponent of
// their growth, and memory.
#include <cmath>
#include <cstdio>

#include "bench_main.h"
#include "datasets/analytic_meshes.h"
#include "meshbound/bvh.h"
#include "meshbound/distance.h"
#include "meshbound/io.h"
#include "our_run.h"
#include "table.h"

namespace {

using namespace meshbound;
using namespace meshbound::bench;
namespace fs = std::filesystem;

constexpr double relative_error_bound = 1e-6;

/// A value in [-1, 1] that depends on `index` alone (the finaliser of splitmix64).
double hashed(std::uint64_t index) {
  std::uint64_t z = index * 0x9e3779b97f4a7c15u + 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return static_cast<double>(z ^ (z >> 31)) * 0x1p-63 - 1;
}

/// Every coordinate moved by up to a tenth of an edge: a scan of the same surface made twice.
TriangleMesh with_noise(TriangleMesh mesh) {
  const Triangle& first = mesh.triangles[mesh.triangles.size() / 2];
  const double amplitude = 0.1 * (mesh.vertices[first[0]] - mesh.vertices[first[1]]).norm();
  std::uint64_t index = 0;
  for (Eigen::Vector3d& p : mesh.vertices)
    for (double& x : p) x += amplitude * hashed(index++);
  return mesh;
}

struct Family {
  const char* name;
  TriangleMesh (*a)(std::size_t size);
  TriangleMesh (*b)(std::size_t size);
};

const Family families[] = {
    {"torus and noise", [](std::size_t n) { return datasets::mesh_of_size("torus", n); },
     [](std::size_t n) { return with_noise(datasets::mesh_of_size("torus", n)); }},
    {"terrain and noise", [](std::size_t n) { return datasets::mesh_of_size("terrain", n); },
     [](std::size_t n) { return with_noise(datasets::mesh_of_size("terrain", n)); }},
    {"sphere and coarser", [](std::size_t n) { return datasets::mesh_of_size("uv-sphere", n); },
     [](std::size_t n) { return datasets::mesh_of_size("uv-sphere", n / 2); }},
};

/// Written by a child, so that what generating takes does not count as memory of what is measured.
fs::path cached(const Options& options, const char* family, char side, TriangleMesh (*mesh)(std::size_t),
                std::size_t n) {
  std::string name = std::string("scaling-") + family + '-' + side + '-' + std::to_string(n) + ".ply";
  for (char& c : name) c = c == ' ' ? '-' : c;
  const fs::path path = options.cache / name;
  if (fs::exists(path)) return path;
  const ChildResult child = run_in_child(1e6, [&] {
    write_mesh(path, mesh(n));
    return std::vector<double>{};
  });
  if (child.status != ChildResult::Status::Done) throw std::runtime_error("cannot make " + name + ": " + child.error);
  return path;
}

struct Measured {
  double triangles = 0;  ///< of both meshes
  double build = 0, query = 0, cpu = 0;
  double wall_one = 0, wall_two = 0;
  double bytes_per_triangle = 0;  ///< peak of a process that holds both meshes and both trees
  Bounds bounds;
};

/// Reads, builds and measures in a child, which holds nothing else: its peak is what a tool would need.
std::vector<double> run_once(const fs::path& path_a, const fs::path& path_b, int threads) {
  const TriangleMesh a = read_mesh(path_a).mesh, b = read_mesh(path_b).mesh;
  const Stopwatch watch;
  const auto [tree_a, tree_b] = build_trees(a, b, {threads});
  const Times built = watch.elapsed();
  DistanceOptions options;
  options.threads = threads;
  options.error_bound = relative_error_bound * tree_a.bounding_box_diagonal();
  const HausdorffDistance distance = hausdorff_distance(tree_a, tree_b, options);
  const Times total = watch.elapsed();
  return {static_cast<double>(a.triangles.size() + b.triangles.size()),
          built.cpu,
          total.cpu - built.cpu,
          total.cpu,
          total.wall,
          distance.bounds.lower,
          distance.bounds.upper};
}

Measured measure(const Options& options, const Family& family, std::size_t size) {
  const fs::path a = cached(options, family.name, 'a', family.a, size);
  const fs::path b = cached(options, family.name, 'b', family.b, size);
  Measured result;
  std::vector<double> build, query, cpu, wall[2];
  const auto turn = [&](int threads) {
    const ChildResult child = run_in_child(1e4, [&] { return run_once(a, b, threads); });
    if (child.status != ChildResult::Status::Done) throw std::runtime_error(family.name + (": " + child.error));
    const std::vector<double>& v = child.values;
    wall[threads - 1].push_back(v[4]);
    if (threads == 1) {
      result.triangles = v[0];
      build.push_back(v[1]), query.push_back(v[2]), cpu.push_back(v[3]);
      result.bounds = {v[5], v[6]};
      result.bytes_per_triangle = child.peak_bytes / v[0];
    }
    return v[4];
  };
  interleave({[&] { return turn(1); }, [&] { return turn(2); }}, 3, 2.0);
  result.build = median(build), result.query = median(query), result.cpu = median(cpu);
  result.wall_one = median(wall[0]), result.wall_two = median(wall[1]);
  return result;
}

int run(const Options& options) {
  Table table{{"pair", "triangles of both", "ours s", "build s", "query s", "wall s", "wall s 2 threads", "speed-up",
               "bytes a triangle", "lower [model units]", "upper [model units]"},
              {}};
  std::string exponents;
  for (const Family& family : families) {
    if (!options.wants(family.name)) continue;
    std::vector<double> sizes, seconds;
    for (const std::size_t size : {10'000u, 30'000u, 100'000u, 300'000u, 1'000'000u, 3'000'000u, 10'000'000u}) {
      if (options.quick && size > 1'000'000) break;
      const Measured m = measure(options, family, size);
      sizes.push_back(m.triangles), seconds.push_back(m.cpu);
      table.rows.push_back({family.name, format(m.triangles, 9), format(m.cpu), format(m.build), format(m.query),
                            format(m.wall_one), format(m.wall_two), format(m.wall_one / m.wall_two),
                            format(m.bytes_per_triangle), format(m.bounds.lower), format(m.bounds.upper)});
      table.write_csv(options.out / "scaling.csv", options.machine);
      std::printf("%s\n", Table{table.columns, {table.rows.back()}}.markdown().c_str());
      std::fflush(stdout);
    }
    exponents += std::string(family.name) + ": processor time grows with the power " +
                 format(fitted_exponent(sizes, seconds)) + " of the size (target 1.1).\n";
  }
  if (!options.found_any()) return 0;
  const std::string text = table.markdown() +
                           "\nTargets: 200 bytes a triangle at 1M and more; 60 s on two threads at "
                           "10M a side; speed-up 1.7 above 50k.\n\n" +
                           exponents;
  write_file(options.out / "scaling.md", text);
  std::printf("%s", exponents.c_str());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return bench_main(argc, argv, "Cost against size, 10k to 10M triangles a side.", run);
}
