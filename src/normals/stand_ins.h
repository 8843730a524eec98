// SPDX-License-Identifier: MIT
/// Finds the faces of a mesh that stand for those of another one.
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "distance/shortcuts/triangle_table.h"
#include "geometry/position_table.h"
#include "meshbound/bvh.h"
#include "meshbound/normal_deviation.h"
#include "simplify/cover/box_tree.h"

namespace meshbound {

/// What is known of the face that stands for a face of A.
struct NearStandIns {
  double reach = NAN;    ///< it is one of those within this distance of the centroid; not a number: unknown
  double degrees = 180;  ///< it turns by no more
  [[nodiscard]] bool is_known() const { return !std::isnan(reach); }
};

/// The faces of B that have an area. Immutable, safe to share.
class StandIns {
 public:
  using Corners = std::array<Eigen::Vector3d, 3>;

  /// Distances to faces of B that differ by no more than `tie` count as equal. Throws `InvalidInput` where no face has
  /// an area. O(n log n).
  StandIns(const MeshView& b, double tie, int threads);

  /// Makes what is known of the faces of A from `begin` on complete. Those without area stay unknown.
  void complete(const MeshView& a, std::size_t begin, std::span<NearStandIns> near) const;
  /// The turns of these faces: of those above the tolerance, of the first that turns most, and of some others.
  [[nodiscard]] std::vector<FaceTurn> turns(const MeshView& a, std::size_t begin, std::span<const NearStandIns> near,
                                            double tolerance) const;
  /// Appends the faces that the other mesh does not have. O(n).
  void add_others(const StandIns& other, std::vector<Corners>& faces) const;

 private:
  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(normals_.size()); }
  [[nodiscard]] Corners corners(std::uint32_t face) const {
    return {mesh_.vertices[3 * face], mesh_.vertices[3 * face + 1], mesh_.vertices[3 * face + 2]};
  }
  [[nodiscard]] Eigen::AlignedBox3d box(std::uint32_t face) const;
  [[nodiscard]] bool has(const Corners& corners, const Eigen::Vector3d& normal) const;
  [[nodiscard]] FaceTurn turn_of(const SurfacePoint& middle, const Eigen::Vector3d& normal, double reach) const;

  TriangleMesh mesh_;  ///< of these faces: none shares a vertex with another
  std::vector<Eigen::Vector3d> normals_;
  std::vector<std::uint32_t> source_;  ///< their numbers in B
  std::vector<Vec3> positions_;
  std::optional<PositionTable> vertex_at_;
  std::optional<TriangleTable> face_at_;
  std::optional<Bvh> tree_;
  std::optional<BoxTree> boxes_;
  double tie_;
};

/// Whether a triangle is within this distance of a point, as `StandIns` decides it.
[[nodiscard]] bool is_within(const StandIns::Corners& corners, const Eigen::Vector3d& p, double reach);

/// The centroid of a face.
[[nodiscard]] SurfacePoint middle_of(const MeshView& mesh, std::size_t face);

}  // namespace meshbound
