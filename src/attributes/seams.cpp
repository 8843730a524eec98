// SPDX-License-Identifier: MIT
#include "attributes/seams.h"

#include <algorithm>
#include <functional>

#include "geometry/position_table.h"
#include "mesh/attribute_check.h"
#include "mesh/mesh_arrays.h"
#include "meshbound/mesh_view.h"
#include "numeric/no_index.h"
#include "proof/edge_neighbours.h"

namespace meshbound {
namespace {

bool equal_values(const CornerAttribute& attribute, std::uint32_t a, std::uint32_t b) {
  return attribute.values[a] == attribute.values[b];
}

bool equal_values(const NamedAttribute& attribute, std::uint32_t a, std::uint32_t b) {
  const auto first = attribute.values.begin();
  const auto width = static_cast<std::ptrdiff_t>(attribute.width);
  return std::equal(first + a * width, first + (a + 1) * width, first + b * width);
}

template <class Attribute>
bool is_equal(const Attribute& attribute, std::uint32_t a, std::uint32_t b) {
  if (a == b) return true;
  if (a == CornerAttribute::none || b == CornerAttribute::none) return false;
  return equal_values(attribute, a, b);
}

/// The corner of a triangle at a position, which is given by the first vertex there.
std::size_t corner_at(const Triangle& triangle, const std::vector<std::uint32_t>& first, std::uint32_t position) {
  for (std::size_t k = 0; k < 3; ++k)
    if (first[triangle[k]] == position) return k;
  return 0;
}

/// Two triangles with a common edge, and their corners at its ends.
struct Neighbours {
  std::array<std::uint32_t, 2> triangles;
  std::array<std::array<std::size_t, 2>, 2> corners;  ///< by end: that of the first triangle, that of the second
};

/// The triangles at the edge of `t` from corner k to the next.
Neighbours neighbours_across(const TriangleMesh& mesh, const std::vector<std::uint32_t>& first, std::uint32_t t,
                             std::size_t k, std::uint32_t other) {
  Neighbours result{{t, other}, {}};
  for (std::size_t end = 0; end < 2; ++end) {
    const std::size_t corner = (k + end) % 3;
    result.corners[end] = {corner, corner_at(mesh.triangles[other], first, first[mesh.triangles[t][corner]])};
  }
  return result;
}

template <class Attribute>
bool differs(const Attribute& attribute, const Neighbours& at) {
  if (attribute.index.empty()) return false;
  const auto t = at.triangles[0], other = at.triangles[1];  // clang 14 captures no structured bindings
  return std::any_of(at.corners.begin(), at.corners.end(), [&](const std::array<std::size_t, 2>& corner) {
    return !is_equal(attribute, attribute.index[t][corner[0]], attribute.index[other][corner[1]]);
  });
}

bool differs(const std::vector<std::uint32_t>& by_triangle, const Neighbours& at) {
  return !by_triangle.empty() && by_triangle[at.triangles[0]] != by_triangle[at.triangles[1]];
}

bool is_seam(const MeshAttributes& attributes, const Neighbours& at) {
  return differs(attributes.materials.index, at) || differs(attributes.part, at) ||
         differs(attributes.objects.index, at) || differs(attributes.groups.index, at) ||
         differs(attributes.smoothing_groups.index, at) || differs(attributes.texture_coordinates, at) ||
         std::any_of(attributes.named.begin(), attributes.named.end(),
                     [&](const NamedAttribute& named) { return named.has_seams && differs(named, at); });
}

/// Whether there is a border between labels: one name for the whole mesh has none.
bool has_several(const TriangleLabels& labels) {
  return std::adjacent_find(labels.index.begin(), labels.index.end(), std::not_equal_to<>()) != labels.index.end();
}

/// Whether borders of charts must stay where they are: colours and other numbers alone do not need that.
bool has_chart_borders(const MeshAttributes& attributes) {
  return !attributes.texture_coordinates.empty() || !attributes.materials.empty() || !attributes.part.empty() ||
         has_several(attributes.objects) || has_several(attributes.groups) || has_several(attributes.smoothing_groups);
}

/// Makes edges seams where `is_seam(neighbours)`. Returns whether one was none before.
template <class IsSeam>
bool add_seams(const TriangleMesh& mesh, ChartPartition& charts, const IsSeam& is_seam) {
  bool has_new = false;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t other = charts.neighbours[t][k];
      if (other == no_index || charts.is_seam[t][k] != 0) continue;
      if (!is_seam(neighbours_across(mesh, charts.first, t, k, other))) continue;
      charts.is_seam[t][k] = 1;
      has_new = true;
    }
  }
  return has_new;
}

/// Numbers the charts: triangles connected across edges that are no seams. Repetitions are in the chart of what they
/// repeat.
void number_charts(ChartPartition& charts) {
  const std::size_t triangles = charts.neighbours.size();
  charts.count = 0;
  charts.chart_of.assign(triangles, no_index);
  std::vector<std::uint32_t> open;
  for (std::uint32_t start = 0; start < triangles; ++start) {
    if (charts.chart_of[start] != no_index || charts.layers.repeats(start)) continue;
    open.assign(1, start);
    charts.chart_of[start] = charts.count;
    while (!open.empty()) {
      const std::uint32_t t = open.back();
      open.pop_back();
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t other = charts.neighbours[t][k];
        if (other == no_index || charts.is_seam[t][k] != 0 || charts.chart_of[other] != no_index) continue;
        charts.chart_of[other] = charts.count;
        open.push_back(other);
      }
    }
    ++charts.count;
  }
  for (const auto& [triangle, of] : charts.layers.repetitions) charts.chart_of[triangle] = charts.chart_of[of];
}

}  // namespace

ChartPartition charts(const TriangleMesh& mesh, const MeshAttributes& attributes) {
  const std::size_t triangles = mesh.triangles.size();
  if (triangles > 0) validate(mesh);
  check_attributes(attributes, triangles);
  ChartPartition result;
  const std::vector<Vec3> positions = positions_of(mesh);
  result.first = first_at_position(positions);
  result.neighbours = edge_neighbours(positions, mesh.triangles);
  result.layers = has_chart_borders(attributes) ? layers(mesh, attributes, result.first, result.neighbours)
                                                : single_layer(mesh, result.first, result.neighbours);
  if (!result.layers.empty()) result.neighbours = neighbours_in_layers(mesh, result.layers);
  result.is_seam.resize(triangles, {0, 0, 0});
  (void)add_seams(mesh, result, [&](const Neighbours& at) { return is_seam(attributes, at); });
  number_charts(result);
  return result;
}

bool cut_at_normals(const TriangleMesh& mesh, const CornerAttribute& normals, ChartPartition& charts) {
  if (!add_seams(mesh, charts, [&](const Neighbours& at) { return differs(normals, at); })) return false;
  number_charts(charts);
  return true;
}

std::vector<std::uint32_t> looks(const TriangleMesh& mesh, const MeshAttributes& attributes) {
  return charts(mesh, attributes).layers.look;
}

std::vector<Edge> seams(const TriangleMesh& mesh, const MeshAttributes& attributes) {
  return seams(mesh, attributes, charts(mesh, attributes));
}

std::vector<Edge> seams(const TriangleMesh& mesh, const MeshAttributes& attributes, const ChartPartition& all) {
  std::vector<Edge> edges;
  const bool has_borders = has_chart_borders(attributes);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto at = [&](std::size_t k) { return all.first[mesh.triangles[t][k]]; };
    if (at(0) == at(1) || at(1) == at(2) || at(2) == at(0)) continue;  // a point or a segment has no border
    if (all.layers.repeats(t)) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t other = all.neighbours[t][k];
      const bool is_line = other == no_index ? has_borders : all.is_seam[t][k] != 0 && t < other;
      if (is_line) edges.push_back({mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]});
    }
  }
  return edges;
}

}  // namespace meshbound
