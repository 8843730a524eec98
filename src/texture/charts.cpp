// SPDX-License-Identifier: MIT
#include "texture/charts.h"

#include <algorithm>
#include <cmath>

#include "geometry/boxes.h"
#include "numeric/simd.h"
#include "texture/chart_edges.h"

namespace meshbound {
namespace {

/// A triangle in the texture in single precision, counter-clockwise, from an origin near it. Lane k stands for a corner
/// and the edge from there to the next one; the last lane for the first again.
struct Outline {
  Outline(const ChartTriangle& t, const Eigen::Vector2d& origin) {
    const auto& uv = t.source->coordinates;
    const auto at = [&](std::size_t k) -> Eigen::Vector2f { return (uv[k] - origin).cast<float>(); };
    const Eigen::Vector2f a = at(0), b = at(t.turned ? 2 : 1), c = at(t.turned ? 1 : 2);
    u = Float4{a.x(), b.x(), c.x(), a.x()};
    v = Float4{a.y(), b.y(), c.y(), a.y()};
    along_u = Float4{b.x(), c.x(), a.x(), b.x()} - u;
    along_v = Float4{b.y(), c.y(), a.y(), b.y()} - v;
  }
  Float4 u, v, along_u, along_v;
};

/// Whether each edge of `a` seems to have some corner of `b` on its inner side. Rounding may decide.
bool seems_to_overlap(const Outline& a, const Outline& b) {
  const auto is_inside = [&](int corner) { return a.along_u * (b.v[corner] - a.v) > a.along_v * (b.u[corner] - a.u); };
  const auto has_inside = is_inside(0) | is_inside(1) | is_inside(2);
  return (has_inside[0] & has_inside[1] & has_inside[2]) != 0;
}

/// Between two boxes, as computed. Without branches: which way they go cannot be foretold.
double squared_distance(const Eigen::AlignedBox3d& a, const Eigen::AlignedBox3d& b) {
  return (a.min() - b.max()).cwiseMax(b.min() - a.max()).cwiseMax(0.0).squaredNorm();
}

/// The plane of a triangle in space.
struct Plane {
  explicit Plane(const TexturedTriangle& t)
      : at(t.corners[0]), normal((t.corners[1] - at).cross(t.corners[2] - at)), length(normal.norm()) {}

  /// Whether all of a triangle seems to lie farther than `distance` from the plane, on one side of it. Rounding may
  /// decide. False where the plane is none.
  [[nodiscard]] bool seems_apart_from(const TexturedTriangle& t, double distance) const {
    double lowest = HUGE_VAL, highest = -HUGE_VAL;
    for (const Eigen::Vector3d& p : t.corners) {
      const double height = normal.dot(p - at);
      lowest = std::min(lowest, height);
      highest = std::max(highest, height);
    }
    return std::max(lowest, -highest) > distance * length;
  }

  Eigen::Vector3d at, normal;
  double length;  ///< of the normal
};

/// The corner of `b` with a texture coordinate; 3 if there is none.
std::size_t corner_at(const TexturedTriangle& b, const Eigen::Vector2d& coordinate) {
  return static_cast<std::size_t>(std::find(b.coordinates.begin(), b.coordinates.end(), coordinate) -
                                  b.coordinates.begin());
}

/// An upper bound of the largest distance between corners with the same texture coordinates; absent where these differ.
std::optional<double> upper_at_equal_corners(const TexturedTriangle& a, const TexturedTriangle& b) {
  std::array<std::size_t, 3> equal{};
  for (std::size_t i = 0; i < 3; ++i) {
    equal[i] = corner_at(b, a.coordinates[i]);
    if (equal[i] == 3) return std::nullopt;
  }
  double upper = 0;
  for (std::size_t i = 0; i < 3; ++i) upper = std::max(upper, distance_bounds(a.corners[i], b.corners[equal[i]]).upper);
  return upper;
}

/// The box of a triangle in space, grown by `reach` and by more than rounding may take away.
Eigen::AlignedBox3d place_within_reach(const ChartTriangle& a, double reach) {
  const Eigen::AlignedBox3d place = place_of(*a.source);
  return grown(place,
               reach * (1 + 0x1p-40) + 0x1p-50 * place.max().cwiseAbs().cwiseMax(place.min().cwiseAbs()).maxCoeff());
}

ExactUnits units_of(const TexturedMesh& mesh) {
  ExactUnits units{no_bit, no_bit};
  for (const TexturedTriangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      for (const double x : t.coordinates[k]) units.texture = std::min(units.texture, lowest_bit(x));
      for (const double x : t.corners[k]) units.position = std::min(units.position, lowest_bit(x));
    }
  return units;
}

}  // namespace

ExactUnits common_units(const Charts& a, const Charts& b) {
  return {std::min(a.units().texture, b.units().texture), std::min(a.units().position, b.units().position)};
}

Eigen::AlignedBox3d box_in_texture(const TexturedTriangle& triangle) {
  return box_of(triangle.coordinates, triangle.material);
}

Eigen::AlignedBox3d place_of(const TexturedTriangle& triangle) { return box_of(triangle.corners); }

double distance_between(const Eigen::AlignedBox3d& a, const Eigen::AlignedBox3d& b) {
  const Eigen::Vector3d gap = (a.min() - b.max()).cwiseMax(b.min() - a.max()).cwiseMax(0.0);
  const double largest = gap.maxCoeff();
  return largest > 0 ? largest * (gap / largest).norm() : 0;
}

Charts::Charts(const TexturedMesh& mesh) : mesh_(mesh), units_(units_of(mesh)) {
  triangles_.reserve(mesh.triangles.size());
  for (const TexturedTriangle& t : mesh.triangles) {
    triangles_.push_back(chart_triangle(t, units_));
    triangles_.back().number = static_cast<std::uint32_t>(triangles_.size() - 1);
  }
  link_across_edges(triangles_);
  std::vector<Eigen::AlignedBox3d> with_area, in_texture, in_space;
  for (const ChartTriangle& t : triangles_) {
    const Eigen::AlignedBox3d box = box_in_texture(*t.source);
    places_.push_back(place_of(*t.source));
    with_area.push_back(t.chart == Chart::Area ? box : Eigen::AlignedBox3d());
    if (t.chart == Chart::Area) continue;
    without_area_.push_back(t.number);
    in_texture.push_back(box);
    in_space.push_back(places_.back());
  }
  with_area_.emplace(with_area, places_);
  if (with_area_->is_crowded()) hubs_ = Hubs(mesh.triangles, with_area);
  if (!hubs_.empty()) {
    rank_.resize(triangles_.size());
    for (std::uint32_t k = 0; k < rank_.size(); ++k) rank_[with_area_->in_texture().order()[k]] = k;
    for (const ChartTriangle& t : triangles_)
      if (hubs_.has(t.number)) with_area[t.number].setEmpty();
    with_area_.emplace(with_area, places_);
  }
  without_area_in_texture_.emplace(in_texture);
  without_area_in_space_.emplace(in_space);
}

/// Appends the triangles without an area in the texture whose boxes in a tree of them meet a box.
void Charts::find_without_area(const Eigen::AlignedBox3d& box, const BoxTree& tree,
                               std::vector<std::uint32_t>& found) const {
  const std::size_t before = found.size();
  tree.find(box, found);
  for (std::size_t i = before; i < found.size(); ++i) found[i] = without_area_[found[i]];
}

/// Sets `found` to the triangles with an area in the texture that may have coordinates of `a`; of those that share only
/// the coordinate of a hub with it, one for each place in space of the hub.
void Charts::find_with_area(const ChartTriangle& a, std::vector<std::uint32_t>& found) const {
  found.clear();
  with_area_->in_texture().find(box_in_texture(*a.source), found);
  hubs_.find(a.source->coordinates, a.source->material, found);
  hubs_.find_touching(a.source->coordinates, a.source->material, found);
  put_in_order(found);
}

/// Puts what was found by boxes and around hubs in the order of boxes in the texture, and drops what is there twice.
void Charts::put_in_order(std::vector<std::uint32_t>& found) const {
  if (hubs_.empty()) return;
  std::sort(found.begin(), found.end(), [this](std::uint32_t i, std::uint32_t j) { return rank_[i] < rank_[j]; });
  found.erase(std::unique(found.begin(), found.end()), found.end());
}

/// As `find_with_area`, with those that have no area in the texture.
void Charts::find_in_texture(const ChartTriangle& a, std::vector<std::uint32_t>& found) const {
  find_with_area(a, found);
  find_without_area(box_in_texture(*a.source), *without_area_in_texture_, found);
}

bool Charts::seems_to_meet_without_area(const ChartTriangle& a) const {
  return without_area_in_texture_->meets(box_in_texture(*a.source));
}

bool Charts::may_have_among_others(const ChartTriangle& a) const {
  std::vector<std::uint32_t> found;
  find_in_texture(a, found);
  return std::any_of(found.begin(), found.end(), [&](std::uint32_t i) { return triangles_[i].chart != Chart::Point; });
}

void Charts::find_near_without_area(const ChartTriangle& a, double reach, ChartCandidates& found) const {
  const Eigen::AlignedBox3d in_texture = box_in_texture(*a.source);
  find_with_area(a, found.indices);
  find_without_area(place_within_reach(a, reach), *without_area_in_space_, found.indices);
  for (const std::uint32_t i : found.indices)
    if (in_texture.intersects(box_in_texture(mesh_.triangles[i]))) found.near.push_back(&triangles_[i]);
}

void Charts::find_others(const ChartTriangle& a, ChartCandidates& found) const {
  found.others.clear();
  found.indices.clear();
  if (a.chart == Chart::Area) find_with_area(a, found.indices);
  find_without_area(box_in_texture(*a.source), *without_area_in_texture_, found.indices);
  std::vector<const ChartTriangle*> near = found.near;
  std::sort(near.begin(), near.end());
  for (const std::uint32_t i : found.indices)
    if (!std::binary_search(near.begin(), near.end(), &triangles_[i])) found.others.push_back(&triangles_[i]);
}

void Charts::find_candidates(const ChartTriangle& a, double reach, ChartCandidates& found) const {
  found.near.clear();
  found.others.clear();
  found.copy.reset();
  found.indices.clear();
  if (a.chart != Chart::Area) return find_near_without_area(a, reach, found);
  with_area_->find(box_in_texture(*a.source), place_within_reach(a, reach), found.indices);
  hubs_.find(a.source->coordinates, a.source->material, found.indices);
  put_in_order(found.indices);
  const Eigen::AlignedBox3d place = place_of(*a.source);
  const Plane plane(*a.source);
  const Eigen::Vector2d& origin = a.source->coordinates[0];
  const Outline outline(a, origin);
  const auto seems_to_share_area = [&](const ChartTriangle& b) {
    const Outline of_b(b, origin);
    return seems_to_overlap(outline, of_b) && seems_to_overlap(of_b, outline);
  };
  const auto seems_within_reach = [&](const ChartTriangle& b) {
    return squared_distance(places_[b.number], place) <= reach * reach && !plane.seems_apart_from(*b.source, reach) &&
           !Plane(*b.source).seems_apart_from(*a.source, reach);
  };
  for (const std::uint32_t i : found.indices) {
    const ChartTriangle& b = triangles_[i];
    if (!seems_within_reach(b) || !seems_to_share_area(b)) continue;
    found.near.push_back(&b);
    const std::optional<double> upper = upper_at_equal_corners(*a.source, *b.source);
    if (upper && *upper <= (found.copy ? found.copy->upper : reach)) found.copy = {&b, *upper};
  }
  if (found.copy) found.near.assign(1, found.copy->triangle);
}

}  // namespace meshbound
