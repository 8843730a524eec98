// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/position_table.h"
#include "geometry/prepared_triangle.h"
#include "geometry/triangle_corners.h"
#include "numeric/no_index.h"
#include "simplify/kernel/kernels.h"

namespace meshbound {

/// The planes of a face: [0] through the face, [1] to [3] through its sides, outward.
struct FacePlanes {
  using Values = std::array<double, PlaneBlock::planes>;
  Values x{}, y{}, z{}, offset{};
  /// Whether they are displaced by less than `CandidateFaces::plane_slack` tolerances near the face; else they are 0.
  bool are_accurate = false;

  [[nodiscard]] static FacePlanes of(const TriangleCorners& corners, double tolerance, const PlaneKernel& kernel);
  /// How far a point is above the face, and beyond each side of it.
  [[nodiscard]] Values at(Vec3 p) const {
    Values values;
    for (std::size_t k = 0; k < values.size(); ++k) values[k] = x[k] * p.x + y[k] * p.y + z[k] * p.z + offset[k];
    return values;
  }
  [[nodiscard]] double at(std::size_t plane, Vec3 p) const {
    return x[plane] * p.x + y[plane] * p.y + z[plane] * p.z + offset[plane];
  }
};

/// The faces of a soup that were asked for last, with what tests of points need of them. Not thread-safe.
template <class Soup>
class PreparedFaces {
 public:
  /// More than the faces around a star, so that few take the place of others.
  static constexpr std::size_t few = 128;

  /// `max_faces` are kept, a power of two. O(max_faces).
  explicit PreparedFaces(const Soup& soup, std::size_t max_faces = few) : soup_(soup), entries_(max_faces) {}

  /// Must be called when the soup has changed.
  void forget() { ++round_; }
  [[nodiscard]] const PreparedTriangle& triangle(std::uint32_t face) {
    Entry& at = entry(face);
    if (!at.has_triangle) {
      const auto& [a, b, c] = at.corners;
      at.triangle = PreparedTriangle({a, b - a, c - a});
      at.has_triangle = true;
    }
    return at.triangle;
  }
  [[nodiscard]] const FacePlanes& planes(std::uint32_t face, double tolerance) {
    Entry& at = entry(face);
    if (at.tolerance_of_planes != tolerance) {
      at.tolerance_of_planes = tolerance;
      at.planes = FacePlanes::of(at.corners, tolerance, kernel_);
    }
    return at.planes;
  }
  [[nodiscard]] const Soup& soup() const { return soup_; }

 private:
  struct Entry {
    std::uint32_t face = no_index;
    std::uint32_t round = 0;  ///< of `forget` when the corners were those of the face
    TriangleCorners corners{};
    bool has_triangle = false;
    double tolerance_of_planes = -1;  ///< negative: there are none
    PreparedTriangle triangle;
    FacePlanes planes;
  };
  Entry& entry(std::uint32_t face) {
    Entry& entry = entries_[face & (entries_.size() - 1)];
    if (entry.face != face || entry.round != round_) renew(entry, face);
    return entry;
  }
  /// What was made stays where the face is as it was.
  void renew(Entry& entry, std::uint32_t face) const {
    const TriangleCorners corners = soup_.corners(face);
    if (entry.face != face || !std::equal(corners.begin(), corners.end(), entry.corners.begin(), same_position)) {
      entry.face = face, entry.corners = corners;
      entry.has_triangle = false;
      entry.tolerance_of_planes = -1;
    }
    entry.round = round_;
  }

  const Soup soup_;
  PlaneKernel kernel_ = simplify_kernels().planes;
  std::uint32_t round_ = 1;
  std::vector<Entry> entries_;  ///< by number of the face, modulo their count
};

}  // namespace meshbound
