// SPDX-License-Identifier: MIT
/// Closest-point queries. Compiled once per instruction set (numeric/isa.h).
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>

#include "bvh/box_query.h"
#include "bvh/bvh_data.h"
#include "bvh/oriented_nodes.h"
#include "geometry/point_triangle.h"
#include "geometry/vec_lanes.h"
#include "numeric/double_double.h"
#include "numeric/simd.h"

namespace meshbound {

/// A triangle by slot and the squared distance to it (see `TriangleOffset::squared_distance`).
struct Nearest {
  double squared = std::numeric_limits<double>::infinity();
  std::uint32_t slot = 0;
};

struct QueryCounters {
  std::uint64_t queries = 0;
  std::uint64_t nodes = 0;
  std::uint64_t triangles = 0;
};

inline namespace MESHBOUND_ISA {

inline CornerTriangle<double> triangle_at(const Bvh::Data& data, std::uint32_t slot) {
  const Triangle& t = data.corners[slot];
  const Vec3 a = data.vertices[t[0]];
  return {a, data.vertices[t[1]] - a, data.vertices[t[2]] - a};
}

#if defined(__AVX512F__)
inline Double8 joined(const Double4& low, const Double4& high) {
  return _mm512_insertf64x4(_mm512_castpd256_pd512(low), high, 1);
}
[[gnu::always_inline]] inline Vec<Double8> joined(const Vec<Double4>& low, const Vec<Double4>& high) {
  return {joined(low.x, high.x), joined(low.y, high.y), joined(low.z, high.z)};
}
#endif

/// The points at(0), at(1) and so on, as many as there are lanes.
template <class At>
[[gnu::always_inline]] inline Vec<Doubles> gather(const At& at) {
  const Vec<Double4> low = gather4(at(0), at(1), at(2), at(3));
#if defined(__AVX512F__)
  return joined(low, gather4(at(4), at(5), at(6), at(7)));
#else
  return low;
#endif
}

/// Corner k of four triangles.
[[gnu::always_inline]] inline Vec<Double4> corners_at(const Bvh::Data& data, const std::uint32_t* slots,
                                                      std::size_t k) {
  const auto at = [&](std::size_t i) -> const Vec3& { return data.vertices[data.corners[slots[i]][k]]; };
  return gather4(at(0), at(1), at(2), at(3));
}

/// Four triangles by their slots, lane by lane. Their corners are gathered: storing a copy for each block made testing
/// a leaf hardly faster and took 72 of 200 bytes a triangle, which building had to write.
inline CornerTriangle<Double4> triangles_at(const Bvh::Data& data,
                                            const std::array<std::uint32_t, block_width>& slots) {
  const Vec<Double4> a = corners_at(data, slots.data(), 0);
  return {a, corners_at(data, slots.data(), 1) - a, corners_at(data, slots.data(), 2) - a};
}

#if defined(__AVX512F__)
/// Eight triangles by their slots, lane by lane.
[[gnu::always_inline]] inline CornerTriangle<Double8> triangles_at(const Bvh::Data& data,
                                                                   const std::array<std::uint32_t, 8>& slots) {
  const std::uint32_t *const low = slots.data(), *const high = low + 4;
  const Vec<Double4> a = corners_at(data, low, 0), b = corners_at(data, low, 1), c = corners_at(data, low, 2),
                     d = corners_at(data, high, 0), e = corners_at(data, high, 1), f = corners_at(data, high, 2);
  return {joined(a, d), joined(b - a, e - d), joined(c - a, f - d)};
}
#endif

/// The slots of a block; the last block repeats its last triangle in unused lanes.
inline std::array<std::uint32_t, block_width> slots_of_block(const Bvh::Data& data, std::uint32_t block) {
  const std::uint32_t first = block * block_width, last = data.triangle_count() - 1;
  return {first, std::min(first + 1, last), std::min(first + 2, last), std::min(first + 3, last)};
}

inline CornerTriangle<Double4> triangles_of_block(const Bvh::Data& data, std::uint32_t block) {
  return triangles_at(data, slots_of_block(data, block));
}

/// Depth-first walk over the tree, the child with the nearest centre first: where many boxes are equally near, as from
/// the axis of a cylinder or among coplanar layers, it mostly holds the nearer triangles. `on_block(index)` tests a
/// block of triangles and returns the squared distance that is of interest from then on, negative to end the walk. The
/// stack holds at most 7 siblings for each of at most 10 levels (8^10 > 2^30) and one root.
template <class Query, class OnBlock>
void visit_near(const Bvh::Data& data, const Query& query, double within_squared, QueryCounters& counters,
                OnBlock&& on_block) {
  struct Entry {
    float centre;
    float squared;
    std::uint32_t level;
    std::uint32_t index;
  };
  Entry stack[80];
  int size = 0;
  stack[size++] = {0, 0, data.levels() - 1, 0};
  float limit = query.limit(within_squared);
  while (size > 0) {
    const Entry entry = stack[--size];
    if (!(entry.squared < limit)) continue;
    if (entry.level == 0) {
      within_squared = on_block(entry.index);
      if (within_squared < 0) return;
      limit = query.limit(within_squared);
      continue;
    }
    ++counters.nodes;
    const BvhNode& node = data.nodes[data.level_begin[entry.level] + entry.index];
    const auto [squared, centre] = query.to_boxes(node);
    const int first = size;
    for (unsigned hits = lane_bits(squared < broadcast8(limit)); hits != 0; hits &= hits - 1) {
      const int lane = std::countr_zero(hits);
      const Entry child{centre[lane], squared[lane], entry.level - 1,
                        entry.index * node_width + static_cast<std::uint32_t>(lane)};
      int at = size++;
      for (; at > first && stack[at - 1].centre < child.centre; --at) stack[at] = stack[at - 1];
      stack[at] = child;
    }
  }
}

/// Calls `work(query)` with the point as the query that bounds its distances to the boxes of this tree best.
template <class Work>
auto with_query(const Bvh::Data& data, const Vec3& p, const Work& work) {
  if (is_far(p)) return work(FarQuery(data.working_box, p));
  if (const auto& oriented = oriented_nodes(data); !oriented.empty()) return work(OrientedQuery(data, oriented, p));
  return work(FloatQuery(p));
}

/// As above, from a point.
template <class OnBlock>
void visit_near(const Bvh::Data& data, const Vec3& p, double within_squared, QueryCounters& counters,
                OnBlock&& on_block) {
  with_query(data, p, [&](const auto& query) { visit_near(data, query, within_squared, counters, on_block); });
}

/// Improves `best` to the nearest triangle; returns as soon as one is within `enough_squared`.
inline void find_nearest(const Bvh::Data& data, const Vec3& p, double enough_squared, Nearest& best,
                         QueryCounters& counters) {
  ++counters.queries;
  if (best.squared <= enough_squared) return;
  const Vec<Double4> p4 = broadcast4(p);
  const std::uint32_t last = data.triangle_count() - 1;
  visit_near(data, p, best.squared, counters, [&](std::uint32_t block) {
    counters.triangles += block_width;
    const Double4 squared = closest_on_triangle(triangles_of_block(data, block), p4).squared_distance;
    for (std::uint32_t lane = 0; lane < block_width; ++lane) {
      if (squared[lane] < best.squared) {
        const std::uint32_t slot = block * block_width + lane;
        best = {squared[lane], slot < last ? slot : last};
      }
    }
    return best.squared <= enough_squared ? -1.0 : best.squared;
  });
}

/// The edge of a triangle that p is furthest outside of, seen along its normal; 3 when p lies over the triangle.
inline std::size_t edge_towards(const Bvh::Data& data, std::uint32_t slot, const CornerTriangle<double>& t,
                                const Vec3& p) {
  const auto& normal = data.normals[slot];
  const Vec3 n{normal[0], normal[1], normal[2]}, ap = p - t.a;
  const double outside[3] = {dot(cross(t.ab, n), ap), dot(cross(t.ac - t.ab, n), ap - t.ab), dot(cross(n, t.ac), ap)};
  // Without branches on which it is: they would be guessed wrong half the time.
  const std::size_t of_two = outside[1] > outside[0] ? 1 : 0, is_third = outside[2] > outside[of_two] ? 1 : 0;
  const std::size_t edge = of_two + is_third * (2 - of_two);
  return outside[edge] > 0 ? edge : 3;
}

/// Steps of `descend`: from a triangle to the one on the other side of a surface of some thousand triangles.
inline constexpr int max_descent = 64;

/// Walks from `best.slot` to the nearest of its neighbours while that is nearer to p, until a triangle within
/// `enough_squared` is found. Where very many triangles are nearly equally near, as from the axis of a cylinder, this
/// finds one where a traversal looks at most of them.
inline void descend(const Bvh::Data& data, const Vec3& p, double enough_squared, Nearest& best,
                    QueryCounters& counters) {
  const Vec<Double4> p4 = broadcast4(p);
  for (int step = 0; step < max_descent && best.squared > enough_squared; ++step) {
    const std::uint32_t from = best.slot;
    std::array<std::uint32_t, block_width> slots{from, from, from, from};
    for (std::size_t k = 0; k < 3; ++k)
      if (const Neighbour across = data.neighbours[from][k]; across.slot != no_slot) slots[k] = across.slot;
    counters.triangles += 3;
    const Double4 squared = closest_on_triangle(triangles_at(data, slots), p4).squared_distance;
    for (std::size_t k = 0; k < 3; ++k)
      if (squared[k] < best.squared) best = {squared[k], slots[k]};
    if (best.slot == from) return;
  }
}

/// Steps of `step_over`: queries in spatial order start a few triangles away.
inline constexpr int max_steps_over = 8;

/// Walks from `slot` across the edge that p is furthest outside of, until p lies over a triangle or the walk has taken
/// its steps; returns the triangle where it ends. Looks at no distances.
inline std::uint32_t step_over(const Bvh::Data& data, const Vec3& p, std::uint32_t slot) {
  std::uint32_t before = no_slot;
  for (int step = 0; step < max_steps_over; ++step) {
    const std::size_t edge = edge_towards(data, slot, triangle_at(data, slot), p);
    if (edge == 3) return slot;
    const Neighbour across = data.neighbours[slot][edge];
    if (across.slot == no_slot || across.slot == before) return slot;
    before = slot;
    slot = across.slot;
  }
  return slot;
}

/// `separation` by the offset from the closest point. Where rounding spoils that direction: by the offset in extended
/// precision and by the normal of the triangle, each also made perpendicular to an edge, as it is wherever the closest
/// point lies on that edge or inside (needles, slivers, points next to the surface).
inline double best_separation(const CornerTriangle<double>& t, const Vec3& p, double wanted) {
  double best = separation(t, p, closest_on_triangle(t, p).offset);
  if (best >= wanted) return best;
  const auto extended = [](const Vec3& v) { return Vec<DoubleDouble>{v.x, v.y, v.z}; };
  const CornerTriangle<DoubleDouble> fine{extended(t.a), extended(t.ab), extended(t.ac)};
  const Vec<DoubleDouble> offset = closest_on_triangle(fine, extended(p)).offset;
  const Vec3 normal = cross(t.ab, t.ac);
  for (const Vec3& direction :
       {Vec3{static_cast<double>(offset.x), static_cast<double>(offset.y), static_cast<double>(offset.z)}, normal,
        Vec3{} - normal}) {
    best = std::max(best, separation(t, p, direction));
    for (const Vec3& edge : {t.ab, t.ac, t.ac - t.ab}) {
      const double along = dot(direction, edge) * detail::reciprocal(dot(edge, edge));
      best = std::max(best, separation(t, p, direction - along * edge));
    }
  }
  return best;
}

/// A proven lower bound (but for `dual_error`) of the distance of p to the whole mesh: every triangle is either in a
/// box beyond `nearest_squared`, or separated from p by a plane.
inline double certified_distance(const Bvh::Data& data, const Vec3& p, double nearest_squared,
                                 QueryCounters& counters) {
  ++counters.queries;
  double least = std::sqrt(nearest_squared);
  const Vec<Double4> p4 = broadcast4(p);
  visit_near(data, p, nearest_squared, counters, [&](std::uint32_t block) {
    counters.triangles += block_width;
    const std::array<std::uint32_t, block_width> slots = slots_of_block(data, block);
    const CornerTriangle<Double4> t = triangles_at(data, slots);
    // What `best_separation` begins with, which mostly is enough.
    const Double4 separated = separation(t, p4, closest_on_triangle(t, p4).offset);
    const Mask4 passes = separated >= broadcast4(least);
    constexpr unsigned all_lanes = (1U << block_width) - 1;
    for (unsigned fails = ~lane_bits(passes) & all_lanes; fails != 0; fails &= fails - 1) {
      const std::uint32_t slot = slots[static_cast<std::size_t>(std::countr_zero(fails))];
      least = std::min(least, best_separation(triangle_at(data, slot), p, least));
    }
    return nearest_squared;
  });
  return least;
}

}  // namespace MESHBOUND_ISA
}  // namespace meshbound
