// SPDX-License-Identifier: MIT
#include "simplify/cover/hubs.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <tuple>
#include <utility>

#include "geometry/boxes.h"

namespace meshbound {
namespace {

/// Corners at one coordinate from which on it is a hub: there the triangles that a triangle is compared with would be
/// several times as many as elsewhere.
constexpr std::size_t many_corners = 64;

/// Triangles around a hub in one direction, on average, up to which directions tell them apart: of cards with one
/// texture all have the same.
constexpr double max_layers = 8;

/// Of an angle, radians: the difference of two doubles is rounded to its last place however small it is, so angles are
/// off by a few units of 1e-16.
constexpr double rounding_of_angles = 1e-12;

constexpr double half_turn = std::numbers::pi, full_turn = 2 * std::numbers::pi;

/// A corner of a triangle in the texture.
struct CornerThere {
  std::uint32_t material;
  Eigen::Vector2d at;
  std::uint32_t triangle;
  [[nodiscard]] auto key() const { return std::tuple(material, at.x(), at.y()); }
};

/// The corners of triangles with an area, those with the same coordinate one after the other.
std::vector<CornerThere> sorted_corners(std::span<const TexturedTriangle> triangles,
                                        std::span<const Eigen::AlignedBox3d> in_texture) {
  std::vector<CornerThere> corners;
  for (std::uint32_t i = 0; i < triangles.size(); ++i)
    if (!in_texture[i].isEmpty())
      for (const Eigen::Vector2d& at : triangles[i].coordinates) corners.push_back({triangles[i].material, at, i});
  std::sort(corners.begin(), corners.end(), [](const CornerThere& p, const CornerThere& q) {
    return std::pair(p.key(), p.triangle) < std::pair(q.key(), q.triangle);
  });
  return corners;
}

}  // namespace

/// Angles from a hub to the corners of a triangle that do not lie there.
struct Hubs::Directions {
  std::array<double, 3> angle = {HUGE_VAL, HUGE_VAL, HUGE_VAL};
  std::size_t count = 0;
  bool are_known = true;
};

Hubs::Directions Hubs::directions_from(const Eigen::Vector2d& hub, const Coordinates& t) {
  Directions directions;
  for (const Eigen::Vector2d& corner : t) {
    const Eigen::Vector2d way = corner - hub;
    if (way == Eigen::Vector2d::Zero()) continue;
    directions.are_known = directions.are_known && way.allFinite();
    directions.angle[directions.count++] = std::atan2(way.y(), way.x());
  }
  return directions;
}

/// The arc of all directions to points of a triangle but the hub; absent where the hub may lie inside of the triangle
/// or between its corners, as the corners do not part a half turn from the others then.
std::optional<Hubs::Arc> Hubs::arc_of(const Directions& directions) {
  std::array<double, 3> angle = directions.angle;
  const std::size_t count = directions.count;
  if (!directions.are_known || count == 0) return std::nullopt;
  for (const std::size_t k : {0, 1, 0})
    if (angle[k + 1] < angle[k]) std::swap(angle[k], angle[k + 1]);
  for (std::size_t k = 0; k < count; ++k) {  // from corner k all the way round to the one before it
    const std::size_t before = (k + count - 1) % count;
    const double turn = angle[before] - angle[k] + (k == 0 ? 0 : full_turn);
    if (turn < half_turn - rounding_of_angles) return Arc{angle[k], turn};
  }
  return std::nullopt;
}

Hubs::Hubs(std::span<const TexturedTriangle> triangles, std::span<const Eigen::AlignedBox3d> in_texture) {
  const std::vector<CornerThere> corners = sorted_corners(triangles, in_texture);
  std::vector<std::uint32_t> around;
  for (std::size_t first = 0, end = 0; first < corners.size(); first = end) {
    while (end < corners.size() && corners[end].key() == corners[first].key()) ++end;
    if (end - first < many_corners) continue;
    around.clear();
    for (std::size_t i = first; i < end; ++i)
      if (!has(corners[i].triangle)) around.push_back(corners[i].triangle);
    add_hub(corners[first].at, around, triangles, in_texture);
  }
  std::vector<Eigen::AlignedBox3d> boxes(hubs_.size());
  for (std::size_t h = 0; h < hubs_.size(); ++h)
    for (const Sector& sector : hubs_[h].sectors) boxes[h].extend(sector.box);
  boxes_.emplace(boxes);
}

void Hubs::add_hub(const Eigen::Vector2d& at, std::span<const std::uint32_t> around,
                   std::span<const TexturedTriangle> triangles, std::span<const Eigen::AlignedBox3d> in_texture) {
  Hub hub;
  hub.at = at;
  std::vector<std::pair<std::array<double, 3>, std::uint32_t>> places;
  for (const std::uint32_t i : around) {
    const TexturedTriangle& t = triangles[i];
    const std::optional<Arc> arc = arc_of(directions_from(at, t.coordinates));
    if (!arc) continue;
    hub.sectors.push_back({*arc, i, in_texture[i]});
    hub.max_turn = std::max(hub.max_turn, arc->turn);
    const auto corner =
        static_cast<std::size_t>(std::find(t.coordinates.begin(), t.coordinates.end(), at) - t.coordinates.begin());
    const Eigen::Vector3d& p = t.corners[corner];
    places.push_back({{p.x(), p.y(), p.z()}, i});
  }
  const double turns = std::accumulate(hub.sectors.begin(), hub.sectors.end(), 0.0,
                                       [](double sum, const Sector& sector) { return sum + sector.arc.turn; });
  if (hub.sectors.size() < many_corners || turns > max_layers * full_turn) return;
  hub.material = triangles[hub.sectors.front().triangle].material;
  is_around_.resize(triangles.size());
  for (const Sector& sector : hub.sectors) is_around_[sector.triangle] = true;
  std::stable_sort(hub.sectors.begin(), hub.sectors.end(),
                   [](const Sector& p, const Sector& q) { return p.arc.start < q.arc.start; });
  std::sort(places.begin(), places.end());
  for (std::size_t i = 0; i < places.size(); ++i)
    if (i == 0 || places[i].first != places[i - 1].first) hub.in_places.push_back(places[i].second);
  hubs_.push_back(std::move(hub));
}

/// Calls `visit(hub)` for the hubs whose triangles may have coordinates in a box.
template <class Visit>
void Hubs::for_each_near(const Eigen::AlignedBox3d& box, const Visit& visit) const {
  if (empty()) return;
  BoxTree::Search near(*boxes_, box);
  while (const std::optional<std::uint32_t> h = near.next()) visit(hubs_[*h]);
}

/// A point of `a`, whose box in the texture is `box`, and of a triangle around the hub lies in one direction from
/// there. Arcs are looked for as they are and a full turn away: the one of `a` begins anywhere in a full turn.
void Hubs::find_in(const Hub& hub, const Coordinates& a, const Eigen::AlignedBox3d& box,
                   std::vector<std::uint32_t>& found) {
  const Directions directions = directions_from(hub.at, a);
  if (directions.count == 0) return;  // `a` has no other coordinate
  const auto take = [&](const Sector& sector) {
    if (box.intersects(sector.box)) found.push_back(sector.triangle);
  };
  const std::optional<Arc> arc = arc_of(directions);
  if (!arc || arc->turn + hub.max_turn > full_turn - 4 * rounding_of_angles) {
    for (const Sector& sector : hub.sectors) take(sector);
    return;
  }
  for (const double by : {-full_turn, 0.0, full_turn}) {
    const double start = arc->start + by - rounding_of_angles, end = arc->start + arc->turn + by + rounding_of_angles;
    auto sector = std::lower_bound(hub.sectors.begin(), hub.sectors.end(), start - hub.max_turn,
                                   [](const Sector& s, double angle) { return s.arc.start < angle; });
    for (; sector != hub.sectors.end() && sector->arc.start <= end; ++sector)
      if (sector->arc.start + sector->arc.turn >= start) take(*sector);
  }
}

void Hubs::find(const Coordinates& a, std::uint32_t material, std::vector<std::uint32_t>& found) const {
  const Eigen::AlignedBox3d box = box_of(a, material);
  for_each_near(box, [&](const Hub& hub) { find_in(hub, a, box, found); });
}

void Hubs::find_touching(const Coordinates& a, std::uint32_t material, std::vector<std::uint32_t>& found) const {
  const Eigen::AlignedBox3d box = box_of(a, material);
  for_each_near(box, [&](const Hub& hub) {
    if (box.contains(Eigen::Vector3d(hub.at.x(), hub.at.y(), hub.material)))
      found.insert(found.end(), hub.in_places.begin(), hub.in_places.end());
  });
}

}  // namespace meshbound
