// SPDX-License-Identifier: MIT
#include "simplify/normals/rivals.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "numeric/tasks.h"
#include "simplify/cover/box_tree.h"
#include "simplify/mesh/face_box.h"

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

/// A triangle is searched in slices that are about so many times as long as it is high, but in no more than these: the
/// box of a needle askew to the axes holds whatever lies near it. `--normal-tolerance` on a disc of 60,000 needles
/// takes 2.4 s instead of 7.7, and 3.2 with 64 slices.
constexpr double max_heights_of_slice = 8;
constexpr int max_slices = 16;

constexpr std::size_t grain = 1024;  ///< triangles that a thread takes at once

double size_of(const FacedTriangle& triangle) {
  const auto& [a, b, c] = triangle.corners;
  return std::sqrt(length(cross(b - a, c - a)));
}

/// Boxes of slices of triangles, and which triangles these are of.
struct Slices {
  std::vector<Eigen::AlignedBox3d> boxes;
  std::vector<std::uint32_t> triangles;
};

/// How many slices a triangle is searched in.
int slice_count(const std::array<Vec3, 3>& corners) {
  const auto& [a, b, c] = corners;
  const double squared_longest = std::max({squared_length(b - a), squared_length(c - b), squared_length(a - c)});
  const double heights = squared_longest / length(cross(b - a, c - a));
  return static_cast<int>(std::clamp(heights / max_heights_of_slice, 1.0, double{max_slices}));
}

/// The corners, the one opposite to the shortest edge first.
std::array<Vec3, 3> from_tip(const std::array<Vec3, 3>& corners) {
  std::size_t tip = 0;
  const auto squared_opposite = [&](std::size_t k) {
    return squared_length(corners[(k + 2) % 3] - corners[(k + 1) % 3]);
  };
  for (std::size_t k = 1; k < 3; ++k)
    if (squared_opposite(k) < squared_opposite(tip)) tip = k;
  return {corners[tip], corners[(tip + 1) % 3], corners[(tip + 2) % 3]};
}

/// Slices are parallel to the shortest edge.
Slices slices_of(std::span<const FacedTriangle> triangles) {
  Slices slices;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const int count = slice_count(triangles[t].corners);
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

/// A squared distance, and the triangle that has it.
using Near = std::pair<double, std::uint32_t>;

/// Looks for the rivals of one triangle after the other. One for each thread.
class RivalSearch {
 public:
  RivalSearch(std::span<const FacedTriangle> triangles, const Slices& slices, const BoxTree& tree,
              const Rivals::Limits& limits)
      : triangles_(triangles), slices_(slices), tree_(tree), limits_(limits) {}

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
    for (const auto& [squared_from_box, other] : boxes_within_) {
      if (squared_from_box > squared_reach) break;
      if (std::ranges::any_of(near_, [&](const Near& known) { return known.second == other; })) continue;
      const Near near{squared_distance(triangles_[other].corners, middle), other};
      if (near.first > squared_reach) continue;
      near_.insert(std::upper_bound(near_.begin(), near_.end(), near), near);
      if (near_.size() > Rivals::max_rivals) near_.pop_back();
      if (near_.size() == Rivals::max_rivals) squared_reach = near_.back().first;
    }
    return near_.size() == Rivals::max_rivals;
  }

  /// Triangles that face elsewhere, with the squared distances of their boxes or planes: the nearest ones first. Boxes
  /// of needles contain points that are far from their planes.
  void find_boxes(const FacedTriangle& triangle, Vec3 middle, double reach) {
    found_.clear();
    boxes_within_.clear();
    tree_.find(grown(Eigen::AlignedBox3d(to_eigen(middle)), reach), found_);
    for (const std::uint32_t slice : found_) {
      const std::uint32_t other = slices_.triangles[slice];
      if (dot(triangle.normal, triangles_[other].normal) >= limits_.min_cosine) continue;
      const double height = dot(triangles_[other].normal, middle - triangles_[other].corners[0]),
                   squared = std::max(less_than_1 * height * height, squared_distance(slices_.boxes[slice], middle));
      if (squared <= reach * reach) boxes_within_.emplace_back(squared, other);
    }
    std::sort(boxes_within_.begin(), boxes_within_.end());
  }

  std::span<const FacedTriangle> triangles_;
  const Slices& slices_;
  const BoxTree& tree_;
  const Rivals::Limits& limits_;
  std::vector<std::uint32_t> found_;
  std::vector<Near> boxes_within_, near_;
};

}  // namespace

Rivals::Rivals(std::span<const FacedTriangle> triangles, const Limits& limits) : rivals_(triangles.size()) {
  const Slices slices = slices_of(triangles);
  const BoxTree tree(slices.boxes);
  with_team(limits.threads, [&] {
    for_each_range(triangles.size(), grain, [&](std::size_t begin, std::size_t end) {
      RivalSearch search(triangles, slices, tree, limits);
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
