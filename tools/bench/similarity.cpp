// SPDX-License-Identifier: GPL-3.0-or-later
// similarity: every mesh of the pairs of the data sets asks for the one that is most like it among all others. The
// family of a mesh are the meshes whose names begin alike, up to "__". Beside it, what measuring each of the others to
// the end takes. Shapes are read and normalised before; trees are built where a search needs them, and count.
#include "meshbound/similarity.h"

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <string>

#include "bench_main.h"
#include "measure.h"
#include "meshbound/io.h"
#include "meshes.h"
#include "table.h"

namespace {

using namespace meshbound;
using namespace meshbound::bench;

constexpr std::size_t max_triangles = 60'000;

/// Meshes in memory: each search and each measurement makes its shapes anew, so that both build what they need.
struct Library {
  std::vector<std::string> names;
  std::vector<TriangleMesh> meshes;

  [[nodiscard]] std::vector<Shape> shapes_without(std::size_t query) const {
    std::vector<Shape> shapes;
    for (std::size_t i = 0; i < meshes.size(); ++i)
      if (i != query) shapes.emplace_back(meshes[i], BvhOptions{1});
    return shapes;
  }
  [[nodiscard]] const std::string& name_without(std::size_t query, std::size_t index) const {
    return names[index < query ? index : index + 1];
  }
};

std::string family(const std::string& name) { return name.substr(0, name.find("__")); }

Library load() {
  Library library;
  for (const char* folder : {"pairs", "cad", "game", "organic", "scan"}) {
    for (const std::filesystem::path& file : list_dataset(folder)) {
      TriangleMesh mesh = read_mesh(file).mesh;
      if (mesh.triangles.size() > max_triangles) continue;
      library.names.push_back(file.stem().string());
      library.meshes.push_back(std::move(mesh));
    }
  }
  return library;
}

/// Seconds of processor time, and queries.
struct Cost {
  double seconds = 0, queries = 0;
};

Cost measure_all(const Shape& query, const std::vector<Shape>& others, const SimilarityOptions& options) {
  const Stopwatch watch;
  Cost cost;
  DistanceOptions to_the_end = options.distance;
  to_the_end.error_bound = options.error_bound;
  for (const Shape& other : others) {
    const HausdorffDistance distance = hausdorff_distance(query.tree(), other.tree(), to_the_end);
    cost.queries +=
        static_cast<double>(distance.a_to_b.stats.closest_point_queries + distance.b_to_a.stats.closest_point_queries);
  }
  cost.seconds = watch.elapsed().cpu;
  return cost;
}

int run(const Options& options) {
  const Library library = load();
  Table table{{"query", "triangles", "nearest", "of its family", "lower [rms radii]", "upper [rms radii]", "ms",
               "queries", "all ms", "all queries", "share of time %", "share of queries %"},
              {}};
  for (std::size_t q = 0; q < library.names.size(); ++q) {
    const auto is_family = [&](std::size_t i) {
      return i != q && family(library.names[i]) == family(library.names[q]);
    };
    std::vector<std::size_t> all(library.names.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    if (std::none_of(all.begin(), all.end(), is_family) || !options.wants(library.names[q])) continue;
    SimilarityOptions wanted;
    wanted.distance.threads = 1;
    const Shape query(library.meshes[q], {1}), again(library.meshes[q], {1});
    const std::vector<Shape> others = library.shapes_without(q), measured = library.shapes_without(q);
    const Stopwatch watch;
    const SimilarShapes found = nearest_shapes(query, others, wanted);
    const double seconds = watch.elapsed().cpu;
    const Cost cost = measure_all(again, measured, wanted);
    const std::string& first = library.name_without(q, found.nearest.front().index);
    const auto queries = static_cast<double>(found.stats.closest_point_queries);
    table.rows.push_back({library.names[q], std::to_string(library.meshes[q].triangles.size()), first,
                          family(first) == family(library.names[q]) ? "yes" : "no",
                          format(found.nearest.front().distance.lower), format(found.nearest.front().distance.upper),
                          format(1000 * seconds), format(queries), format(1000 * cost.seconds), format(cost.queries),
                          format(100 * seconds / cost.seconds), format(100 * queries / cost.queries)});
  }
  if (!options.found_any()) return 0;
  table.write_csv(options.out / "similarity.csv", options.machine);
  write_file(options.out / "similarity.md", table.markdown());
  std::printf("%s\n", table.markdown().c_str());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return bench_main(argc, argv, "The nearest shape of each mesh of the pairs, and measuring all of them.", run);
}
