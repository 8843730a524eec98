// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "bvh/bvh_data.h"
#include "proof/goal.h"
#include "proof/piece.h"

namespace meshbound {

/// Which triangle lies across each edge, vertices at the same place being one.
struct PatchNeighbours {
  static constexpr std::uint32_t boundary = 0xffffffff;  ///< not an edge of exactly two triangles

  /// O(n log n).
  explicit PatchNeighbours(const Bvh::Data& target);

  std::vector<std::array<std::uint32_t, 3>> across;  ///< by slot, from corner k to k + 1
  std::vector<bool> usable;                          ///< by slot: no two corners at the same place
};

/// Tells in floating point, with room to spare, whether a reader will find a piece proven by degree
/// (tools/schema/certificate-1.md): the patch P, grown from a seed, has nothing too high over the piece, no edge with
/// one triangle across it, and an odd degree. Whatever comes near a limit counts as a failure, so that the reader's
/// exact decisions are the same. Not thread-safe.
class ParitySearch {
 public:
  /// `goal` gives the tolerance and the slack, in B's working frame; `magnitude` bounds all coordinates there. `target`
  /// and `neighbours` must outlive this. O(n).
  ParitySearch(const Bvh::Data& target, const PatchNeighbours& neighbours, const Goal& goal, double magnitude,
               std::size_t patch_limit);

  /// For a piece of `triangle`, with the triangle of B at `seed`, all in B's working frame. O(size of the patch).
  [[nodiscard]] bool proves(const std::array<Vec3, 3>& triangle, const Piece& piece, std::uint32_t seed);

  /// Whether `proves` gave up last because the patch grew too large: parts of the piece may do.
  [[nodiscard]] bool patch_was_too_large() const { return patch_.size() == patch_limit_; }

  /// Triangles of all patches that proved a piece: what they cost a reader.
  [[nodiscard]] std::uint64_t work() const { return work_; }

  /// Half of what a reader must accept.
  static constexpr std::size_t largest_patch = 32768;

 private:
  /// A vertex as seen along the normal of the source triangle: x and y in its plane, h above it.
  struct Seen {
    double x = 0, y = 0, h = 0;
  };
  using SeenTriangle = std::array<Seen, 3>;
  enum class Passage { Clear, Across, Unclear };

  [[nodiscard]] bool set_view(const std::array<Vec3, 3>& triangle, const Piece& piece);
  [[nodiscard]] bool set_window(const Piece& piece);
  [[nodiscard]] Seen see(const Vec3& p) const;
  [[nodiscard]] double outside(std::size_t side, const Seen& p) const {
    return side_x_[side] * p.x + side_y_[side] * p.y - side_offset_[side];
  }
  /// What the coordinates of p in the view may be off.
  [[nodiscard]] double rim(const Seen& p) const { return rim_ + tilt_ * std::abs(p.h); }
  [[nodiscard]] bool heights_hold(const SeenTriangle& t) const;
  [[nodiscard]] bool is_clear(const Seen& p, const Seen& q, double margin) const;
  [[nodiscard]] Passage passage(const Seen& p, const Seen& q) const;
  [[nodiscard]] bool crosses_ray(const Seen& p, const Seen& q) const;

  const Bvh::Data& b_;
  const PatchNeighbours& neighbours_;
  double tolerance_ = 0, slack_ = 0, magnitude_ = 1;

  Vec3 origin_, x_axis_, y_axis_, z_axis_;
  double rim_ = 0, tilt_ = 0, height_limit_ = 0;
  std::size_t sides_ = 0;
  std::array<Seen, Piece::capacity> window_;
  std::array<double, Piece::capacity> side_x_{}, side_y_{}, side_offset_{};  ///< outward unit normals

  std::vector<std::uint32_t> patch_, visited_;
  std::uint32_t round_ = 0;
  std::size_t patch_limit_;
  std::uint64_t work_ = 0;
};

}  // namespace meshbound
