// SPDX-License-Identifier: MIT
#include "penetration/model_planes.h"

#include "numeric/disjoint_sets.h"
#include "penetration/placed_pair.h"

namespace meshbound {
namespace {

/// The corner of a triangle that an edge of it does not have.
std::uint32_t apex_of(const Triangle& t, const ModelEdge& edge) {
  for (const std::uint32_t v : t)
    if (v != edge.from && v != edge.to) return v;
  return t[0];
}

}  // namespace

void find_planes(ClosedModel::Data& model, const StopToken& stop) {
  PlacedPair pair;
  pair.place(model, Pose::Identity(), model, Pose::Identity());
  pair.stop_by(stop);
  DisjointSets planes(model.triangles.size());
  for (const ModelEdge& edge : model.edges) {
    pair.count_step();
    const auto [first, second] = edge.triangle;
    const PairVertex from{0, edge.from}, to{0, edge.to}, apex{0, apex_of(model.triangles[first], edge)},
        other{0, apex_of(model.triangles[second], edge)};
    if (pair.orientation(from, to, apex, other) == 0) planes.unite(first, second);
  }
  model.plane_of.resize(model.triangles.size());
  for (std::uint32_t t = 0; t < model.triangles.size(); ++t) model.plane_of[t] = planes.find(t);
}

}  // namespace meshbound
