// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <map>
#include <vector>

#include "meshbound/bvh.h"
#include "meshbound/normal_deviation.h"
#include "meshbound/texture_deviation.h"
#include "meshbound/triangle_mesh.h"

namespace meshbound::tools {

/// Vertices of an original that a simplification must keep so that the texture does not move too far and faces do not
/// turn too much: more after each attempt that was measured. A vertex that stays where it is keeps its texture
/// coordinate.
class KeptVertices {
 public:
  /// `original` must outlive this.
  explicit KeptVertices(const TriangleMesh& original) : original_(original) {}

  /// By vertex; empty while none is locked.
  [[nodiscard]] const std::vector<bool>& locked() const { return locked_; }

  /// Notes where an attempt exceeds the tolerance: a is the original, whose tree is `original`, b the attempt. What a
  /// face of the attempt exceeds by is noted where the original is nearest to it in space, and at the vertices of the
  /// original that are nearest to the face: the point with the same texture coordinate may be anywhere. O(n log n).
  void learn(const TextureDeviation& deviation, const Bvh& original, const TriangleMesh& attempt);
  /// Notes which faces of the original turn too much in an attempt.
  void learn(const NormalDeviation& deviation);

  /// Locks, for each face of the attempts that exceeds, the corners of the original triangle where it does so most;
  /// after `gradual_rounds` of this, those of all triangles that exceed and all vertices noted; where these are locked
  /// already, rings of triangles around them. False where that locks nothing more, or after `max_rounds`. O(n rings).
  [[nodiscard]] bool tighten();

 private:
  static constexpr int gradual_rounds = 1, max_rounds = 12;
  struct Worst {
    double amount = -1;  ///< a length or an angle: they are compared only to choose where to begin
    std::uint32_t triangle = 0;
  };
  void note(std::uint32_t face, std::uint32_t triangle, double amount);
  void note_vertices_near(const std::vector<std::uint8_t>& exceeds, const TriangleMesh& attempt);
  [[nodiscard]] bool lock(std::uint32_t triangle);
  [[nodiscard]] bool lock_vertex(std::uint32_t vertex);
  [[nodiscard]] bool lock_around();

  const TriangleMesh& original_;
  std::vector<bool> locked_;
  std::map<std::uint32_t, Worst> worst_of_face_;  ///< of the last attempt
  std::vector<std::uint32_t> exceeding_;          ///< triangles of the original, of the last attempt
  std::vector<std::uint32_t> near_exceeding_;     ///< vertices of the original, of the last attempt
  int rounds_ = 0;
};

}  // namespace meshbound::tools
