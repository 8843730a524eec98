// SPDX-License-Identifier: MIT
#include "simplify/cover/sub_triangle_cover.h"

#include <algorithm>
#include <bit>
#include <optional>
#include <tuple>

#include "geometry/boxes.h"
#include "numeric/sort_unique.h"
#include "simplify/cover/reach_of_triangle.h"

namespace meshbound {
namespace {

/// A triangle is halved this often at most, into at most so many sub-triangles. Their cuts and those of covers count
/// together.
constexpr int max_halvings = 16;
constexpr std::size_t max_sub_triangles = 4096;

/// Sub-triangles at most where all faces near a triangle are candidates, so that its halves have no others. At 1e-6% of
/// the diagonal of a cube with rounded edges and holes (fandisk) 51 triangles that hardly any cuts could cover took 6.8
/// of 7.9 s.
constexpr std::size_t max_sub_triangles_among_same = 256;

}  // namespace

bool SubTriangleCover::covers(const TriangleCorners& corners, std::span<const std::uint32_t> around, double limit,
                              std::vector<std::uint32_t>& covering) {
  return covers({corners, 0, around}, nullptr, limit, covering);
}

bool SubTriangleCover::covers(const TriangleCorners& corners, const FaceBoxes& boxes, double limit,
                              std::vector<std::uint32_t>& covering) {
  return covers({corners, 0, {}}, &boxes, limit, covering);
}

bool SubTriangleCover::covers(const SubTriangle& whole, const FaceBoxes* boxes, double limit,
                              std::vector<std::uint32_t>& covering) {
  covering.clear();
  around_.clear();
  sub_triangles_.assign(1, whole);
  if (!covers_all(boxes, limit, covering)) return covering.clear(), false;
  sort_unique(covering);
  return true;
}

/// Large sub-triangles come first: a part that is not near any face is found before others are cut into small pieces.
bool SubTriangleCover::covers_all(const FaceBoxes* boxes, double limit, std::vector<std::uint32_t>& covering) {
  for (std::size_t i = 0, count = 1; i < sub_triangles_.size(); ++i) {
    if (boxes != nullptr)
      choose_nearest(sub_triangles_[i].corners, *boxes, limit);
    else
      choose_around(sub_triangles_[i], limit);
    const SubTriangle sub_triangle = sub_triangles_[i];
    if (!is_near_one_of(chosen_, centroid(sub_triangle.corners), limit)) return false;
    const bool has_all = choose_candidates(sub_triangle.corners, limit) && boxes == nullptr;
    cover_.begin(limit);
    for (const std::uint32_t f : chosen_) cover_.add(mesh_.triangle(f), f);
    const std::optional<FaceMask> used = cover_.cover_sub_triangle(sub_triangle.corners, sub_triangle.halvings);
    if (!used) return false;
    if (*used == 0) {
      const std::size_t max_count = has_all ? max_sub_triangles_among_same : max_sub_triangles;
      if (sub_triangle.halvings == max_halvings || ++count > max_count) return false;
      halve(sub_triangle);
    }
    for (FaceMask left = *used; left != 0; left &= left - 1) covering.push_back(cover_.face(std::countr_zero(left)));
  }
  return true;
}

bool SubTriangleCover::is_near_one_of(std::span<const std::uint32_t> faces, Vec3 point, double limit) const {
  return std::ranges::any_of(
      faces, [&](std::uint32_t f) { return squared_distance(mesh_.triangle(f), point) <= limit * limit; });
}

void SubTriangleCover::halve(const SubTriangle& sub_triangle) {
  std::size_t from = 0;
  double longest = -1;
  for (std::size_t i = 0; i < 3; ++i) {
    const double edge = squared_length(sub_triangle.corners[(i + 1) % 3] - sub_triangle.corners[i]);
    if (edge > longest) longest = edge, from = i;
  }
  const std::size_t to = (from + 1) % 3;
  const Vec3 middle = 0.5 * (sub_triangle.corners[from] + sub_triangle.corners[to]);
  for (const std::size_t end : {from, to}) {
    SubTriangle& half = sub_triangles_.emplace_back(sub_triangle);
    half.corners[end] = middle;
    ++half.halvings;
  }
}

/// Chooses the faces that meet the reach of a sub-triangle. Its halves look among these only, where they are many, but
/// not most of those it has looked among.
void SubTriangleCover::choose_around(SubTriangle& sub_triangle, double limit) {
  const ReachOfTriangle reach(sub_triangle.corners, limit);
  chosen_.clear();
  for (const std::uint32_t f : sub_triangle.around)
    if (reach.meets(mesh_.triangle(f))) chosen_.push_back(f);
  if (sub_triangle.around.size() > CandidateFaces::capacity && 2 * chosen_.size() <= sub_triangle.around.size())
    sub_triangle.around = around_.emplace_back(chosen_);
}

/// Chooses the faces nearest to the middle and to each corner, for each of these points a quarter of the candidates
/// that a cover may have. A point that is near none of them is near no face, unless more are around it than are looked
/// at.
void SubTriangleCover::choose_nearest(const TriangleCorners& corners, const FaceBoxes& boxes, double limit) {
  chosen_.clear();
  for (const Vec3 p : {centroid(corners), corners[0], corners[1], corners[2]}) {
    boxes.find_nearest(mesh_, p, limit, CandidateFaces::capacity / 4, nearest_);
    for (const FaceBoxes::NearFace& near : nearest_)
      if (std::find(chosen_.begin(), chosen_.end(), near.face) == chosen_.end()) chosen_.push_back(near.face);
  }
}

/// Chooses among those chosen, if they are too many, the faces that hold most corners, then those nearest to the
/// middle. Returns whether that is all of them.
bool SubTriangleCover::choose_candidates(const TriangleCorners& corners, double limit) {
  if (chosen_.size() <= CandidateFaces::capacity) return true;
  std::vector<std::tuple<std::ptrdiff_t, double, std::uint32_t>> ranked;
  for (const std::uint32_t f : chosen_) {
    const TriangleCorners face = mesh_.triangle(f);
    const auto lost = std::count_if(corners.begin(), corners.end(),
                                    [&](Vec3 p) { return squared_distance(face, p) > limit * limit; });
    ranked.emplace_back(lost, squared_distance(face, centroid(corners)), f);
  }
  std::nth_element(ranked.begin(), ranked.begin() + CandidateFaces::capacity, ranked.end());
  std::sort(ranked.begin(), ranked.begin() + CandidateFaces::capacity);
  chosen_.clear();
  for (std::size_t k = 0; k < CandidateFaces::capacity; ++k) chosen_.push_back(std::get<2>(ranked[k]));
  return false;
}

}  // namespace meshbound
