// SPDX-License-Identifier: MIT
#include "simplify/normals/sliced_triangles.h"

#include <algorithm>
#include <array>

#include "geometry/boxes.h"
#include "geometry/triangle_corners.h"

namespace meshbound {
namespace {

/// Where a point of the mesh lies in more boxes of triangles than these, in the mean, triangles are searched in slices:
/// the box of a needle askew to the axes holds whatever lies near it. Elsewhere CAD parts would take up to 1.3 of the
/// time.
constexpr std::size_t max_boxes_at_point = 64;
/// Triangles whose middles stand for the points of the mesh.
constexpr std::size_t middles = 64;

/// A slice is about so many times as long as the triangle is high, but a triangle has no more slices than these.
/// `--normal-tolerance` on a disc of 60,000 needles takes 2.9 s instead of 7.7; with 64 slices it takes longer.
constexpr double max_heights_of_slice = 8;
constexpr int max_slices = 16;

int slice_count(const TriangleCorners& corners) {
  const auto& [a, b, c] = corners;
  const double squared_longest = std::max({squared_length(b - a), squared_length(c - b), squared_length(a - c)});
  const double heights = squared_longest / length(cross(b - a, c - a));
  return static_cast<int>(std::clamp(heights / max_heights_of_slice, 1.0, double{max_slices}));
}

/// The corners, the one opposite to the shortest edge first.
TriangleCorners from_tip(const TriangleCorners& corners) {
  std::size_t tip = 0;
  const auto squared_opposite = [&](std::size_t k) {
    return squared_length(corners[(k + 2) % 3] - corners[(k + 1) % 3]);
  };
  for (std::size_t k = 1; k < 3; ++k)
    if (squared_opposite(k) < squared_opposite(tip)) tip = k;
  return {corners[tip], corners[(tip + 1) % 3], corners[(tip + 2) % 3]};
}

}  // namespace

SlicedTriangles::SlicedTriangles(std::span<const FacedTriangle> triangles)
    : slices_(slices_of(triangles, true)), tree_(slices_.boxes) {
  if (!are_many_boxes_at_points(triangles)) return;
  slices_ = slices_of(triangles, false);
  tree_ = BoxTree(slices_.boxes);
}

/// Slices are parallel to the shortest edge.
SlicedTriangles::Slices SlicedTriangles::slices_of(std::span<const FacedTriangle> triangles, bool is_whole) {
  Slices slices;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const int count = is_whole ? 1 : slice_count(triangles[t].corners);
    const auto [tip, p, q] = from_tip(triangles[t].corners);
    for (int i = 0; i < count; ++i) {
      Eigen::AlignedBox3d box;
      for (const double share : {static_cast<double>(i) / count, static_cast<double>(i + 1) / count})
        for (const Vec3 end : {p, q}) box.extend(to_eigen(tip + share * (end - tip)));
      slices.boxes.push_back(box);
      slices.triangles.push_back(t);
    }
  }
  return slices;
}

bool SlicedTriangles::are_many_boxes_at_points(std::span<const FacedTriangle> triangles) const {
  if (triangles.empty()) return false;
  std::vector<std::uint32_t> found;
  for (std::size_t i = 0; i < middles; ++i)
    find(Eigen::AlignedBox3d(to_eigen(triangles[i * triangles.size() / middles].middle())), found);
  return found.size() > max_boxes_at_point * middles;
}

}  // namespace meshbound
