// SPDX-License-Identifier: MIT
#pragma once
#include <optional>

#include "distance/kernel/cell_walker.h"
#include "distance/kernel/search_kernel.h"
#include "distance/paper/group_traversal.h"
#include "distance/paper/subdivision.h"

namespace meshbound {
inline namespace MESHBOUND_ISA {

class SearchKernelImpl final : public SearchKernel {
 public:
  SearchKernelImpl(const Bvh::Data& target, const Goal& goal) : walker_(target, goal) {}

  void begin(const LowerBound& lower) override { walker_.begin(lower); }

  Nearest nearest(const Vec3& p, std::uint32_t hint, double enough_squared) override {
    Nearest best{closest_on_triangle(triangle_at(walker_.target(), hint), p).squared_distance, hint};
    if (enough_squared > 0) descend(walker_.target(), p, enough_squared, best, walker_.counters().queries);
    if (best.squared > enough_squared)
      find_nearest(walker_.target(), p, enough_squared, best, walker_.counters().queries);
    return best;
  }

  Nearest nearby(const Vec3& p, std::uint32_t hint) override {
    Nearest best{closest_on_triangle(triangle_at(walker_.target(), hint), p).squared_distance, hint};
    descend(walker_.target(), p, 0, best, walker_.counters().queries);
    return best;
  }

  void offer(const Vec3& p, const Nearest& nearest, std::uint32_t from_slot) override {
    walker_.set_from(from_slot);
    walker_.offer(p, nearest, 0);
  }

  double farthest_squared(const Vec3& a, const Vec3& b, const Vec3& c, std::uint32_t slot) override {
    const Piece piece = whole_triangle(a, b, c, slot);
    const CornerTriangle<double> t = triangle_at(walker_.target(), slot);
    const double bound = quick_bound(piece, t);
    return walker_.accepts(bound) ? bound : farthest_corner(piece, t).squared;
  }

  void cover(const Vec3& a, const Vec3& b, const Vec3& c, std::uint32_t from_slot, std::uint32_t slot,
             std::uint64_t max_cuts) override {
    walker_.cover(a, b, c, from_slot, slot, max_cuts);
    std::uint64_t cuts_left = walker_.cuts_left();
    for (const auto& [piece, upper_squared] : walker_.unfinished())
      cuts_left = subdivision().refine(piece, upper_squared, cuts_left);
  }

  Swept sweep(const TriangleCorners& triangle, std::uint32_t& hint, std::uint64_t max_cuts) override {
    constexpr std::uint32_t max_pieces = 64;  // beyond it the queries of a cover cost little
    const auto& [a, b, c] = triangle;
    const Vec3 middle = centroid(triangle);
    hint = step_over(walker_.target(), middle, hint);
    const std::uint32_t pieces = walker_.cover_without_queries(a, b, c, hint, max_pieces, max_cuts);
    if (pieces > 0) return pieces == 1 ? Swept::ByOneTriangle : Swept::ByWalk;
    const double squared = closest_on_triangle(triangle_at(walker_.target(), hint), middle).squared_distance;
    return walker_.accepts(squared) ? Swept::NotAtAll : Swept::NotNear;
  }

  void record_in(CoverRecord* record) override { walker_.record_in(record); }

  GroupBounds cull_on_b(const TriangleCorners& triangle, std::span<const std::uint32_t> hints,
                        double enough_squared) override {
    GroupBounds bounds;
    for (const std::uint32_t hint : hints) test_block(walker_.target(), hint / block_width, triangle, bounds);
    group_traversal(walker_.target(), triangle, enough_squared, bounds, walker_.counters().queries);
    return bounds;
  }

  void subdivide(const TriangleCorners& triangle, std::uint32_t from_slot, double upper_squared,
                 std::uint64_t max_cuts) override {
    walker_.set_from(from_slot);
    subdivision().refine(triangle, upper_squared, max_cuts);
  }

  double farthest_squared(const std::array<Vec3, 8>& box, std::uint32_t slot) override {
    Piece corners;
    for (const Vec3& corner : box) corners.add(corner);
    return farthest_corner(corners, triangle_at(walker_.target(), slot)).squared;
  }

  void accept(double squared) override { walker_.accept(squared); }
  [[nodiscard]] double accepted_squared() const override { return walker_.accepted_squared(); }
  [[nodiscard]] const LowerBound& lower() const override { return walker_.lower(); }
  [[nodiscard]] double upper_squared() const override { return walker_.upper_squared(); }
  [[nodiscard]] const WalkCounters& counters() const override { return walker_.counters(); }

 private:
  Subdivision& subdivision() {
    if (!subdivision_) subdivision_.emplace(walker_);
    return *subdivision_;
  }

  CellWalker walker_;  ///< keeps the bounds of both ways to cover a triangle
  std::optional<Subdivision> subdivision_;
};

}  // namespace MESHBOUND_ISA
}  // namespace meshbound
