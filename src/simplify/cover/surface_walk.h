// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "simplify/cover/candidate_faces.h"
#include "simplify/cover/prepared_faces.h"

namespace meshbound {

/// A walk straight to a point, from face to face of the soup below the way. Where it passes from one to the next, both
/// are within the tolerance of the point of the way that it has reached, as `CandidateFaces` tells; so each part of the
/// way is within the tolerance of one face, as the distance to a triangle is convex. Not thread-safe.
///
/// A soup tells `corners(f)` of face f and `neighbour(f, k)`, the face across its edge from corner k, or `no_index`.
template <class Soup>
class SurfaceWalk {
 public:
  /// The faces must outlive this.
  explicit SurfaceWalk(PreparedFaces<Soup>& faces) : prepared_(faces) {}

  /// Sets the distance within which faces hold points. No coordinate may be larger than `magnitude`.
  void set_tolerance(double tolerance, double magnitude) {
    tolerance_ = tolerance;
    rim_ = inner_share * tolerance;
    is_accurate_ = tolerance > CandidateFaces::rounding_slack(magnitude);
  }

  /// Whether the face is within the tolerance of the point: then the walk begins there. False as well where the
  /// tolerance is so small that the rounding of plane equations matters.
  [[nodiscard]] bool begin(std::uint32_t face, Vec3 point) {
    if (!is_accurate_ || face == no_index) return false;
    const FacePlanes& planes = prepared_.planes(face, tolerance_);
    if (!planes.are_accurate) return false;
    face_ = face, entered_ = no_side;
    point_ = point;
    at_point_ = planes.at(point);
    return holds(face, at_point_, point);
  }
  /// Whether the face that the walk has reached is within the tolerance of the end.
  [[nodiscard]] bool reaches(Vec3 end) {
    at_end_ = prepared_.planes(face_, tolerance_).at(end);
    return holds(face_, at_end_, end);
  }
  /// Goes on, once `reaches` is false, to the face across the side that the way to that end leaves first. They pass
  /// halfway between the planes that the two faces have through their edge: where they meet in a valley, both are
  /// nearest there. False where they do not both hold `point()`.
  [[nodiscard]] bool pass(Vec3 end) {
    const auto [side, leaves] = first_side_left();
    if (side == no_side) return false;
    const std::uint32_t next = prepared_.soup().neighbour(face_, side);
    if (next == no_index) return false;
    const FacePlanes& across = prepared_.planes(next, tolerance_);
    if (!across.are_accurate) return false;
    const std::size_t entered = side_towards(next, face_);
    const double level = at_point_[PlaneBlock::sides + side] - across.at(PlaneBlock::sides + entered, point_),
                 level_at_end = at_end_[PlaneBlock::sides + side] - across.at(PlaneBlock::sides + entered, end);
    const double share = level_at_end > 0 ? (level < 0 ? level / (level - level_at_end) : 0) : leaves;
    const Vec3 before = point_;
    point_ = before + share * (end - before);
    at_point_ = across.at(point_);
    if (!holds(next, at_point_, point_)) return false;
    if (share > 0 && !holds(face_, prepared_.planes(face_, tolerance_).at(point_), point_)) return false;
    face_ = next, entered_ = entered;
    return true;
  }
  /// The squared distance of `point()` from the face, as its planes tell.
  [[nodiscard]] double squared_distance() const {
    const auto& [height, a, b, c] = at_point_;
    const double beyond = std::max(std::max(std::max(a, b), c), 0.0);
    return height * height + beyond * beyond;
  }
  [[nodiscard]] std::uint32_t face() const { return face_; }
  [[nodiscard]] Vec3 point() const { return point_; }

 private:
  static constexpr std::size_t no_side = 3;
  /// Points are told to be within a face's sides only when they are so by this share of the tolerance: far more than
  /// the planes are off.
  static constexpr double inner_share = 0.5;

  struct Leaving {
    std::size_t side;
    double share;  ///< of the way
  };
  [[nodiscard]] Leaving first_side_left() const {
    Leaving first{no_side, 1};
    for (std::size_t k = 0; k < 3; ++k) {
      const double from = at_point_[PlaneBlock::sides + k], to = at_end_[PlaneBlock::sides + k];
      if (k == entered_ || !(to > 0)) continue;
      const double share = from < 0 ? from / (from - to) : 0;
      if (share < first.share) first = {k, share};
    }
    return first;
  }
  [[nodiscard]] std::size_t side_towards(std::uint32_t face, std::uint32_t other) const {
    std::size_t k = 0;
    while (k < 2 && prepared_.soup().neighbour(face, k) != other) ++k;
    return k;
  }
  /// Whether a face is within the tolerance of a point. A point that is beyond one side, and further within the other
  /// two than it is beyond that one, is nearest to that side: its distance follows from the planes.
  ///
  /// Rounding. Each plane is off by `plane_slack` tolerances and a fifth of `rounding_slack` at most, a distance from
  /// two of them by 1.42 times that. With what is taken off the square it is within what `CandidateFaces` promises.
  [[nodiscard]] bool holds(std::uint32_t face, const FacePlanes::Values& at, Vec3 p) {
    const auto& [height, a, b, c] = at;
    const double beyond = std::max(std::max(a, b), c);
    if (!(std::max(std::abs(height), beyond) <= tolerance_)) return false;
    const double squared = tolerance_ * tolerance_, squared_by_planes = squared * (1 - 2 * CandidateFaces::plane_slack);
    const double second = std::max(std::min(a, b), std::min(std::max(a, b), c));
    if (beyond <= 0) return height * height <= squared_by_planes;
    if (second <= -beyond - rim_) return height * height + beyond * beyond <= squared_by_planes;
    return prepared_.triangle(face).is_within(p, squared);
  }

  PreparedFaces<Soup>& prepared_;
  double tolerance_ = 0, rim_ = 0;
  bool is_accurate_ = false;
  std::uint32_t face_ = 0;
  std::size_t entered_ = no_side;  ///< the side of it that was passed last
  Vec3 point_;
  FacePlanes::Values at_point_{}, at_end_{};  ///< as the face sees them
};

}  // namespace meshbound
