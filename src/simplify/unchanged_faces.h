// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/vec3.h"
#include "meshbound/deviation_tracker.h"
#include "meshbound/triangle_mesh.h"

namespace meshbound {

/// Which original triangles are faces still: their corners are those of a face, bit for bit but for the sign of 0, in
/// any order. Such a pair is at distance 0 of each other, which needs no search. Immutable, safe to share.
class UnchangedFaces {
 public:
  static constexpr std::uint32_t none = SurfaceChange::no_triangle;

  /// Corners of faces and originals in the same frame. O((originals + faces) log faces).
  UnchangedFaces(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles,
                 std::span<const TrackedFace> faces);

  /// The index of a face with the corners of an original triangle, or `none`.
  [[nodiscard]] std::uint32_t face_of(std::uint32_t triangle) const { return face_of_[triangle]; }
  /// An original triangle with the corners of the face of this index, or `none`.
  [[nodiscard]] std::uint32_t triangle_of(std::uint32_t face) const { return triangle_of_[face]; }

 private:
  std::vector<std::uint32_t> face_of_, triangle_of_;
};

}  // namespace meshbound
