// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "verify/texture_surface.h"

namespace meshbound::verify {

/// Finds the triangles that may have texture coordinates of a triangle: blocks of triangles with their boxes, and with
/// the angles that they lie in, as around a vertex of thousands of triangles nearly all boxes meet.
class TextureIndex {
 public:
  using Triangle = TextureSurface::Triangle;

  explicit TextureIndex(const TextureSurface& surface);
  /// Those of the same material whose boxes of texture coordinates meet. O(n / 32 + found).
  [[nodiscard]] std::vector<const Triangle*> touching(const Triangle& triangle) const;
  /// Those of the same material that may have an area of the texture in common with the triangle: all that do, few
  /// others. Expected O(n / 32 + found).
  [[nodiscard]] std::vector<const Triangle*> sharing_area(const Triangle& triangle) const;

 private:
  using Box = std::array<double, 4>;  ///< lowest u and v, highest u and v
  /// What lies between two rays from a tip, counter-clockwise, less than half a turn apart.
  struct Angle {
    Eigen::Vector2d tip, first, last;  ///< points on the rays
  };
  /// Consecutive triangles.
  struct Block {
    Box box{};
    std::optional<Angle> angle;  ///< that all lie in, if they have one corner in common
  };

  [[nodiscard]] static Box box_of(const Triangle& triangle);
  [[nodiscard]] static bool meet(const Box& a, const Box& b);
  [[nodiscard]] static bool enclose(Angle& angle, const Eigen::Vector2d& point);
  [[nodiscard]] std::optional<Angle> angle_of(std::size_t begin, std::size_t end) const;
  [[nodiscard]] static bool has_separating_edge(const Triangle& triangle, const Angle& angle);
  template <class Visit>
  void for_each_near(const Triangle& triangle, bool needs_area, const Visit& visit) const;

  std::vector<const Triangle*> order_;
  std::vector<Block> blocks_;
};

}  // namespace meshbound::verify
