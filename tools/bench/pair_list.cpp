// SPDX-License-Identifier: GPL-3.0-or-later
#include "pair_list.h"

#include <cstdio>

namespace meshbound::bench {
namespace {

namespace fs = std::filesystem;

PairSpec with_decimation(const std::string& name, Recipe mesh, double ratio, double reach) {
  Recipe reduced = mesh;
  reduced.ratio = ratio;
  const std::string percent = std::to_string(static_cast<int>(100 * ratio + 0.5)) + '%';
  return {name + " / its " + percent, ratio < 0.05 ? "coarse" : "decimation", mesh, reduced, reach};
}

/// Adds pairs of one surface with itself: by other triangles, in another order, or with other bits.
void add_near_zero_pairs(const std::string& name, const fs::path& file, std::vector<PairSpec>& pairs) {
  const Recipe mesh{file};
  Recipe subdivided = mesh, reordered = mesh, jittered = mesh, rounded = mesh;
  subdivided.subdivisions = 1;
  reordered.variation = Variation::OtherOrder;
  jittered.variation = Variation::Jittered;
  rounded.variation = Variation::Float;
  const bool has_target = name == "bunny";
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  pairs.push_back({name + " / its midpoint subdivision", "subdivision", mesh, subdivided, has_target ? 0.2 : none});
  pairs.push_back({name + " / itself", "identical", mesh, mesh, has_target ? 0.03 : none});
  pairs.push_back({name + " / itself in another order", "identical", mesh, reordered});
  pairs.push_back({name + " / itself moved by 1e-9", "near-zero", mesh, jittered});
  pairs.push_back({name + " / itself rounded to float", "near-zero", mesh, rounded});
}

void add_bunny_pairs(const fs::path& bunny, std::vector<PairSpec>& pairs) {
  const Recipe mesh{bunny};
  Recipe large = mesh;
  large.subdivisions = 2;
  pairs.push_back(with_decimation("bunny", mesh, 0.5, 0.15));
  pairs.push_back(with_decimation("bunny", mesh, 0.1, 0.06));
  pairs.push_back(with_decimation("bunny 1.1M", large, 0.5, 4));
  pairs.push_back(with_decimation("bunny 1.1M", large, 0.01, 0.8));
  PairSpec decision = with_decimation("bunny", mesh, 0.5, 0.1);
  decision.name += ": at most 5e-4?";
  decision.tolerance = 5e-4;
  pairs.push_back(decision);
}

std::string family_of(const fs::path& file) {
  const std::string name = file.filename().string();
  return name.substr(0, name.find("__"));
}

}  // namespace

std::vector<PairSpec> table_pairs() {
  const auto fandisk = find_dataset({"cad/c3d_fandisk.obj", "cgal/fandisk.off"});
  const auto bunny = find_dataset({"scan/c3d_stanford-bunny.obj", "cgal/bunny00.off"});
  const auto armadillo = find_dataset({"scan/igl_armadillo.obj", "cgal/armadillo.off"});
  std::vector<PairSpec> pairs;
  if (fandisk) {
    pairs.push_back(with_decimation("fandisk", {*fandisk}, 0.5, 0.04));
    pairs.push_back(with_decimation("fandisk", {*fandisk}, 0.1, 0.03));
    pairs.push_back(with_decimation("fandisk", {*fandisk}, 0.01, std::numeric_limits<double>::quiet_NaN()));
  }
  if (armadillo) pairs.push_back(with_decimation("armadillo", {*armadillo}, 0.5, 0.16));
  if (bunny) add_bunny_pairs(*bunny, pairs);
  if (fandisk) add_near_zero_pairs("fandisk", *fandisk, pairs);
  if (armadillo) add_near_zero_pairs("armadillo", *armadillo, pairs);
  if (bunny) add_near_zero_pairs("bunny", *bunny, pairs);
  if (bunny && armadillo) {
    Recipe apart{*armadillo};
    // The bunny has a diagonal of 1, so a longest dimension of at most 1: 3 of them.
    apart.offset = {3 * longest_dimension(make({*bunny}, {})), 0, 0};
    pairs.push_back({"bunny / armadillo overlapping", "apart", {*bunny}, {*armadillo}, 0.06});
    pairs.push_back({"bunny / armadillo 3 dimensions apart", "apart", {*bunny}, apart, 0.05});
  }
  if (!fandisk || !bunny || !armadillo)
    std::fprintf(stderr,
                 "pairs: fandisk, bunny or armadillo is missing; run datasets/fetch or set MESHBOUND_DATASETS\n");
  return pairs;
}

std::vector<PairSpec> decimation_pairs() {
  std::vector<PairSpec> pairs;
  for (const char* folder : {"cad", "organic", "scan", "game", "cgal", "npm"})
    for (const fs::path& file : list_dataset(folder))
      for (const double ratio : {0.5, 0.1})
        pairs.push_back(with_decimation(std::string(folder) + '/' + file.filename().string(), {file}, ratio,
                                        std::numeric_limits<double>::quiet_NaN()));
  return pairs;
}

PairSpec file_pair(const fs::path& a, const fs::path& b) {
  return {a.filename().string() + " / " + b.filename().string(), "given", {a}, {b, a}};
}

std::vector<PairSpec> dataset_pairs() {
  std::vector<PairSpec> pairs;
  const std::vector<fs::path> members = list_dataset("pairs");
  for (std::size_t i = 0; i < members.size(); ++i)
    for (std::size_t j = i + 1; j < members.size() && family_of(members[i]) == family_of(members[j]); ++j)
      pairs.push_back({members[i].filename().string() + " / " + members[j].filename().string(),
                       "real",
                       {members[i]},
                       {members[j], members[i]}});
  for (PairSpec& pair : decimation_pairs()) pairs.push_back(std::move(pair));
  return pairs;
}

}  // namespace meshbound::bench
