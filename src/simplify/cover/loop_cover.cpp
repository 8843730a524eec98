// SPDX-License-Identifier: MIT
#include "simplify/cover/loop_cover.h"

namespace meshbound {
namespace {

/// Points are told to be within a face's sides only when they are so by this share of the tolerance: far more than the
/// planes are off.
constexpr double inner_share = 0.5;

}  // namespace

void LoopCover::forget() {
  ++round_;
  prepared_.forget();
}

void LoopCover::set_tolerance(double tolerance, double magnitude) {
  tolerance_ = tolerance;
  rim_ = inner_share * tolerance;
  is_accurate_ = tolerance > CandidateFaces::rounding_slack(magnitude);
}

bool LoopCover::is_near(std::uint32_t face, Vec3 point) {
  Position position;
  return begin({face, false}, point, position);
}

/// False where the face does not hold the point, or where the tolerance is so small that the rounding of plane
/// equations matters to `holds`.
bool LoopCover::begin(const Start& start, Vec3 point, Position& position) {
  if (!is_accurate_ || start.face == no_index) return false;
  const FacePlanes& planes = prepared_.planes(start.face, tolerance_);
  if (!planes.are_accurate) return false;
  position = {start.face, 3, point, planes.at(point)};
  return holds(start.face, position.at, point);
}

/// Goes on to the face across the side that the way to `end` leaves first. They pass halfway between the planes that
/// the two faces have through their edge: where they meet in a valley, both are nearest there. False where they do not
/// both hold the point.
bool LoopCover::pass(Position& position, Vec3 end, const FacePlanes::Values& at_end) {
  std::size_t side = 3;
  double share = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    const double from = position.at[PlaneBlock::sides + k], to = at_end[PlaneBlock::sides + k];
    if (k == position.entered || !(to > 0)) continue;
    const double leaves = from < 0 ? from / (from - to) : 0;
    if (leaves < share) share = leaves, side = k;
  }
  if (side == 3) return false;
  const Corner twin = mesh_.twin(3 * position.face + static_cast<Corner>(side));
  if (twin == no_index) return false;
  const std::uint32_t next = twin / 3;
  const FacePlanes& across = prepared_.planes(next, tolerance_);
  if (!across.are_accurate) return false;
  const std::size_t entered = twin % 3;
  const auto level = [&](const FacePlanes::Values& at, Vec3 p) {
    return at[PlaneBlock::sides + side] - across.at(PlaneBlock::sides + entered, p);
  };
  const double level_here = level(position.at, position.point), level_at_end = level(at_end, end);
  if (level_at_end > 0) share = level_here < 0 ? level_here / (level_here - level_at_end) : 0;
  const Vec3 point = position.point + share * (end - position.point);
  const FacePlanes::Values at_point = across.at(point);
  if (!holds(next, at_point, point)) return false;
  if (share > 0 && !holds(position.face, prepared_.planes(position.face, tolerance_).at(point), point)) return false;
  position = {next, entered, point, at_point};
  return true;
}

/// Whether a face is within the tolerance of a point. A point that is beyond one side, and further within the other two
/// than it is beyond that one, is nearest to that side: its distance follows from the planes.
///
/// Rounding. Each plane is off by `plane_slack` tolerances and a fifth of `rounding_slack` at most, a distance from two
/// of them by 1.42 times that. With what is taken off the square it is within what `CandidateFaces` promises.
bool LoopCover::holds(std::uint32_t face, const FacePlanes::Values& at, Vec3 p) {
  const auto& [height, a, b, c] = at;
  const double beyond = std::max(std::max(a, b), c);
  if (!(std::max(std::abs(height), beyond) <= tolerance_)) return false;
  const double squared = tolerance_ * tolerance_, squared_by_planes = squared * (1 - 2 * CandidateFaces::plane_slack);
  const double second = std::max(std::min(a, b), std::min(std::max(a, b), c));
  if (beyond <= 0) return height * height <= squared_by_planes;
  if (second <= -beyond - rim_) return height * height + beyond * beyond <= squared_by_planes;
  return prepared_.triangle(face).is_within(p, squared);
}

void LoopCover::append(const Walk& walk, bool forward) {
  for (std::size_t i = 0; i < walk.count; ++i) append(walk.faces[forward ? i : walk.count - 1 - i]);
}

void LoopCover::list_faces(std::vector<std::uint32_t>& faces) const {
  for (std::size_t i = 0; i < loop_size_; ++i)
    if (std::find(faces.begin(), faces.end(), loop_[i]) == faces.end()) faces.push_back(loop_[i]);
}

/// Whether the loop around triangle `t` can be contracted.
bool LoopCover::contracts(std::uint32_t t) {
  const auto first_with = [&](const auto& may_go) {
    std::size_t before = loop_size_ - 1, i = 0;
    for (; i < loop_size_; before = i++)
      if (may_go(loop_[before], loop_[i], loop_[i + 1 == loop_size_ ? 0 : i + 1])) break;
    return i;
  };
  while (loop_size_ > 2) {
    std::size_t gone = first_with(
        [](std::uint32_t before, std::uint32_t face, std::uint32_t after) { return before == after || face == after; });
    if (gone == loop_size_)
      gone = first_with([&](std::uint32_t before, std::uint32_t face, std::uint32_t after) {
        return have_near_vertex({before, face, after}, t);
      });
    if (gone == loop_size_) return false;
    std::copy(loop_.begin() + gone + 1, loop_.begin() + loop_size_, loop_.begin() + gone);
    --loop_size_;
  }
  return true;  // the ends of two parts are in both N
}

/// Whether these faces have a vertex in common that is within the tolerance of triangle `t`.
bool LoopCover::have_near_vertex(const std::array<std::uint32_t, 3>& faces, std::uint32_t t) const {
  const auto has = [&](std::uint32_t face, std::uint32_t vertex) {
    return mesh_.vertex(3 * face) == vertex || mesh_.vertex(3 * face + 1) == vertex ||
           mesh_.vertex(3 * face + 2) == vertex;
  };
  for (Corner c = 3 * faces[0]; c < 3 * faces[0] + 3; ++c) {
    const std::uint32_t vertex = mesh_.vertex(c);
    if (!has(faces[1], vertex) || !has(faces[2], vertex)) continue;
    const Vec3 p = vertices_[triangles_[t][0]], q = vertices_[triangles_[t][1]], r = vertices_[triangles_[t][2]];
    if (PreparedTriangle({p, q - p, r - p}).is_within(mesh_.position(vertex), tolerance_ * tolerance_)) return true;
  }
  return false;
}

}  // namespace meshbound
