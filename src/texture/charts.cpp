// SPDX-License-Identifier: MIT
#include "texture/charts.h"

#include <algorithm>
#include <cmath>

namespace meshbound {
namespace {

/// Whether no edge of `a` seems to have all of `b` beyond it in the texture. Rounding may decide.
bool seems_to_overlap(const ChartTriangle& a, const ChartTriangle& b) {
  const auto& uv = a.source->coordinates;
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector2d &from = uv[k], way = uv[(k + 1) % 3] - from;
    const auto is_beyond = [&](const Eigen::Vector2d& p) {
      const double area = way.x() * (p.y() - from.y()) - way.y() * (p.x() - from.x());
      return a.turned ? area >= 0 : area <= 0;
    };
    if (std::all_of(b.source->coordinates.begin(), b.source->coordinates.end(), is_beyond)) return false;
  }
  return true;
}

bool seem_to_share_area(const ChartTriangle& a, const ChartTriangle& b) {
  return b.chart == Chart::Area && seems_to_overlap(a, b) && seems_to_overlap(b, a);
}

/// The corner of `b` with a texture coordinate; 3 if there is none.
std::size_t corner_at(const TexturedTriangle& b, const Eigen::Vector2d& coordinate) {
  return static_cast<std::size_t>(std::find(b.coordinates.begin(), b.coordinates.end(), coordinate) -
                                  b.coordinates.begin());
}

/// The largest squared distance between corners with the same texture coordinates; infinite where these differ.
double squared_distance_at_corners(const TexturedTriangle& a, const TexturedTriangle& b) {
  double worst = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t k = corner_at(b, a.coordinates[i]);
    if (k == 3) return HUGE_VAL;
    worst = std::max(worst, (a.corners[i] - b.corners[k]).squaredNorm());
  }
  return worst;
}

/// The box of the texture coordinates; the third side keeps materials apart.
Eigen::AlignedBox3d box_of(const TexturedTriangle& t) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector2d& uv : t.coordinates) box.extend(Eigen::Vector3d(uv.x(), uv.y(), t.material));
  return box;
}

}  // namespace

double upper_to_copy(const ChartTriangle& a, const ChartTriangle& copy) {
  double upper = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t k = corner_at(*copy.source, a.source->coordinates[i]);
    upper = std::max(upper, distance_bounds(a.source->corners[i], copy.source->corners[k]).upper);
  }
  return upper;
}

Eigen::AlignedBox3d place_of(const TexturedTriangle& triangle) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : triangle.corners) box.extend(p);
  return box;
}

ExactUnits units_of(const TexturedMesh& a, const TexturedMesh& b) {
  ExactUnits units{no_bit, no_bit};
  for (const TexturedMesh* mesh : {&a, &b})
    for (const TexturedTriangle& t : mesh->triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        for (const double x : t.coordinates[k]) units.texture = std::min(units.texture, lowest_bit(x));
        for (const double x : t.corners[k]) units.position = std::min(units.position, lowest_bit(x));
      }
  return units;
}

Charts::Charts(const TexturedMesh& mesh, const ExactUnits& units) : mesh_(mesh) {
  for (const TexturedTriangle& t : mesh.triangles) triangles_.push_back(chart_triangle(t, units));
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const TexturedTriangle& t : mesh.triangles) boxes.push_back(box_of(t)), places_.push_back(place_of(t));
  tree_.emplace(std::move(boxes));
}

void Charts::add_candidates(const ChartTriangle& a, Overlay& overlay, std::vector<std::uint32_t>& found) const {
  found.clear();
  tree_->find(box_of(*a.source), found);
  for (const std::uint32_t b : found) overlay.add(triangles_[b]);
}

void Charts::find_candidates(const ChartTriangle& a, double reach, ChartCandidates& found) const {
  found.near.clear();
  found.others.clear();
  found.copy = nullptr;
  std::vector<std::uint32_t> indices;
  tree_->find(box_of(*a.source), indices);
  double least = reach * reach;
  for (const std::uint32_t b : indices) {
    if (a.chart != Chart::Area) break;
    const double squared = squared_distance_at_corners(*a.source, *triangles_[b].source);
    if (squared < HUGE_VAL && squared <= least) least = squared, found.copy = &triangles_[b];  // reach^2 may overflow
  }
  const Eigen::AlignedBox3d place = place_of(*a.source);
  for (const std::uint32_t b : indices) {
    const bool is_near = found.copy != nullptr ? found.copy == &triangles_[b]
                                               : places_[b].squaredExteriorDistance(place) <= reach * reach &&
                                                     seem_to_share_area(a, triangles_[b]);
    (is_near ? found.near : found.others).push_back(&triangles_[b]);
  }
}

}  // namespace meshbound
