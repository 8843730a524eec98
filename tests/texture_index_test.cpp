// SPDX-License-Identifier: MIT
// Triangles that the verifier compares in the texture: of those that have an area in common none may be missing.
#include "verify/texture_index.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "reference/point_triangle_cases.h"

namespace meshbound {
namespace texture_index_test {

using verify::TextureIndex;
using verify::TextureSurface;
using Coordinates = std::array<Eigen::Vector2d, 3>;

/// Coordinates are small integers here, so that doubles hold twice an area exactly.
double doubled_area(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// Whether an edge of `a` parts it from `b`.
bool parts(const Coordinates& a, const Coordinates& b) {
  const double turn = doubled_area(a[0], a[1], a[2]);
  for (std::size_t k = 0; k < 3; ++k)
    if (std::all_of(b.begin(), b.end(), [&](const Eigen::Vector2d& point) {
          return turn * doubled_area(a[k], a[(k + 1) % 3], point) <= 0;
        }))
      return true;
  return false;
}

class Surface {
 public:
  void add(const Coordinates& coordinates, std::uint32_t material = 0) {
    if (doubled_area(coordinates[0], coordinates[1], coordinates[2]) == 0) return;
    TextureSurface::Triangle& t = surface.triangles.emplace_back();
    t.index = static_cast<std::uint32_t>(surface.triangles.size() - 1);
    t.material = material;
    t.coordinates = coordinates;
  }
  /// A disc of triangles around a point, whose rim is ragged; the corners of each in one of all orders.
  void add_fan(reference::Random& random, const Eigen::Vector2d& hub, int sectors, double from, double to) {
    std::vector<Eigen::Vector2d> rim;
    for (int i = 0; i <= sectors; ++i) {
      const double angle = from + (to - from) * i / sectors, radius = 3e5 * (1 + random.below(3));
      rim.emplace_back(std::round(hub.x() + radius * std::cos(angle)), std::round(hub.y() + radius * std::sin(angle)));
    }
    for (std::size_t i = 0; i + 1 < rim.size(); ++i) {
      Coordinates t = {hub, rim[i], rim[i + 1]};
      std::rotate(t.begin(), t.begin() + random.below(3), t.end());
      if (random.below(2) == 0) std::swap(t[0], t[2]);
      add(t);
    }
  }

  TextureSurface surface;
};

/// Looks for the triangles of one surface among those of the other. Returns how many were found, of each on average.
double compare(const TextureSurface& a, const TextureSurface& b) {
  const TextureIndex index(b);
  double all = 0;
  for (const TextureSurface::Triangle& triangle : a.triangles) {
    std::vector<const TextureSurface::Triangle*> found = index.sharing_area(triangle), missing;
    all += static_cast<double>(found.size());
    std::sort(found.begin(), found.end());
    for (const TextureSurface::Triangle& other : b.triangles)
      if (other.material == triangle.material && !parts(triangle.coordinates, other.coordinates) &&
          !parts(other.coordinates, triangle.coordinates) && !std::binary_search(found.begin(), found.end(), &other))
        missing.push_back(&other);
    EXPECT_TRUE(missing.empty()) << triangle.index << ": " << missing.size();
  }
  return all / static_cast<double>(a.triangles.size());
}

TEST(TextureIndex, MissesNothingAroundAVertexOfManyTriangles) {
  constexpr double whole = 2 * std::numbers::pi;
  reference::Random random(1);
  const Eigen::Vector2d hub(0, 0), beside(1000, 0);
  Surface disc, half, wide, coarse, off, two;
  disc.add_fan(random, hub, 1000, 0, whole);
  half.add_fan(random, hub, 300, 1, 1 + whole / 2 - 0.01);
  wide.add_fan(random, hub, 5, 0, whole);
  coarse.add_fan(random, hub, 40, 0.1, 0.1 + whole);
  off.add_fan(random, beside, 100, 0, whole);
  two.add_fan(random, hub, 100, 0, whole);
  two.add_fan(random, hub, 100, 0, whole);
  for (const Surface* a : {&disc, &half, &wide, &coarse, &off, &two})
    for (const Surface* b : {&disc, &half, &wide, &coarse, &off, &two}) compare(a->surface, b->surface);
  EXPECT_LT(compare(disc.surface, disc.surface), 4);
}

TEST(TextureIndex, MissesNothingAmongRandomTriangles) {
  reference::Random random(2);
  for (const int size : {4, 30}) {
    Surface surface;
    for (int i = 0; i < 600; ++i) {
      const auto point = [&] { return Eigen::Vector2d(random.below(size), random.below(size)); };
      surface.add({point(), point(), point()}, static_cast<std::uint32_t>(random.below(2)));
    }
    compare(surface.surface, surface.surface);
  }
}

TEST(TextureIndex, FindsWhatTouches) {
  reference::Random random(3);
  Surface disc;
  disc.add_fan(random, {0, 0}, 200, 0, 2 * std::numbers::pi);
  TextureSurface::Triangle point;
  for (Eigen::Vector2d& uv : point.coordinates) uv = {0, 0};
  EXPECT_EQ(TextureIndex(disc.surface).touching(point).size(), disc.surface.triangles.size());
}

}  // namespace texture_index_test
}  // namespace meshbound
