// SPDX-License-Identifier: GPL-3.0-or-later
#include "ratio_summary.h"

#include <algorithm>
#include <array>
#include <functional>
#include <set>

#include "measure.h"
#include "simplify_meshes.h"

namespace meshbound::bench {
namespace {

struct Group {
  const char* name;
  std::function<bool(const RatioOfMesh&)> has;
};

double shrinks(const RatioOfMesh& r) {
  return static_cast<double>(r.before) / static_cast<double>(std::max<std::size_t>(r.after, 1));
}

bool is_named(const RatioOfMesh& r) {
  return std::any_of(std::begin(named_meshes), std::end(named_meshes),
                     [&](const NamedMesh& m) { return m.file == r.mesh; });
}

const std::array<Group, 8> groups = {{
    {"all", [](const RatioOfMesh&) { return true; }},
    {"below 10k triangles", [](const RatioOfMesh& r) { return r.before < 10'000; }},
    {"10k to 100k", [](const RatioOfMesh& r) { return r.before >= 10'000 && r.before <= 100'000; }},
    {"above 100k", [](const RatioOfMesh& r) { return r.before > 100'000; }},
    {"shrinks at least fourfold", [](const RatioOfMesh& r) { return shrinks(r) >= 4; }},
    {"shrinks less", [](const RatioOfMesh& r) { return shrinks(r) < 4; }},
    {"loses at least a tenth", [](const RatioOfMesh& r) { return 10 * r.after <= 9 * r.before; }},
    {"fandisk; rocker-arm; bunny; armadillo; horse; igea", is_named},
}};

}  // namespace

Table ratio_summary(const std::vector<RatioOfMesh>& ratios) {
  Table table{{"tolerance %", "meshes", "number", "geometric mean", "median", "worst", "worst mesh"}, {}};
  std::set<double, std::greater<>> percents;
  for (const RatioOfMesh& r : ratios) percents.insert(r.percent);
  for (const double percent : percents) {
    for (const Group& group : groups) {
      std::vector<double> values;
      const RatioOfMesh* worst = nullptr;
      for (const RatioOfMesh& r : ratios) {
        if (r.percent != percent || !group.has(r)) continue;
        values.push_back(r.ratio);
        if (worst == nullptr || r.ratio > worst->ratio) worst = &r;
      }
      if (worst == nullptr) continue;
      table.rows.push_back({format(percent), group.name, std::to_string(values.size()), format(geometric_mean(values)),
                            format(median(values)), format(worst->ratio), worst->mesh});
    }
  }
  return table;
}

}  // namespace meshbound::bench
