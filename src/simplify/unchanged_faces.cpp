// SPDX-License-Identifier: MIT
#include "simplify/unchanged_faces.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "simplify/tracker_impl.h"

namespace meshbound {
namespace {

/// Equal for equal positions: adding 0 turns -0 into 0. The factors are odd and have no pattern.
std::uint64_t hash_of(const Vec3& p) {
  std::uint64_t hash = 0;
  for (const double x : {p.x, p.y, p.z}) {
    hash = (hash ^ std::bit_cast<std::uint64_t>(x + 0.0)) * 0x9e3779b97f4a7c15;
    hash ^= hash >> 29;
  }
  return hash * 0xbf58476d1ce4e5b9;
}

/// One hash for all orders of the corners.
std::uint64_t hash_of(const FaceCorners& corners) {
  return hash_of(corners[0]) + hash_of(corners[1]) + hash_of(corners[2]);
}

bool same_corners(const FaceCorners& a, const FaceCorners& b) {
  return std::is_permutation(a.begin(), a.end(), b.begin(),
                             [](const Vec3& p, const Vec3& q) { return p.x == q.x && p.y == q.y && p.z == q.z; });
}

}  // namespace

UnchangedFaces::UnchangedFaces(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles,
                               std::span<const TrackedFace> faces)
    : face_of_(triangles.size(), none), triangle_of_(faces.size(), none) {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> by_hash;
  by_hash.reserve(faces.size());
  for (std::uint32_t i = 0; i < faces.size(); ++i) by_hash.emplace_back(hash_of(corners_of(faces[i])), i);
  std::sort(by_hash.begin(), by_hash.end());
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const Triangle& c = triangles[t];
    const FaceCorners corners{vertices[c[0]], vertices[c[1]], vertices[c[2]]};
    const std::uint64_t hash = hash_of(corners);
    for (auto it = std::lower_bound(by_hash.begin(), by_hash.end(), std::pair{hash, std::uint32_t{0}});
         it != by_hash.end() && it->first == hash; ++it) {
      if (!same_corners(corners, corners_of(faces[it->second]))) continue;
      face_of_[t] = it->second;
      if (triangle_of_[it->second] == none) triangle_of_[it->second] = t;
      break;
    }
  }
}

}  // namespace meshbound
