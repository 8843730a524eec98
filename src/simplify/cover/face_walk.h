// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "simplify/cover/forward_cover.h"
#include "simplify/cover/prepared_faces.h"

namespace meshbound {

/// Covers an original triangle by walking over the mesh below it: a piece is cut where it passes from a face to the
/// next one, and what lies beyond is left to that one. Two or three cuts do where a search that knows nothing of
/// neighbours (`ForwardCover`) takes five to ten (ten meshes at 0.1%). Not thread-safe.
///
/// Where cuts are made is a guess. A face covers a piece when it is within the tolerance of all of its corners, as the
/// distance to a triangle is convex, and the pieces are the triangle: they share the points at which they were cut. The
/// displacement of rounded points is part of the slack of the proof, as for `ForwardCover`.
class FaceWalk {
 public:
  using Corners = std::array<Vec3, 3>;

  /// The mesh may change. Both must outlive this.
  FaceWalk(const ArrayMesh& mesh, PreparedFaces& prepared) : mesh_(mesh), prepared_(prepared) {}

  /// True: `faces` are some that `triangle` is near, as `CandidateFaces` tells for a tolerance and coordinates of at
  /// most this magnitude. The walk begins at `start` and takes faces for which `is_usable` is true. False says nothing,
  /// and `faces` are none.
  template <class Usable>
  [[nodiscard]] bool covers(const Corners& triangle, std::uint32_t start, double tolerance, double magnitude,
                            const Usable& is_usable, std::vector<std::uint32_t>& faces) {
    faces.clear();
    if (!begin(triangle, start, tolerance, magnitude)) return false;
    for (int steps = 0; !pieces_.empty(); ++steps)
      if (steps == max_steps || !is_usable(pieces_.back().face) || !step(faces)) return faces.clear(), false;
    return true;
  }

 private:
  static constexpr std::size_t max_cuts = 48, max_corners = 12;
  static_assert(max_cuts <= ForwardCover::deepest_cut);
  /// Steps from piece to piece: a triangle that so many faces do not cover is better tried in another way.
  static constexpr int max_steps = 32;

  /// A convex polygon, by its corners in `points_`.
  struct Piece {
    std::uint32_t face = 0;    ///< the one to try
    std::uint8_t entered = 3;  ///< the side of it that the piece was cut off at; 3: none
    std::uint8_t count = 0;
    std::array<std::uint8_t, max_corners> corners{};
  };
  [[nodiscard]] bool begin(const Corners& triangle, std::uint32_t start, double tolerance, double magnitude);
  [[nodiscard]] bool step(std::vector<std::uint32_t>& faces);
  [[nodiscard]] bool cut(Piece& piece, const FacePlanes& planes, std::size_t side);
  [[nodiscard]] bool split(Piece& piece, Piece& beyond, const FacePlanes& planes);
  [[nodiscard]] bool holds(const Piece& piece);

  const ArrayMesh& mesh_;
  PreparedFaces& prepared_;
  double tolerance_ = 0, rim_ = 0;
  std::vector<Piece> pieces_;  ///< still to be covered
  std::size_t point_count_ = 0;
  std::array<Vec3, 3 + 2 * max_cuts> points_;
  std::array<FacePlanes::Values, 3 + 2 * max_cuts> at_;  ///< by point: where it is, seen from the face being tried
  std::array<double, max_corners> level_{};  ///< of the corners of a piece being split: beyond where positive
};

}  // namespace meshbound
