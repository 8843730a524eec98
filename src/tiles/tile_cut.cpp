// SPDX-License-Identifier: MIT
#include "tiles/tile_cut.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>
#include <utility>

#include "geometry/cut_axes.h"

namespace meshbound {
namespace {

class TileCutter {
 public:
  TileCutter(const PositionOf& position, std::span<const std::uint32_t> weights, std::uint64_t max_weight,
             const TileCut& cut)
      : position_(position),
        weights_(weights),
        max_weight_(max_weight),
        axes_(cut_axes[static_cast<std::size_t>(cut.direction)]),
        first_share_(cut.first_share) {}

  NumberLists run(std::vector<std::uint32_t> items) {
    NumberLists tiles;
    tiles.numbers = std::move(items);
    if (!tiles.numbers.empty()) cut(tiles, tiles.numbers, first_share_);
    return tiles;
  }

 private:
  void cut(NumberLists& tiles, std::span<std::uint32_t> items, double share) const {
    if (items.size() == 1 || weight(items) <= max_weight_) {
      std::sort(items.begin(), items.end());
      tiles.begin.push_back(tiles.begin.back() + static_cast<std::uint32_t>(items.size()));
      return;
    }
    const std::size_t axis = longest_axis(items);
    const auto middle = std::max<std::size_t>(1, static_cast<std::size_t>(share * static_cast<double>(items.size())));
    std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(middle), items.end(),
                     [&](std::uint32_t i, std::uint32_t j) {
                       const double at = along(axis, position_(i)), other = along(axis, position_(j));
                       return at < other || (at == other && i < j);
                     });
    cut(tiles, items.first(middle), 0.5);
    cut(tiles, items.subspan(middle), 0.5);
  }

  [[nodiscard]] std::uint64_t weight(std::span<const std::uint32_t> items) const {
    if (weights_.empty()) return items.size();
    return std::accumulate(items.begin(), items.end(), std::uint64_t{0},
                           [&](std::uint64_t sum, std::uint32_t i) { return sum + weights_[i]; });
  }

  [[nodiscard]] double along(std::size_t axis, const Eigen::Vector3d& p) const {
    return axes_[axis].x * p.x() + axes_[axis].y * p.y() + axes_[axis].z * p.z();
  }

  [[nodiscard]] std::size_t longest_axis(std::span<const std::uint32_t> items) const {
    Eigen::AlignedBox3d box;
    for (const std::uint32_t i : items) {
      const Eigen::Vector3d p = position_(i);
      box.extend(Eigen::Vector3d(along(0, p), along(1, p), along(2, p)));
    }
    Eigen::Index axis = 0;
    box.sizes().maxCoeff(&axis);
    return static_cast<std::size_t>(axis);
  }

  const PositionOf& position_;
  std::span<const std::uint32_t> weights_;
  std::uint64_t max_weight_;
  const std::array<Vec3, 3>& axes_;
  double first_share_;
};

}  // namespace

NumberLists cut_into_tiles(std::vector<std::uint32_t> items, const PositionOf& position,
                           std::span<const std::uint32_t> weights, std::uint64_t max_weight, const TileCut& cut) {
  return TileCutter(position, weights, max_weight, cut).run(std::move(items));
}

MeshPart part_of(const TriangleMesh& whole, std::span<const std::uint32_t> triangles) {
  MeshPart part;
  part.vertices.reserve(3 * triangles.size());
  for (const std::uint32_t t : triangles)
    part.vertices.insert(part.vertices.end(), whole.triangles[t].begin(), whole.triangles[t].end());
  std::sort(part.vertices.begin(), part.vertices.end());
  part.vertices.erase(std::unique(part.vertices.begin(), part.vertices.end()), part.vertices.end());
  part.vertices.shrink_to_fit();
  for (const std::uint32_t v : part.vertices) part.mesh.vertices.push_back(whole.vertices[v]);
  const auto index = [&](std::uint32_t v) {
    return static_cast<std::uint32_t>(std::lower_bound(part.vertices.begin(), part.vertices.end(), v) -
                                      part.vertices.begin());
  };
  part.mesh.triangles.reserve(triangles.size());
  for (const std::uint32_t t : triangles) {
    const auto& [a, b, c] = whole.triangles[t];
    part.mesh.triangles.push_back({index(a), index(b), index(c)});
  }
  return part;
}

}  // namespace meshbound
