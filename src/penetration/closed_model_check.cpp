// SPDX-License-Identifier: MIT
#include "penetration/closed_model_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include "meshbound/error.h"
#include "numeric/rounding.h"
#include "penetration/contact.h"
#include "penetration/exact_point.h"
#include "penetration/nodes_apart.h"
#include "penetration/parity.h"
#include "penetration/placed_pair.h"

namespace meshbound {
namespace {

/// One side of an edge, with the smaller vertex first.
struct HalfEdge {
  std::uint32_t low, high;
  std::uint32_t triangle;
  std::uint32_t corner;  ///< where it begins
};

std::vector<HalfEdge> sorted_half_edges(const ClosedModel::Data& model) {
  std::vector<HalfEdge> half_edges;
  half_edges.reserve(3 * model.triangles.size());
  for (std::uint32_t t = 0; t < model.triangles.size(); ++t)
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t from = model.triangles[t][k], to = model.triangles[t][next_corner(k)];
      half_edges.push_back({std::min(from, to), std::max(from, to), t, k});
    }
  std::sort(half_edges.begin(), half_edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  return half_edges;
}

std::string place_of(const ClosedModel::Data& model, std::uint32_t vertex) {
  const Vec3& p = model.positions[vertex];
  char text[96];
  std::snprintf(text, sizeof text, "(%.9g %.9g %.9g)", p.x, p.y, p.z);
  return text;
}

std::string name_of(const ClosedModel::Data& model, std::uint32_t triangle) {
  return "triangle " + std::to_string(model.source_triangle[triangle]);
}

std::string ends_of(const ClosedModel::Data& model, const HalfEdge& edge) {
  return "the edge from " + place_of(model, edge.low) + " to " + place_of(model, edge.high);
}

[[noreturn]] void throw_not_closed(const ClosedModel::Data& model, const HalfEdge* first, std::size_t count) {
  if (count == 1)
    throw InvalidInput("the mesh is open: " + name_of(model, first->triangle) + " has no neighbour across " +
                       ends_of(model, *first) + "; close its holes");
  if (count == 2)
    throw InvalidInput("the mesh is not consistently oriented: " + name_of(model, first[0].triangle) + " and " +
                       name_of(model, first[1].triangle) + " run along " + ends_of(model, *first) +
                       " in the same direction; orient it");
  throw InvalidInput("the mesh is not manifold: " + std::to_string(count) + " triangles, " +
                     name_of(model, first->triangle) + " among them, meet at " + ends_of(model, *first) +
                     "; a solid has two at each edge");
}

/// Whether the area is surely not 0; a computed component of the normal is off by less than 8 u times the magnitudes.
bool surely_has_area(const Vec3& p, const Vec3& q, const Vec3& r) {
  const Vec3 a = q - p, b = r - p;
  const auto is_certain = [](double x, double y) {
    return std::fabs(x - y) > 8 * unit_roundoff * (std::fabs(x) + std::fabs(y)) + 0x1p-1000;
  };
  return is_certain(a.y * b.z, a.z * b.y) || is_certain(a.z * b.x, a.x * b.z) || is_certain(a.x * b.y, a.y * b.x);
}

void require_area(const ClosedModel::Data& model, PlacedPair& pair) {
  for (std::uint32_t t = 0; t < model.triangles.size(); ++t) {
    const auto& [p, q, r] = model.triangles[t];
    if (surely_has_area(model.positions[p], model.positions[q], model.positions[r])) continue;
    const ExactPoint& at_p = pair.exact({0, p});
    const ExactPoint n = cross(pair.exact({0, q}) - at_p, pair.exact({0, r}) - at_p);
    if (sgn(n.x) == 0 && sgn(n.y) == 0 && sgn(n.z) == 0)
      throw InvalidInput(name_of(model, t) + " has no area: its corners lie in one line, at " + place_of(model, p) +
                         "; remove it and join what it separates");
  }
}

/// Signs of the volumes that the components enclose.
std::vector<int> signs_of_contents(const ClosedModel::Data& model, PlacedPair& pair) {
  const std::size_t count = model.components.size();
  std::vector<double> sum(count, 0), magnitude(count, 0);
  std::vector<mpz_class> exact;
  for (std::uint32_t t = 0; t < model.triangles.size(); ++t) {
    const std::uint32_t component = model.component_of[t];
    const Vec3 o = pair.local({0, model.triangles[model.components[component].triangle][0]});
    const auto& [p, q, r] = model.triangles[t];
    const Vec3 a = pair.local({0, p}) - o, b = pair.local({0, q}) - o, c = pair.local({0, r}) - o;
    sum[component] += dot(a, cross(b, c));
    magnitude[component] += length(a) * length(b) * length(c);
  }
  // At most 32 u for a term, whatever the cancellation, and n u for the sum; that is for exact coordinates.
  const double share = unit_roundoff * (64 + 2 * static_cast<double>(model.triangles.size()));
  std::vector<int> signs(count, 0);
  bool all_certain = true;
  for (std::size_t i = 0; i < count; ++i) {
    const bool is_certain = pair.error(0) < 0x1p-950 && std::fabs(sum[i]) > magnitude[i] * share + 0x1p-900;
    signs[i] = is_certain ? (sum[i] > 0 ? 1 : -1) : 0;
    all_certain = all_certain && is_certain;
  }
  if (all_certain) return signs;
  exact.resize(count);
  const ExactPoint zero{0, 0, 0};
  for (std::uint32_t t = 0; t < model.triangles.size(); ++t) {
    const auto& [p, q, r] = model.triangles[t];
    if (signs[model.component_of[t]] == 0)
      exact[model.component_of[t]] += volume_of(zero, pair.exact({0, p}), pair.exact({0, q}), pair.exact({0, r}));
  }
  for (std::size_t i = 0; i < count; ++i)
    if (signs[i] == 0) signs[i] = sgn(exact[i]);
  return signs;
}

/// Whether a component lies inside the solid bounded by the other components.
bool is_cavity(PlacedPair& pair, const ClosedModel::Data& model, std::uint32_t component) {
  if (model.components.size() == 1) return false;
  std::vector<bool> around = components_around(pair, {0, model.triangles[model.components[component].triangle][0]});
  around[component] = false;
  return std::count(around.begin(), around.end(), true) % 2 != 0;
}

/// Places the unmoved model on both sides of a pair.
void place_twice(PlacedPair& pair, const ClosedModel::Data& model, const StopToken& stop) {
  pair.place(model, Pose::Identity(), model, Pose::Identity());
  pair.stop_by(stop);
}

}  // namespace

void require_closed(ClosedModel::Data& model) {
  const std::vector<HalfEdge> half_edges = sorted_half_edges(model);
  model.edges_of.resize(model.triangles.size());
  for (std::size_t i = 0, end = 0; i < half_edges.size(); i = end) {
    const HalfEdge& first = half_edges[i];
    while (end < half_edges.size() && half_edges[end].low == first.low && half_edges[end].high == first.high) ++end;
    const auto runs_up = [&](const HalfEdge& h) { return model.triangles[h.triangle][h.corner] == h.low; };
    if (end - i != 2 || runs_up(first) == runs_up(half_edges[i + 1])) throw_not_closed(model, &first, end - i);
    const auto edge = static_cast<std::uint32_t>(model.edges.size());
    const HalfEdge &up = runs_up(first) ? first : half_edges[i + 1], &down = runs_up(first) ? half_edges[i + 1] : first;
    model.edges.push_back({up.low, up.high, {up.triangle, down.triangle}});
    model.edges_of[up.triangle][up.corner] = model.edges_of[down.triangle][down.corner] = edge;
  }
}

void require_no_crossing(const ClosedModel::Data& model, const StopToken& stop) {
  PlacedPair pair;
  place_twice(pair, model, stop);
  require_area(model, pair);
  BoxPairMemory box_pairs;
  PairCounters counters;
  visit_triangle_pairs(pair, true, NodesApart(model), box_pairs, counters, [&](std::uint32_t s, std::uint32_t t) {
    if (!triangles_cross(pair, model.triangles[s], model.triangles[t])) return true;
    const auto [first, second] = std::minmax(s, t);
    throw InvalidInput("the mesh intersects itself: " + name_of(model, first) + ", at " +
                       place_of(model, model.triangles[first][0]) + ", and " + name_of(model, second) +
                       " meet beyond common vertices and edges; repair it");
  });
}

void require_outward(const ClosedModel::Data& model, const StopToken& stop) {
  PlacedPair pair;
  place_twice(pair, model, stop);
  const std::vector<int> signs = signs_of_contents(model, pair);
  for (std::uint32_t component = 0; component < model.components.size(); ++component) {
    const std::uint32_t triangle = model.components[component].triangle;
    const bool is_inner = is_cavity(pair, model, component);
    if (signs[component] == (is_inner ? -1 : 1)) continue;
    const std::string where =
        "the component of " + name_of(model, triangle) + ", at " + place_of(model, model.triangles[triangle][0]) + ", ";
    throw InvalidInput(is_inner ? where +
                                      "lies inside another one and its normals point outwards, where those of a "
                                      "cavity point into it; reverse its triangles or remove it"
                                : where + "is inside out: its normals point inwards; reverse its triangles");
  }
}

}  // namespace meshbound
