// SPDX-License-Identifier: MIT
/// The vertices of two placed models in one frame, and exact predicates of their positions.
///
///
/// Degenerate positions are resolved by simulation of simplicity (Edelsbrunner, Muecke, "Simulation of Simplicity", ACM
/// Trans. Graph. 9(1), 1990): side 0 is moved by (e1, e2, e3), each infinitely smaller than the one before it. As both
/// models are closed and a motion of the whole changes nothing within a model, this is enough: a determinant of points
/// of both sides vanishes for every such motion only where a triangle has no area or two edges are parallel, and an
/// edge parallel to a triangle does not cross it.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/mapping.h"
#include "meshbound/pose.h"
#include "meshbound/stop_token.h"
#include "penetration/closed_model_data.h"
#include "penetration/exact_point.h"
#include "penetration/sparse_array.h"

namespace meshbound {

/// A vertex of side 0 or 1.
struct PairVertex {
  std::uint32_t side;
  std::uint32_t vertex;
};

class PlacedPair {
 public:
  /// Throws `InvalidInput` for poses that are no rigid motions.
  void place(const ClosedModel::Data& a, const Pose& pose_a, const ClosedModel::Data& b, const Pose& pose_b);

  /// Makes what runs on the pair from here on throw `Stopped` soon after this token says so.
  void stop_by(const StopToken& stop) {
    stop_ = stop;
    steps_ = 0;
  }
  /// Counts steps of about 100 ns and checks the token once in a while.
  void count_steps(std::uint64_t count) {
    constexpr std::uint64_t steps_between_looks = 1024;
    steps_ += count;
    if (steps_ < steps_between_looks) return;
    steps_ = 0;
    stop_.check();
  }
  void count_step() { count_steps(1); }

  [[nodiscard]] const ClosedModel::Data& model(std::uint32_t side) const { return *sides_[side].model; }
  /// The side with the larger model, and the mapping to its working frame from that of the other side's tree.
  [[nodiscard]] std::uint32_t tree_side() const { return tree_side_; }
  [[nodiscard]] const Mapping& tree_mapping() const { return tree_mapping_; }

  /// Coordinates in the local frame, of magnitude about 1 at most; off by at most `error` each.
  [[nodiscard]] const Vec3& local(PairVertex v) {
    Side& side = sides_[v.side];
    return side.points.has(v.vertex) ? side.points[v.vertex] : place_vertex(side, v.vertex);
  }
  /// A box around a triangle, rounding included; local.
  [[nodiscard]] const Box& box(std::uint32_t side, std::uint32_t triangle) {
    Side& own = sides_[side];
    return own.boxes.has(triangle) ? own.boxes[triangle] : place_box(side, triangle);
  }
  /// A box around the triangles of a leaf of the side's tree; local.
  [[nodiscard]] const Box& block_box(std::uint32_t side, std::uint32_t block) {
    Side& own = sides_[side];
    return own.block_boxes.has(block) ? own.block_boxes[block] : place_block_box(side, block);
  }
  [[nodiscard]] double error(std::uint32_t side) const { return sides_[side].error; }
  [[nodiscard]] double largest_error() const { return std::max(sides_[0].error, sides_[1].error); }
  [[nodiscard]] const ExactPoint& exact(PairVertex v);

  /// Conversion of local lengths and points to model units and world coordinates.
  [[nodiscard]] int exponent() const { return exponent_; }  ///< a local unit is 2^exponent model units
  [[nodiscard]] Eigen::Vector3d to_world(const Vec3& local) const;
  /// Local coordinates of numerator / denominator, which is in the unit of `exact`: rounded to nearest or a neighbour.
  [[nodiscard]] Vec3 to_local(const ExactPoint& numerator, const mpz_class& denominator);

  /// Sign of `volume_of` without any perturbation.
  [[nodiscard]] int orientation(PairVertex p, PairVertex q, PairVertex r, PairVertex s);
  /// The same; 0 also where doubles cannot tell.
  [[nodiscard]] int certain_orientation(PairVertex p, PairVertex q, PairVertex r, PairVertex s);
  /// 1 if vertex v of the other side lies on the side of triangle (p, q, r) of `side` that its normal points to, else
  /// -1; never 0 for a triangle with area.
  [[nodiscard]] int side_of_plane(std::uint32_t side, const Triangle& triangle, std::uint32_t vertex);
  /// `side_of_plane` for three vertices.
  [[nodiscard]] std::array<int, 3> sides_of_plane(std::uint32_t side, const Triangle& triangle,
                                                  const Triangle& vertices);
  /// Sign of `volume_of` for an edge of each side; 0 only if they are parallel.
  [[nodiscard]] int edge_turn(std::uint32_t p0, std::uint32_t q0, std::uint32_t p1, std::uint32_t q1);
  /// Whether edge (p, q) of the side other than `side` goes through its triangle, given that p and q lie on different
  /// sides of its plane.
  [[nodiscard]] bool goes_through(std::uint32_t side, const Triangle& triangle, std::uint32_t p, std::uint32_t q);

  /// Whether a point of a model, in its own coordinates, is outside a box of the other model; false where doubles
  /// cannot tell.
  [[nodiscard]] bool is_beyond(std::uint32_t side, const Vec3& p, const Eigen::AlignedBox3d& box) const;

  /// How many answers of `side_of_plane` the perturbation decided, as the vertex lies in the plane.
  [[nodiscard]] std::uint64_t perturbed_decisions() const { return perturbed_decisions_; }
  /// 1 where side 0 moves along an exact vector, -1 where it moves against it.
  [[nodiscard]] static int motion_along(const ExactPoint& vector) { return sign_of_first(vector, 1); }

  /// Notes a sign that was decided by integers elsewhere.
  void count_exact_decision() { ++exact_decisions_; }
  [[nodiscard]] std::uint64_t exact_decisions() const { return exact_decisions_; }

 private:
  struct Side {
    const ClosedModel::Data* model = nullptr;
    Pose pose;
    std::array<Vec3, 3> rows;  ///< rotation, scaled to the local unit
    Vec3 center;               ///< subtracted from model coordinates before the rotation
    Vec3 offset;               ///< local
    double error = 0;
    SparseArray<Vec3> points;
    SparseArray<Box> boxes;        ///< by triangle
    SparseArray<Box> block_boxes;  ///< by leaf
    SparseArray<ExactPoint> exact_points;
    std::optional<ExactMap> map;
  };

  const Vec3& place_vertex(Side& side, std::uint32_t vertex);
  const Box& place_box(std::uint32_t side, std::uint32_t triangle);
  const Box& place_block_box(std::uint32_t side, std::uint32_t block);
  void set_frame();
  void set_offset(Side& side);
  void prepare_exact();
  static int sign_of_first(const ExactPoint& normal, int sign);
  /// Sign of a computed `volume_of` of four vertices of this pair; 0 where its error could hide it.
  [[nodiscard]] int sign_beyond_error(double volume) const {
    if (volume > volume_error_) return 1;
    return volume < -volume_error_ ? -1 : 0;
  }

  std::array<Side, 2> sides_;
  std::uint32_t tree_side_ = 0;
  Mapping tree_mapping_;
  Vec3 origin_;              ///< world coordinates of the origin of the local frame
  double volume_error_ = 0;  ///< of `volume_of` computed for any four vertices, at most; local unit cubed
  int exponent_ = 0;
  int unit_ = 0;  ///< exact coordinates are multiples of 2^unit
  bool is_exact_ready_ = false;
  std::uint64_t exact_decisions_ = 0, perturbed_decisions_ = 0;
  StopToken stop_;
  std::uint64_t steps_ = 0;  ///< since the last look at `stop_`
};

}  // namespace meshbound
