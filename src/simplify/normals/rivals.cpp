// SPDX-License-Identifier: MIT
#include "simplify/normals/rivals.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/boxes.h"
#include "numeric/tasks.h"
#include "simplify/normals/sliced_triangles.h"

namespace meshbound {
namespace {

/// Rivals lie within so many sizes of a triangle, the square root of twice its area: there are few triangles of the
/// same kind, and sheets that lie further apart are rarely in each other's way. With half as much there are 0.2% more
/// faces and runs take as long, with twice as much they take 2% longer (28 runs at 1% and 0.2%, 30 degrees).
constexpr double sizes_within_reach = 2;

/// Share of the reach that is searched first: most triangles that have many rivals have enough of them within it.
constexpr double first_share = 0.5;

/// The square of a height above a plane times this is no more than the squared distance from a triangle in it, which
/// may be the same but for rounding.
constexpr double less_than_1 = 1 - 0x1p-20;

constexpr std::size_t grain = 1024;  ///< triangles that a thread takes at once

double size_of(const FacedTriangle& triangle) {
  const auto& [a, b, c] = triangle.corners;
  return std::sqrt(length(cross(b - a, c - a)));
}

/// A squared distance, and the triangle that has it.
using Near = std::pair<double, std::uint32_t>;

/// Looks for the rivals of one triangle after the other. One for each thread.
class RivalSearch {
 public:
  RivalSearch(std::span<const FacedTriangle> triangles, const SlicedTriangles& slices, const Rivals::Limits& limits)
      : triangles_(triangles), slices_(slices), limits_(limits) {}

  /// The rivals, by squared distance, with their numbers.
  std::span<const Near> run(const FacedTriangle& triangle) {
    const double reach = std::min(limits_.reach, sizes_within_reach * size_of(triangle));
    if (!find_enough(triangle, first_share * reach)) (void)find_enough(triangle, reach);
    return near_;
  }

 private:
  /// Whether as many as are wanted are within reach.
  bool find_enough(const FacedTriangle& triangle, double reach) {
    const Vec3 middle = triangle.middle();
    find_boxes(triangle, middle, reach);
    near_.clear();
    double squared_reach = reach * reach;
    for (const Near& box : boxes_within_) {
      if (box.first > squared_reach) break;
      const std::uint32_t other = box.second;
      if (std::ranges::any_of(near_, [&](const Near& known) { return known.second == other; })) continue;
      const Near near{squared_distance(triangles_[other].corners, middle), other};
      if (near.first > squared_reach) continue;
      near_.insert(std::upper_bound(near_.begin(), near_.end(), near), near);
      if (near_.size() > Rivals::max_rivals) near_.pop_back();
      if (near_.size() == Rivals::max_rivals) squared_reach = near_.back().first;
    }
    return near_.size() == Rivals::max_rivals;
  }

  /// Triangles that face elsewhere, once for each slice that is near, with the squared distances of their boxes or
  /// planes: the nearest ones first. Boxes of needles contain points that are far from their planes.
  void find_boxes(const FacedTriangle& triangle, Vec3 middle, double reach) {
    found_.clear();
    boxes_within_.clear();
    slices_.find(grown(Eigen::AlignedBox3d(to_eigen(middle)), reach), found_);
    for (const std::uint32_t slice : found_) {
      const std::uint32_t other = slices_.triangle(slice);
      if (dot(triangle.normal, triangles_[other].normal) >= limits_.min_cosine) continue;
      const double height = dot(triangles_[other].normal, middle - triangles_[other].corners[0]),
                   squared = std::max(less_than_1 * height * height, squared_distance(slices_.box(slice), middle));
      if (squared <= reach * reach) boxes_within_.emplace_back(squared, other);
    }
    std::sort(boxes_within_.begin(), boxes_within_.end());
  }

  std::span<const FacedTriangle> triangles_;
  const SlicedTriangles& slices_;
  const Rivals::Limits& limits_;
  std::vector<std::uint32_t> found_;
  std::vector<Near> boxes_within_, near_;
};

}  // namespace

Rivals::Rivals(std::span<const FacedTriangle> triangles, const Limits& limits) : rivals_(triangles.size()) {
  const SlicedTriangles slices(triangles);
  with_team(limits.threads, [&] {
    for_each_range(triangles.size(), grain, [&](std::size_t begin, std::size_t end) {
      RivalSearch search(triangles, slices, limits);
      for (std::size_t t = begin; t < end; ++t)
        for (const auto& [squared, other] : search.run(triangles[t]))
          rivals_[t].rivals[rivals_[t].count++] = {other, static_cast<float>(squared)};
    });
  });
  with_.emplace(triangles.size(), [this](const auto& add) {
    for (std::uint32_t t = 0; t < rivals_.size(); ++t)
      for (const Rival& rival : of(t)) add(rival.triangle, t);
  });
}

}  // namespace meshbound
