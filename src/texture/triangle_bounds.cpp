// SPDX-License-Identifier: MIT
#include "texture/triangle_bounds.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>

#include "numeric/no_index.h"
#include "simplify/cover/box_tree.h"
#include "texture/charts.h"

namespace meshbound {
namespace {

/// The triangles of a mesh, found by their content, in whatever order their corners come.
class Triangles {
 public:
  /// `triangles` must outlive this. O(n log n).
  explicit Triangles(const std::vector<TexturedTriangle>& triangles) : triangles_(triangles) {
    sorted_.reserve(triangles.size());
    for (std::uint32_t i = 0; i < triangles.size(); ++i) sorted_.emplace_back(key(content(triangles[i])), i);
    std::sort(sorted_.begin(), sorted_.end());
  }

  /// The smallest index of such a triangle; `no_index` if there is none.
  [[nodiscard]] std::uint32_t find(const TexturedTriangle& t) const {
    const Content wanted = content(t);
    const std::uint64_t wanted_key = key(wanted);
    auto at = std::lower_bound(sorted_.begin(), sorted_.end(), std::pair(wanted_key, std::uint32_t{0}));
    for (; at != sorted_.end() && at->first == wanted_key; ++at)
      if (content(triangles_[at->second]) == wanted) return at->second;
    return no_index;
  }
  [[nodiscard]] bool has(const TexturedTriangle& t) const { return find(t) != no_index; }

 private:
  using Corner = std::array<double, 5>;
  using Content = std::pair<std::uint32_t, std::array<Corner, 3>>;

  static Content content(const TexturedTriangle& t) {
    Content all{t.material, {}};
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d& p = t.corners[k];
      all.second[k] = {t.coordinates[k].x(), t.coordinates[k].y(), p.x(), p.y(), p.z()};
    }
    std::sort(all.second.begin(), all.second.end());
    return all;
  }

  /// Equal for equal contents, rarely for others.
  static std::uint64_t key(const Content& content) {
    constexpr std::uint64_t odd = 0x9E3779B97F4A7C15;  // 2^64 over the golden ratio
    std::uint64_t key = content.first;
    for (const Corner& corner : content.second)
      for (const double x : corner) key = (std::rotl(key, 5) ^ std::bit_cast<std::uint64_t>(x + 0.0)) * odd;  // no -0
    return key;
  }

  const std::vector<TexturedTriangle>& triangles_;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> sorted_;  ///< by key
};

/// The boxes, in the texture, of the triangles that only one of two meshes has.
BoxTree changed_boxes(const TexturedMesh& b, const TexturedMesh& new_b) {
  std::vector<Eigen::AlignedBox3d> boxes;
  if (b == new_b) return BoxTree(boxes);
  const auto add = [&](const TexturedMesh& of, const Triangles& others) {
    for (const TexturedTriangle& t : of.triangles)
      if (!others.has(t)) boxes.push_back(box_in_texture(t));
  };
  add(b, Triangles(new_b.triangles));
  add(new_b, Triangles(b.triangles));
  return BoxTree(boxes);
}

}  // namespace

TriangleBounds bounds_of_equal(const TexturedMesh& a, const TexturedMesh& b) {
  TriangleBounds bounds;
  bounds.uncovered.resize(a.triangles.size());
  const Triangles others(b.triangles);
  for (const TexturedTriangle& t : a.triangles) bounds.upper.push_back(others.has(t) ? 0 : HUGE_VAL);
  return bounds;
}

TriangleBounds bounds_left(const TriangleBounds& known, const TexturedMesh& a, const TexturedMesh& b,
                           const TexturedMesh& new_a, const TexturedMesh& new_b) {
  TriangleBounds left = bounds_of_equal(new_a, new_b);
  const Triangles triangles_before(a.triangles);
  const BoxTree changed = changed_boxes(b, new_b);
  std::vector<std::uint32_t> met;
  for (std::size_t i = 0; i < new_a.triangles.size(); ++i) {
    if (left.upper[i] == 0) continue;
    const std::uint32_t before = triangles_before.find(new_a.triangles[i]);
    if (before == no_index) continue;
    met.clear();
    changed.find(box_in_texture(new_a.triangles[i]), met);
    if (!met.empty()) continue;
    left.upper[i] = known.upper[before];
    left.uncovered[i] = known.uncovered[before];
  }
  return left;
}

}  // namespace meshbound
