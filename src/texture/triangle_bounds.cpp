// SPDX-License-Identifier: MIT
#include "texture/triangle_bounds.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "numeric/no_index.h"
#include "simplify/cover/box_tree.h"
#include "texture/charts.h"

namespace meshbound {
namespace {

/// The triangles of a mesh, found by their content, in whatever order their corners come.
class Triangles {
 public:
  /// `triangles` must outlive this. O(n).
  explicit Triangles(const std::vector<TexturedTriangle>& triangles)
      : triangles_(triangles),
        shift_(63 - static_cast<int>(std::bit_width(triangles.size()))),
        first_(std::size_t{1} << (64 - shift_), no_index) {
    keys_.reserve(triangles.size());
    for (const TexturedTriangle& t : triangles) keys_.push_back(key(t));
    next_.resize(triangles.size());
    for (std::uint32_t i = static_cast<std::uint32_t>(triangles.size()); i-- > 0;)
      next_[i] = std::exchange(first_[keys_[i] >> shift_], i);
  }

  /// The smallest index of such a triangle; `no_index` if there is none.
  [[nodiscard]] std::uint32_t find(const TexturedTriangle& t) const {
    const std::uint64_t wanted = key(t);
    for (std::uint32_t i = first_[wanted >> shift_]; i != no_index; i = next_[i])
      if (keys_[i] == wanted && content(triangles_[i]) == content(t)) return i;
    return no_index;
  }
  [[nodiscard]] bool has(const TexturedTriangle& t) const { return find(t) != no_index; }

 private:
  using Corner = std::array<double, 5>;
  using Content = std::pair<std::uint32_t, std::array<Corner, 3>>;

  static std::array<Corner, 3> corners(const TexturedTriangle& t) {
    std::array<Corner, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d& p = t.corners[k];
      corners[k] = {t.coordinates[k].x(), t.coordinates[k].y(), p.x(), p.y(), p.z()};
    }
    return corners;
  }
  static Content content(const TexturedTriangle& t) {
    Content all{t.material, corners(t)};
    std::sort(all.second.begin(), all.second.end());
    return all;
  }

  /// Equal for equal contents, rarely for others: a sum over the corners, in whatever order these come.
  static std::uint64_t key(const TexturedTriangle& t) {
    constexpr std::uint64_t odd = 0x9E3779B97F4A7C15;  // 2^64 over the golden ratio
    std::uint64_t sum = t.material;
    for (const Corner& corner : corners(t)) {
      std::uint64_t key = 0;
      for (const double x : corner) key = (std::rotl(key, 5) ^ std::bit_cast<std::uint64_t>(x + 0.0)) * odd;  // no -0
      sum += key ^ (key >> 32);
    }
    return sum * odd;
  }

  const std::vector<TexturedTriangle>& triangles_;
  int shift_;                         ///< the highest bits of a key are the number of its list
  std::vector<std::uint32_t> first_;  ///< by list
  std::vector<std::uint64_t> keys_;
  std::vector<std::uint32_t> next_;  ///< by triangle: the next one of its list, with a larger index
};

/// Whether all points of the one box are farther than `distance` from all of the other, along one axis. A difference is
/// rounded, but not across the distance, which is a double itself.
bool are_apart(const Eigen::AlignedBox3d& p, const Eigen::AlignedBox3d& q, double distance) {
  return (p.min() - q.max()).maxCoeff() > distance || (q.min() - p.max()).maxCoeff() > distance;
}

/// The triangles that only one of two meshes B has, by their places in the texture.
class Changes {
 public:
  Changes(const TexturedMesh& b, const TexturedMesh& new_b, const Triangles& of_new_b)
      : tree_(std::vector<Eigen::AlignedBox3d>{}) {
    if (b == new_b) return;
    std::vector<Eigen::AlignedBox3d> boxes;
    const auto add = [&](const TexturedMesh& of, const Triangles& others) {
      for (const TexturedTriangle& t : of.triangles) {
        if (others.has(t)) continue;
        boxes.push_back(box_in_texture(t));
        places_.push_back(place_of(t));
      }
    };
    add(b, of_new_b);
    gone_ = places_.size();
    add(new_b, Triangles(b.triangles));
    tree_ = BoxTree(boxes);
  }

  /// Whether the bounds of a triangle of A hold as they are. Where all of it is covered, what comes makes nothing
  /// farther; and what goes was nearest to no point of it if it is beyond the upper bound.
  [[nodiscard]] bool leave(const TexturedTriangle& a, double upper, const Approximate& uncovered) {
    met_.clear();
    tree_.find(box_in_texture(a), met_);
    if (met_.empty()) return true;
    if (!(upper >= 0) || !uncovered.is_zero()) return false;
    return std::all_of(met_.begin(), met_.end(), [&, place = place_of(a)](std::uint32_t change) {
      return change >= gone_ || are_apart(place, places_[change], upper);
    });
  }

 private:
  BoxTree tree_;
  std::vector<Eigen::AlignedBox3d> places_;  ///< in space, by change: first those that go
  std::size_t gone_ = 0;
  std::vector<std::uint32_t> met_;
};

TriangleBounds bounds_of_equal(const TexturedMesh& a, const Triangles& of_b) {
  TriangleBounds bounds;
  bounds.uncovered.resize(a.triangles.size());
  for (const TexturedTriangle& t : a.triangles) bounds.upper.push_back(of_b.has(t) ? 0 : HUGE_VAL);
  return bounds;
}

}  // namespace

TriangleBounds bounds_of_equal(const TexturedMesh& a, const TexturedMesh& b) {
  return bounds_of_equal(a, Triangles(b.triangles));
}

TriangleBounds bounds_left(const TriangleBounds& known, const TexturedMesh& a, const TexturedMesh& b,
                           const TexturedMesh& new_a, const TexturedMesh& new_b) {
  const Triangles of_new_b(new_b.triangles);
  std::optional<Triangles> before;  // those of A, where the new ones are others
  if (!(a == new_a)) before.emplace(a.triangles);
  TriangleBounds left = bounds_of_equal(new_a, of_new_b);
  Changes changes(b, new_b, of_new_b);
  for (std::size_t i = 0; i < new_a.triangles.size(); ++i) {
    if (left.upper[i] == 0) continue;
    const std::size_t same = before ? before->find(new_a.triangles[i]) : i;
    if (same == no_index || !changes.leave(new_a.triangles[i], known.upper[same], known.uncovered[same])) continue;
    left.upper[i] = known.upper[same];
    left.uncovered[i] = known.uncovered[same];
  }
  return left;
}

}  // namespace meshbound
