// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "simplify/cover/box_tree.h"
#include "texture/overlay.h"

namespace meshbound {

/// Hubs: texture coordinates that many triangles have as a corner, as the middle of a disc. The boxes of all triangles
/// around a hub meet there, so these are found by their directions from it instead. Immutable, safe to share.
class Hubs {
 public:
  Hubs() = default;
  /// Looks for hubs among the corners of triangles with an area in the texture. `triangles` must outlive this.
  /// O(n log n).
  explicit Hubs(std::span<const ChartTriangle> triangles);

  [[nodiscard]] bool empty() const { return hubs_.empty(); }
  /// Whether a triangle is one of those around a hub. A triangle belongs to one hub at most.
  [[nodiscard]] bool has(std::uint32_t triangle) const { return !hub_of_.empty() && hub_of_[triangle] != no_hub; }

  /// Appends the triangles around hubs that may have coordinates of `a` besides that of their hub. Expected
  /// O(log n + k) for k of them, where no hub is inside of `a`.
  void find(const ChartTriangle& a, std::vector<std::uint32_t>& found) const;
  /// Appends, for each hub whose coordinate `a` may have, one triangle for each place in space that the hub has: the
  /// others there have the same point with that coordinate. They may be among those that `find` finds.
  void find_touching(const ChartTriangle& a, std::vector<std::uint32_t>& found) const;

 private:
  static constexpr std::uint32_t no_hub = ~std::uint32_t{0};
  /// Directions, as an angle to start from and how far to turn from there, less than half a turn.
  struct Arc {
    double start = 0, turn = 0;
  };
  struct Sector {
    Arc arc;
    std::uint32_t triangle = 0;
  };
  struct Hub {
    std::uint32_t material = 0;
    Eigen::Vector2d at;
    std::vector<Sector> sectors;           ///< by the start of their arcs
    double max_turn = 0;                   ///< of these
    std::vector<std::uint32_t> in_places;  ///< a triangle for each place in space of the hub
  };
  struct Directions;

  [[nodiscard]] static Directions directions_from(const Eigen::Vector2d& hub, const TexturedTriangle& t);
  [[nodiscard]] static std::optional<Arc> arc_of(const Directions& directions);
  void add_hub(const Eigen::Vector2d& at, std::span<const std::uint32_t> around);
  void find_in(const Hub& hub, const ChartTriangle& a, std::vector<std::uint32_t>& found) const;
  [[nodiscard]] std::vector<std::uint32_t> near(const ChartTriangle& a) const;

  std::span<const ChartTriangle> triangles_;
  std::vector<Hub> hubs_;
  std::vector<std::uint32_t> hub_of_;  ///< by triangle; empty without hubs
  std::optional<BoxTree> boxes_;       ///< in the texture, around the triangles of each hub
};

}  // namespace meshbound
