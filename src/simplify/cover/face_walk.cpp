// SPDX-License-Identifier: MIT
#include "simplify/cover/face_walk.h"

#include <algorithm>

namespace meshbound {
namespace {

/// A piece is not cut for what reaches beyond a side by less than this share of the tolerance: there it is within the
/// tolerance unless it is high as well. With 0.1 runs take 1% longer.
constexpr double overhang_share = 0.5;

}  // namespace

/// False where the tolerance is so small that the rounding of plane equations matters to `holds`.
bool FaceWalk::begin(const Corners& triangle, std::uint32_t start, double tolerance, double magnitude) {
  tolerance_ = tolerance;
  rim_ = overhang_share * tolerance;
  std::copy(triangle.begin(), triangle.end(), points_.begin());
  point_count_ = 3;
  pieces_.assign(1, {start, 3, 3, {0, 1, 2}});
  return tolerance > CandidateFaces::rounding_slack(magnitude);
}

/// Leaves what lies beyond the face to the faces there. False where the face does not hold the rest.
bool FaceWalk::step(std::vector<std::uint32_t>& faces) {
  Piece piece = pieces_.back();
  pieces_.pop_back();
  const FacePlanes planes = prepared_.planes(piece.face, tolerance_);  // the entry may get another face
  if (!planes.are_accurate) return false;
  FacePlanes::Values largest;
  largest.fill(-HUGE_VAL);
  for (std::size_t i = 0; i < piece.count; ++i) {
    const FacePlanes::Values at = at_[piece.corners[i]] = planes.at(points_[piece.corners[i]]);
    for (std::size_t k = 0; k < at.size(); ++k) largest[k] = at[k] > largest[k] ? at[k] : largest[k];
  }
  for (std::size_t side = 0; side < 3; ++side)
    if (side != piece.entered && largest[PlaneBlock::sides + side] > rim_ && !cut(piece, planes, side)) return false;
  if (piece.count == 0) return true;
  if (!holds(piece)) return false;
  if (std::find(faces.begin(), faces.end(), piece.face) == faces.end()) faces.push_back(piece.face);
  return true;
}

/// Leaves what lies beyond a side to the face across it, if there is one and that is worth it. Pieces are cut halfway
/// between the planes that the two faces have through their edge: where they meet in a valley, both are nearest there.
/// The face across need not be usable; as it shares two vertices with one that is, no other thread changes it.
bool FaceWalk::cut(Piece& piece, const FacePlanes& planes, std::size_t side) {
  double largest = -HUGE_VAL, least = HUGE_VAL;
  for (std::size_t i = 0; i < piece.count; ++i) {
    const double beyond = at_[piece.corners[i]][PlaneBlock::sides + side];
    largest = std::max(largest, beyond);
    least = std::min(least, beyond);
  }
  if (largest <= rim_) return true;
  const Corner twin = mesh_.twin(3 * piece.face + static_cast<Corner>(side));
  if (twin == no_index) return true;
  Piece beyond{twin / 3, static_cast<std::uint8_t>(twin % 3), 0, {}};
  if (least >= -rim_) {
    beyond.count = piece.count, beyond.corners = piece.corners;
    pieces_.push_back(beyond);
    piece.count = 0;
    return true;
  }
  const FacePlanes& across = prepared_.planes(beyond.face, tolerance_);
  for (std::size_t i = 0; i < piece.count; ++i) {
    const std::size_t corner = piece.corners[i];
    level_[i] = at_[corner][PlaneBlock::sides + side] - across.at(PlaneBlock::sides + beyond.entered, points_[corner]);
  }
  if (!split(piece, beyond, planes)) return false;
  if (beyond.count > 0) pieces_.push_back(beyond);
  return true;
}

/// Cuts a piece in two where `level_` changes its sign. Rounding may have it change more than twice.
bool FaceWalk::split(Piece& piece, Piece& beyond, const FacePlanes& planes) {
  if (piece.count + 2U > max_corners) return false;
  Piece kept{piece.face, piece.entered, 0, {}};
  int changes = 0;
  for (std::size_t i = 0; i < piece.count; ++i) {
    const std::size_t j = i + 1U == piece.count ? 0 : i + 1;
    Piece& side = level_[i] <= 0 ? kept : beyond;
    side.corners[side.count++] = piece.corners[i];
    if ((level_[i] <= 0) == (level_[j] <= 0)) continue;
    if (++changes > 2 || point_count_ == points_.size()) return false;
    const Vec3 p = points_[piece.corners[i]], q = points_[piece.corners[j]];
    const Vec3 between = p + (level_[i] / (level_[i] - level_[j])) * (q - p);
    points_[point_count_] = between;
    at_[point_count_] = planes.at(between);
    kept.corners[kept.count++] = beyond.corners[beyond.count++] = static_cast<std::uint8_t>(point_count_++);
  }
  piece = kept;
  return true;
}

/// Whether the face is within the tolerance of all corners of the piece. A point that is beyond one side, and further
/// within the other two than it is beyond that one, is nearest to that side: its distance follows from the planes.
///
/// Rounding. Each plane is off by `plane_slack` tolerances and a fifth of `rounding_slack` at most, a distance from two
/// of them by 1.42 times that. With what is taken off the square it is within what `CandidateFaces` promises. The rim
/// is wider than all of this.
bool FaceWalk::holds(const Piece& piece) {
  const double squared = tolerance_ * tolerance_, squared_by_planes = squared * (1 - 2 * CandidateFaces::plane_slack);
  return std::all_of(piece.corners.begin(), piece.corners.begin() + piece.count, [&](std::size_t corner) {
    const auto& [height, a, b, c] = at_[corner];
    const double beyond = std::max(std::max(a, b), c);
    const double second = std::max(std::min(a, b), std::min(std::max(a, b), c));
    if (beyond <= 0) return height * height <= squared_by_planes;
    if (second <= -beyond - rim_) return height * height + beyond * beyond <= squared_by_planes;
    return prepared_.triangle(piece.face).is_within(points_[corner], squared);
  });
}

}  // namespace meshbound
