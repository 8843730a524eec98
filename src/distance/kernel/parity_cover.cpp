// SPDX-License-Identifier: MIT
#include "distance/kernel/parity_cover.h"

#include <algorithm>
#include <cmath>

#include "geometry/longest_edge.h"
#include "geometry/position_table.h"
#include "numeric/no_index.h"
#include "proof/parity_patch.h"
#include "proof/parity_view.h"

namespace meshbound {
namespace {

/// Areas of T, in triangles of B, from which on a proof is tried: a walk across fewer costs as little. Measured on 74
/// meshes beside their levels at 0.1% of the diagonal: from 32 on a search takes 2% longer in the mean, and where all
/// are tried 3%.
constexpr double min_areas = 12;
/// Squared limit, in areas of two triangles of B, up to which a proof is tried. A walk cuts T into pieces of about the
/// limit, so how it compares with a proof depends on this alone. Trees and query of 74 meshes beside their levels at
/// 5% and 1% of the diagonal take 0.83 and 1.00 of the time without this rule for 8 (one takes 1.5), 0.86 and 0.99 for
/// 16, 0.89 and 0.99 for 30; at 0.1% it changes nothing.
constexpr double max_areas_of_limit = 16;
/// Triangles of B that must be left for two halves of T.
constexpr double min_areas_to_halve = 64;
/// Triangles of all tries for one T, in those of the largest one: halves of T are over half as many, unless B has
/// needles, which are over both.
constexpr std::size_t max_times_largest = 6;
/// A patch of more triangles is given up: a quarter of what a tile has.
constexpr std::size_t max_patch = std::size_t{1} << 18;

/// A share of P may be too high, and a few triangles more, before a proof is given up: each costs as much as a dozen
/// others.
constexpr double too_high_share = 0.1;
constexpr std::size_t few_too_high = 4;

/// An edge that is seen steeper than so many times its length has no accurate direction.
constexpr double max_steepness = 64;

double area_of_parallelogram(const TriangleCorners& t) { return length(cross(t[1] - t[0], t[2] - t[0])); }

double seen_area_of_parallelogram(const ProjectedTriangle& t) {
  return std::abs((t[1].x - t[0].x) * (t[2].y - t[0].y) - (t[1].y - t[0].y) * (t[2].x - t[0].x));
}

}  // namespace

std::array<TriangleCorners, 2> halves(const TriangleCorners& triangle) {
  const std::size_t from = longest_edge(triangle[0], triangle[1], triangle[2]), to = (from + 1) % 3;
  const Vec3 middle = triangle[from] + 0.5 * (triangle[to] - triangle[from]);
  std::array<TriangleCorners, 2> both{triangle, triangle};
  both[0][to] = both[1][from] = middle;
  return both;
}

/// The triangles of B, by slot.
struct ParityCover::TreeSoup {
  const Bvh::Data& b;

  [[nodiscard]] TriangleCorners corners(std::uint32_t slot) const {
    const Triangle& t = b.corners[slot];
    return {b.vertices[t[0]], b.vertices[t[1]], b.vertices[t[2]]};
  }
  /// The tree links the triangles of an edge in a ring, by hints: one counts only where both point to each other across
  /// an edge with the same ends, as two do and three do not. A triangle with two corners at one place has an edge
  /// twice: it has no neighbours.
  [[nodiscard]] std::uint32_t neighbour(std::uint32_t slot, std::size_t k) const {
    const std::uint32_t next = b.neighbours[slot][k].slot;
    if (next == no_slot || has_edge_twice(slot) || has_edge_twice(next)) return no_index;
    const Triangle& t = b.corners[slot];
    const std::uint32_t from = t[k], to = t[(k + 1) % 3];
    for (std::size_t i = 0; i < 3; ++i) {
      if (b.neighbours[next][i].slot != slot) continue;
      const std::uint32_t p = b.corners[next][i], q = b.corners[next][(i + 1) % 3];
      if ((same(p, to) && same(q, from)) || (same(p, from) && same(q, to))) return next;
    }
    return no_index;
  }

 private:
  [[nodiscard]] bool same(std::uint32_t u, std::uint32_t v) const {
    return u == v || same_position(b.vertices[u], b.vertices[v]);
  }
  [[nodiscard]] bool has_edge_twice(std::uint32_t slot) const {
    const Triangle& t = b.corners[slot];
    return same(t[0], t[1]) || same(t[1], t[2]) || same(t[2], t[0]);
  }
};

/// What is seen of P, and what it adds up to.
struct ParityCover::TreeSight : Sight<TreeSoup> {
  std::vector<std::uint32_t>& too_high;
  std::size_t looked_at = 0;
  double area = 0;     ///< of parallelograms
  double highest = 0;  ///< of those that are not too high
  bool at_border = false;

  bool look_at(std::uint32_t slot) {
    at_border = false;
    ++looked_at;
    if (Sight::look_at(slot)) {
      const double height = std::max({std::abs(corners[0].h), std::abs(corners[1].h), std::abs(corners[2].h)});
      highest = std::max(highest, std::min(height, from.height_limit));
    } else {
      too_high.push_back(slot);
    }
    area += seen_area_of_parallelogram(corners);
    return static_cast<double>(too_high.size()) <= few_too_high + too_high_share * static_cast<double>(looked_at);
  }
};

struct ParityCover::Search {
  ParityPatch patch{max_patch};
};

ParityCover::ParityCover(const Bvh::Data& target, double magnitude) : target_(target), magnitude_(magnitude) {}
ParityCover::~ParityCover() = default;

void ParityCover::begin() { spent_ = largest_ = 0; }

bool ParityCover::spans_many(const TriangleCorners& triangle, double limit, std::uint32_t seed) const {
  const double area = area_of_parallelogram(TreeSoup{target_}.corners(seed));
  return area_of_parallelogram(triangle) > min_areas * area && limit * limit < max_areas_of_limit * area;
}

std::optional<double> ParityCover::distance(const TriangleCorners& triangle, double limit, std::uint32_t seed) {
  too_high_.clear();
  expected_ = 0;
  const std::optional<ParityView> view = ParityView::of(triangle, limit, magnitude_);
  if (!view) return std::nullopt;
  if (!search_) search_ = std::make_unique<Search>();
  const TreeSoup soup{target_};
  TreeSight sight{{*view, soup}, too_high_};
  const bool is_covered = search_->patch.covers(
      [&](std::uint32_t slot, std::size_t k) {
        const std::uint32_t next = soup.neighbour(slot, k);
        sight.at_border = next == no_index;
        return next;
      },
      seed, sight);
  spent_ += sight.looked_at;
  largest_ = std::max(largest_, sight.looked_at);
  const double drawn_in = ParityView::shrink_share * limit;
  if (is_covered) {
    normal_ = view->view.z_axis;
    margin_ = 2 * drawn_in;
    return sight.highest + drawn_in + 4 * view->rim;
  }
  met_border_ = sight.at_border;
  if (sight.area > 0) expected_ = area_of_parallelogram(triangle) / sight.area * static_cast<double>(sight.looked_at);
  return std::nullopt;
}

bool ParityCover::is_worth_halving() const {
  return met_border_ && expected_ > min_areas_to_halve && spent_ <= max_times_largest * largest_;
}

std::span<const std::uint32_t> ParityCover::patch() const { return search_->patch.triangles(); }
std::span<const std::uint32_t> ParityCover::too_high() const { return too_high_; }

/// Each half-space has all three corners, whatever its normal is. It has what is straight above them where the normal
/// lies in T: it leaves it by 8 u times the steepness of the edge, which over a height of 4 magnitudes adds up to less
/// than 2^-42 of these, a share of `margin_` (`ParityView` wants a limit of 2^-24 magnitudes).
std::array<HalfSpace, 3> ParityCover::half_spaces_over(std::uint32_t slot) const {
  const TriangleCorners t = TreeSoup{target_}.corners(slot);
  std::array<HalfSpace, 3> spaces;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 edge = t[(k + 1) % 3] - t[k], across = cross(normal_, edge);
    const double seen = length(across);
    if (!(max_steepness * seen > length(edge))) continue;
    Vec3 normal = (1 / seen) * across;
    if (dot(normal, t[(k + 2) % 3]) > dot(normal, t[k])) normal = -1.0 * normal;
    spaces[k] = {normal, std::max({dot(normal, t[0]), dot(normal, t[1]), dot(normal, t[2])}) + margin_};
  }
  return spaces;
}

}  // namespace meshbound
