// SPDX-License-Identifier: MIT
#include "attributes/layers.h"

#include <algorithm>
#include <array>
#include <bit>
#include <map>
#include <utility>

#include "geometry/eigen_vec3.h"
#include "mesh/first_use.h"

namespace meshbound {
namespace {

/// The corners of a triangle by the first vertices at their positions, ascending.
using Corners = std::array<std::uint32_t, 3>;

/// What shows of a triangle, in numbers that are equal where it looks the same.
class LookWriter {
 public:
  LookWriter(const TriangleMesh& mesh, const MeshAttributes& attributes, const std::vector<std::uint32_t>& first)
      : mesh_(mesh), attributes_(attributes), first_(first) {}

  [[nodiscard]] std::vector<std::uint64_t> look(std::uint32_t triangle) const {
    std::vector<std::uint64_t> result;
    const auto at = [&](std::size_t k) { return first_[mesh_.triangles[triangle][k]]; };
    std::array<std::size_t, 3> order = {0, 1, 2};  // of the corners, from the lowest position on
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return at(a) < at(b); });
    result.push_back(order[1] == (order[0] + 1) % 3);
    if (!attributes_.part.empty()) result.push_back(attributes_.part[triangle]);
    for (const TriangleLabels* labels : {&attributes_.materials, &attributes_.objects, &attributes_.groups})
      if (!labels->empty()) result.push_back(labels->index[triangle]);
    for (const CornerAttribute* values : {&attributes_.texture_coordinates, &attributes_.normals})
      for (std::size_t k = 0; k < 3 && !values->index.empty(); ++k)
        add(*values, values->index[triangle][order[k]], result);
    for (const NamedAttribute& named : attributes_.named)
      for (const std::size_t k : order) add(named, named.index[triangle][k], result);
    return result;
  }

 private:
  /// -0 and 0 are one number.
  static std::uint64_t bits(double value) { return std::bit_cast<std::uint64_t>(value + 0.0); }

  static void add(const CornerAttribute& from, std::uint32_t number, std::vector<std::uint64_t>& to) {
    to.push_back(number == CornerAttribute::none);
    if (number == CornerAttribute::none) return;
    for (const double value : from.values[number]) to.push_back(bits(value));
  }

  static void add(const NamedAttribute& from, std::uint32_t number, std::vector<std::uint64_t>& to) {
    to.push_back(number == CornerAttribute::none);
    if (number == CornerAttribute::none) return;
    for (std::size_t i = 0; i < from.width; ++i) to.push_back(bits(from.values[number * from.width + i]));
  }

  const TriangleMesh& mesh_;
  const MeshAttributes& attributes_;
  const std::vector<std::uint32_t>& first_;
};

/// Triangles that may have the corners of others, sorted by their corners, then by their numbers.
std::vector<std::pair<Corners, std::uint32_t>> candidates(const TriangleMesh& mesh,
                                                          const std::vector<std::uint32_t>& first,
                                                          std::span<const TriangleNeighbours> neighbours) {
  std::vector<std::pair<Corners, std::uint32_t>> result;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (lies_between_two(neighbours[t])) continue;
    Corners corners{};
    for (std::size_t k = 0; k < 3; ++k) corners[k] = first[mesh.triangles[t][k]];
    std::sort(corners.begin(), corners.end());
    if (corners[0] != corners[1] && corners[1] != corners[2]) result.emplace_back(corners, t);
  }
  std::sort(result.begin(), result.end());
  return result;
}

/// `look_of(triangle)`: numbers that are equal where triangles look alike.
template <class LookOf>
Layers sorted_out(const TriangleMesh& mesh, const std::vector<std::uint32_t>& first,
                  std::span<const TriangleNeighbours> neighbours, const LookOf& look_of) {
  Layers result;
  const auto sorted = candidates(mesh, first, neighbours);
  for (std::size_t i = 0, end = 0; i < sorted.size(); i = end) {
    while (end < sorted.size() && sorted[end].first == sorted[i].first) ++end;
    if (end - i == 1) continue;
    if (result.empty()) {
      result.look.assign(mesh.triangles.size(), 0);
      result.sheet.assign(mesh.triangles.size(), 0);
    }
    std::map<std::vector<std::uint64_t>, std::uint32_t> first_alike;  // by look
    for (std::size_t k = i; k < end; ++k) {
      const std::uint32_t t = sorted[k].second;
      const auto sheet = static_cast<std::uint32_t>(first_alike.size());
      const auto [at, is_new] = first_alike.try_emplace(look_of(t), t);
      result.look[t] = is_new ? sheet : result.look[at->second];
      result.sheet[t] = is_new ? sheet : no_index;
      if (!is_new) result.repetitions.push_back({t, at->second});
    }
  }
  return result;
}

}  // namespace

Layers layers(const TriangleMesh& mesh, const MeshAttributes& attributes, const std::vector<std::uint32_t>& first,
              std::span<const TriangleNeighbours> neighbours) {
  const LookWriter writer(mesh, attributes, first);
  return sorted_out(mesh, first, neighbours, [&](std::uint32_t t) { return writer.look(t); });
}

Layers single_layer(const TriangleMesh& mesh, const std::vector<std::uint32_t>& first,
                    std::span<const TriangleNeighbours> neighbours) {
  Layers result = sorted_out(mesh, first, neighbours, [](std::uint32_t) { return std::vector<std::uint64_t>(); });
  result.look.clear();
  return result;
}

std::vector<TriangleNeighbours> neighbours_in_layers(const TriangleMesh& mesh, const Layers& layers) {
  std::vector<TriangleNeighbours> result(mesh.triangles.size(), {no_index, no_index, no_index});
  std::vector<std::pair<std::uint32_t, std::uint32_t>> sorted;  // sheet and triangle
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    if (layers.sheet[t] != no_index) sorted.emplace_back(layers.sheet[t], t);
  std::sort(sorted.begin(), sorted.end());
  FirstUse number(mesh.vertices.size());
  for (std::size_t i = 0, end = 0; i < sorted.size(); i = end) {
    while (end < sorted.size() && sorted[end].first == sorted[i].first) ++end;
    std::vector<Triangle> triangles;
    for (std::size_t k = i; k < end; ++k) triangles.push_back(number(mesh.triangles[sorted[k].second]));
    std::vector<Vec3> vertices;
    for (const std::uint32_t v : number.used()) vertices.push_back(to_vec3(mesh.vertices[v]));
    number.clear();
    const std::vector<TriangleNeighbours> here = edge_neighbours(vertices, triangles);
    for (std::size_t k = i; k < end; ++k)
      for (std::size_t c = 0; c < 3; ++c)
        if (const std::uint32_t other = here[k - i][c]; other != no_index)
          result[sorted[k].second][c] = sorted[i + other].second;
  }
  return result;
}

}  // namespace meshbound
