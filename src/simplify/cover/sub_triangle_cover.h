// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "geometry/triangle_corners.h"
#include "simplify/cover/face_boxes.h"
#include "simplify/cover/forward_cover.h"
#include "simplify/mesh/array_mesh.h"

namespace meshbound {

/// Covers an original triangle that lies near many faces, or needs many cuts: it is halved into sub-triangles, each
/// with candidates of its own. Not thread-safe.
class SubTriangleCover {
 public:
  /// Both must outlive this. The candidates that `cover` has are lost.
  SubTriangleCover(const ArrayMesh& mesh, ForwardCover& cover) : mesh_(mesh), cover_(cover) {}

  /// True: `covering` are some of the faces `around` that together hold a triangle within `limit`, as `CandidateFaces`
  /// tells. False says nothing, and `covering` are none.
  [[nodiscard]] bool covers(const TriangleCorners& corners, std::span<const std::uint32_t> around, double limit,
                            std::vector<std::uint32_t>& covering);
  /// As above, by faces of `boxes`. For each sub-triangle it looks at the nearest ones only: made for thousands of near
  /// faces.
  [[nodiscard]] bool covers(const TriangleCorners& corners, const FaceBoxes& boxes, double limit,
                            std::vector<std::uint32_t>& covering);
  /// Whether one of these faces is within `limit` of a point, as computed.
  [[nodiscard]] bool is_near_one_of(std::span<const std::uint32_t> faces, Vec3 point, double limit) const;

 private:
  struct SubTriangle {
    TriangleCorners corners;
    int halvings = 0;
    std::span<const std::uint32_t> around;  ///< faces, among them those that meet its reach, unless boxes find these
  };
  [[nodiscard]] bool covers(const SubTriangle& whole, const FaceBoxes* boxes, double limit,
                            std::vector<std::uint32_t>& covering);
  [[nodiscard]] bool covers_all(const FaceBoxes* boxes, double limit, std::vector<std::uint32_t>& covering);
  void halve(const SubTriangle& sub_triangle);
  void choose_around(SubTriangle& sub_triangle, double limit);
  void choose_nearest(const TriangleCorners& corners, const FaceBoxes& boxes, double limit);
  [[nodiscard]] bool choose_candidates(const TriangleCorners& corners, double limit);

  const ArrayMesh& mesh_;
  ForwardCover& cover_;
  std::vector<SubTriangle> sub_triangles_;
  std::deque<std::vector<std::uint32_t>> around_;  ///< of sub-triangles; not moved as it grows
  std::vector<std::uint32_t> chosen_;
  std::vector<FaceBoxes::NearFace> nearest_;
};

}  // namespace meshbound
