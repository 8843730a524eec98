// SPDX-License-Identifier: MIT
#include "texture/single_coordinates.h"

#include <map>
#include <tuple>
#include <utility>

#include "meshbound/bvh.h"

namespace meshbound {
namespace {

/// A coordinate of a material.
using Coordinate = std::tuple<std::uint32_t, double, double>;

Coordinate coordinate_of(const TexturedTriangle& t) { return {t.material, t.coordinates[0].x(), t.coordinates[0].y()}; }

/// Numbers of triangles of A and B.
using Both = std::pair<std::vector<std::uint32_t>, std::vector<std::uint32_t>>;

std::map<Coordinate, Both> triangles_by_coordinate(const Charts& a, const Charts& b,
                                                   std::span<const std::size_t> wanted) {
  std::map<Coordinate, Both> found;
  for (const std::size_t i : wanted)
    if (const ChartTriangle& t = a.triangles()[i]; t.chart == Chart::Point)
      found[coordinate_of(*t.source)].first.push_back(t.number);
  if (found.empty()) return found;
  for (const ChartTriangle& t : b.triangles()) {
    if (t.chart != Chart::Point) continue;
    if (const auto same = found.find(coordinate_of(*t.source)); same != found.end())
      same->second.second.push_back(t.number);
  }
  return found;
}

Bvh tree_of(const TexturedMesh& mesh, std::span<const std::uint32_t> numbers, const TextureDeviationOptions& options) {
  TriangleMesh soup;
  for (const std::uint32_t number : numbers) {
    const auto first = static_cast<std::uint32_t>(soup.vertices.size());
    const auto& corners = mesh.triangles[number].corners;
    soup.vertices.insert(soup.vertices.end(), corners.begin(), corners.end());
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return Bvh(soup, BvhOptions{.threads = options.threads, .stop = options.stop});
}

/// The witness of a distance between such soups.
TextureWitness witness_of(const Witness& found, const TexturedMesh& a, const TexturedMesh& b, const Both& numbers) {
  const TexturedTriangle &from = a.triangles[numbers.first[found.from.triangle]],
                         &nearest = b.triangles[numbers.second[found.nearest.triangle]];
  return {{found.from.position, from.triangle},
          {found.nearest.position, nearest.triangle},
          from.coordinates[0],
          found.distance};
}

}  // namespace

std::vector<SingleCoordinate> distances_at_single_coordinates(const Charts& a, const Charts& b,
                                                              std::span<const std::size_t> wanted, double error_bound,
                                                              const TextureDeviationOptions& options) {
  DistanceOptions distance;
  distance.error_bound = error_bound;
  distance.threads = options.threads;
  distance.cancel = options.stop.cancel;
  std::vector<SingleCoordinate> all;
  for (auto& [coordinate, numbers] : triangles_by_coordinate(a, b, wanted)) {
    if (numbers.second.empty()) continue;
    options.stop.check();
    distance.budget.seconds = options.stop.seconds_left();
    const Bvh from = tree_of(a.mesh(), numbers.first, options), to = tree_of(b.mesh(), numbers.second, options);
    const OneSidedDistance found = one_sided_hausdorff_distance(from, to, distance);
    SingleCoordinate& single = all.emplace_back();
    single.upper.assign(numbers.first.size(), found.bounds.upper);
    if (options.tolerance && found.bounds.upper > *options.tolerance)
      for (std::size_t i = 0; i < numbers.first.size(); ++i) {
        options.stop.check();
        const Bvh alone = tree_of(a.mesh(), {&numbers.first[i], 1}, options);
        single.upper[i] = one_sided_hausdorff_distance(alone, to, distance).bounds.upper;
      }
    if (!b.may_have_among_others(a.triangles()[numbers.first.front()])) single.lower = found.bounds.lower;
    single.witness = witness_of(found.witness, a.mesh(), b.mesh(), numbers);
    single.triangles = std::move(numbers.first);
  }
  return all;
}

}  // namespace meshbound
