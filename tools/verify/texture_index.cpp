// SPDX-License-Identifier: MIT
#include "verify/texture_index.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

namespace meshbound::verify {
namespace {

constexpr std::size_t block_size = 32;  ///< triangles

/// On which side of the line from p to q a point lies: 1 left, -1 right, 0 on it. Empty where doubles cannot tell.
std::optional<int> certain_side(const Eigen::Vector2d& p, const Eigen::Vector2d& q, const Eigen::Vector2d& point) {
  if (point == p || point == q) return 0;
  const Eigen::Vector2d way = q - p, to = point - p;
  const double left = way.x() * to.y(), right = way.y() * to.x(), size = std::fabs(left) + std::fabs(right);
  // Four differences, two products, their difference: less than 4 roundings of `size`; none underflows.
  const bool is_certain = std::fabs(left - right) > 0x1p-50 * size && size > 0x1p-900 && size < 0x1p900;
  if (!is_certain) return std::nullopt;
  return left > right ? 1 : -1;
}

/// Whether the line of edge k of a triangle has the triangle on one side and all points on its other side or on itself.
bool separates(const TextureSurface::Triangle& a, std::size_t k, std::span<const Eigen::Vector2d> points) {
  const Eigen::Vector2d &p = a.coordinates[k], &q = a.coordinates[(k + 1) % 3];
  const int inside = certain_side(p, q, a.coordinates[(k + 2) % 3]).value_or(0);
  return inside != 0 && std::all_of(points.begin(), points.end(), [&](const Eigen::Vector2d& point) {
           return certain_side(p, q, point).value_or(inside) != inside;
         });
}

/// Whether an edge of `a` parts it from all of `b`, so that no area is common.
bool has_separating_edge(const TextureSurface::Triangle& a, const TextureSurface::Triangle& b) {
  return separates(a, 0, b.coordinates) || separates(a, 1, b.coordinates) || separates(a, 2, b.coordinates);
}

/// Three times the middle of the texture coordinates.
Eigen::Vector2d middle_of(const TextureSurface::Triangle& triangle) {
  return triangle.coordinates[0] + triangle.coordinates[1] + triangle.coordinates[2];
}

}  // namespace

TextureIndex::Box TextureIndex::box_of(const Triangle& triangle) {
  const auto& uv = triangle.coordinates;
  const Eigen::Vector2d low = uv[0].cwiseMin(uv[1]).cwiseMin(uv[2]), high = uv[0].cwiseMax(uv[1]).cwiseMax(uv[2]);
  return {low.x(), low.y(), high.x(), high.y()};
}

bool TextureIndex::meet(const Box& a, const Box& b) {
  return a[0] <= b[2] && b[0] <= a[2] && a[1] <= b[3] && b[1] <= a[3];
}

/// Strips of the texture, as many as blocks in each, so that the triangles of a block are close to each other.
TextureIndex::TextureIndex(const TextureSurface& surface) {
  for (const Triangle& triangle : surface.triangles) order_.push_back(&triangle);
  const auto by_u = [](const auto* a, const auto* b) { return middle_of(*a).x() < middle_of(*b).x(); };
  const auto by_v = [](const auto* a, const auto* b) { return middle_of(*a).y() < middle_of(*b).y(); };
  std::stable_sort(order_.begin(), order_.end(), by_u);
  const auto strip =
      static_cast<std::ptrdiff_t>(std::ceil(std::sqrt(static_cast<double>(order_.size()) / block_size)) * block_size);
  for (auto begin = order_.begin(); begin != order_.end();) {
    const auto end = begin + std::min(strip, order_.end() - begin);
    std::stable_sort(begin, end, by_v);
    begin = end;
  }
  for (std::size_t begin = 0; begin < order_.size(); begin += block_size) {
    const std::size_t end = std::min(order_.size(), begin + block_size);
    Box all = box_of(*order_[begin]);
    for (std::size_t i = begin; i < end; ++i) {
      const Box box = box_of(*order_[i]);
      all = {std::min(all[0], box[0]), std::min(all[1], box[1]), std::max(all[2], box[2]), std::max(all[3], box[3])};
    }
    blocks_.push_back({all, angle_of(begin, end)});
  }
}

/// Widens the angle so that it holds a point as well; false where it would be too wide, or doubles cannot tell.
bool TextureIndex::enclose(Angle& angle, const Eigen::Vector2d& point) {
  const auto from_first = certain_side(angle.tip, angle.first, point),
             from_last = certain_side(angle.tip, angle.last, point);
  if (!from_first || !from_last) return false;
  const bool is_behind = *from_first < 0 && *from_last > 0;
  if (*from_first < 0) angle.first = point;  // to the right of both rays
  if (*from_last > 0) angle.last = point;    // to the left of both
  return !is_behind;
}

/// The angle that triangles in order lie in; absent where they have no corner in common, or all directions from it.
std::optional<TextureIndex::Angle> TextureIndex::angle_of(std::size_t begin, std::size_t end) const {
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector2d &tip = order_[begin]->coordinates[k], &other = order_[begin]->coordinates[(k + 1) % 3];
    Angle angle{tip, other, other};
    const bool is_angle = std::all_of(order_.begin() + static_cast<std::ptrdiff_t>(begin),
                                      order_.begin() + static_cast<std::ptrdiff_t>(end), [&](const Triangle* triangle) {
                                        const auto& uv = triangle->coordinates;
                                        return std::find(uv.begin(), uv.end(), tip) != uv.end() &&
                                               enclose(angle, uv[0]) && enclose(angle, uv[1]) && enclose(angle, uv[2]);
                                      });
    if (is_angle && tip != other) return angle;
  }
  return std::nullopt;
}

/// Whether an edge of a triangle that ends at the tip of an angle has the triangle on one side, and the angle, by its
/// tip and its two rays, on its other side or on its line.
bool TextureIndex::has_separating_edge(const Triangle& triangle, const Angle& angle) {
  for (std::size_t k = 0; k < 3; ++k) {
    const bool is_at_tip = triangle.coordinates[k] == angle.tip || triangle.coordinates[(k + 1) % 3] == angle.tip;
    if (is_at_tip && separates(triangle, k, std::array{angle.first, angle.last})) return true;
  }
  return false;
}

/// Calls `visit(b)` for the triangles of the same material whose boxes meet; with `needs_area`, without blocks that
/// have no area in common with the triangle.
template <class Visit>
void TextureIndex::for_each_near(const Triangle& triangle, bool needs_area, const Visit& visit) const {
  const Box box = box_of(triangle);
  for (std::size_t block = 0; block < blocks_.size(); ++block) {
    const auto& [box_of_block, angle] = blocks_[block];
    if (!meet(box, box_of_block) || (needs_area && angle && has_separating_edge(triangle, *angle))) continue;
    for (std::size_t i = block * block_size; i < std::min(order_.size(), (block + 1) * block_size); ++i)
      if (order_[i]->material == triangle.material && meet(box, box_of(*order_[i]))) visit(order_[i]);
  }
}

std::vector<const TextureSurface::Triangle*> TextureIndex::touching(const Triangle& triangle) const {
  std::vector<const Triangle*> found;
  for_each_near(triangle, false, [&](const Triangle* b) { found.push_back(b); });
  return found;
}

std::vector<const TextureSurface::Triangle*> TextureIndex::sharing_area(const Triangle& triangle) const {
  std::vector<const Triangle*> found;
  for_each_near(triangle, true, [&](const Triangle* b) {
    if (!verify::has_separating_edge(triangle, *b) && !verify::has_separating_edge(*b, triangle)) found.push_back(b);
  });
  return found;
}

}  // namespace meshbound::verify
