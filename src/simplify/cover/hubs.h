// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "meshbound/texture_deviation.h"
#include "simplify/cover/box_tree.h"

namespace meshbound {

/// Hubs: texture coordinates that many triangles have as a corner, as the middle of a disc. The boxes of all triangles
/// around a hub meet there, so these are found by their directions from it instead. Immutable, safe to share.
class Hubs {
 public:
  Hubs() = default;
  /// Looks for hubs among the corners of the triangles whose boxes in the texture, the third side for the material, are
  /// not empty: those with an area there. O(n log n).
  Hubs(std::span<const TexturedTriangle> triangles, std::span<const Eigen::AlignedBox3d> in_texture);

  [[nodiscard]] bool empty() const { return hubs_.empty(); }
  /// Whether a triangle is one of those around a hub. A triangle belongs to one hub at most.
  [[nodiscard]] bool has(std::size_t triangle) const { return !is_around_.empty() && is_around_[triangle]; }

  /// The coordinates of a triangle, or of what else is looked for: all may be the same.
  using Coordinates = std::array<Eigen::Vector2d, 3>;

  /// Appends the indices of triangles around hubs that may have coordinates of a triangle besides that of their hub.
  /// Expected O(log n + k) for k of them, where no hub is inside of it.
  void find(const Coordinates& a, std::uint32_t material, std::vector<std::uint32_t>& found) const;
  /// Appends, for each hub whose coordinate a triangle may have, one triangle around it for each place in space that
  /// the hub has: the others there have the same point with that coordinate. They may be among those that `find` finds.
  void find_touching(const Coordinates& a, std::uint32_t material, std::vector<std::uint32_t>& found) const;

 private:
  /// Directions, as an angle to start from and how far to turn from there, less than half a turn.
  struct Arc {
    double start = 0, turn = 0;
  };
  struct Sector {
    Arc arc;
    std::uint32_t triangle = 0;
    Eigen::AlignedBox3d box;  ///< of the triangle, in the texture
  };
  struct Hub {
    std::uint32_t material = 0;
    Eigen::Vector2d at;
    std::vector<Sector> sectors;           ///< by the start of their arcs
    double max_turn = 0;                   ///< of these
    std::vector<std::uint32_t> in_places;  ///< a triangle for each place in space of the hub
  };
  struct Directions;

  [[nodiscard]] static Directions directions_from(const Eigen::Vector2d& hub, const Coordinates& t);
  [[nodiscard]] static std::optional<Arc> arc_of(const Directions& directions);
  void add_hub(const Eigen::Vector2d& at, std::span<const std::uint32_t> around,
               std::span<const TexturedTriangle> triangles, std::span<const Eigen::AlignedBox3d> in_texture);
  static void find_in(const Hub& hub, const Coordinates& a, const Eigen::AlignedBox3d& box,
                      std::vector<std::uint32_t>& found);
  template <class Visit>
  void for_each_near(const Eigen::AlignedBox3d& box, const Visit& visit) const;

  std::vector<Hub> hubs_;
  std::vector<bool> is_around_;   ///< by triangle: one; empty without hubs
  std::optional<BoxTree> boxes_;  ///< in the texture, around the triangles of each hub
};

}  // namespace meshbound
