// SPDX-License-Identifier: MIT
/// Compiled once per instruction set (numeric/isa.h).
#pragma once
#include <cmath>

#include "numeric/simd.h"
#include "simplify/kernel/sample_kernel.h"

namespace meshbound {
inline namespace MESHBOUND_ISA {

inline Float8 load8(const float (&lanes)[8]) { return *reinterpret_cast<const Float8*>(lanes); }
inline void store8(float (&lanes)[8], Float8 values) { *reinterpret_cast<Float8*>(lanes) = values; }

/// How many blocks of eight these lanes reach over, one or two.
template <class Lanes>
constexpr std::size_t blocks_of = sizeof(Lanes) / sizeof(Float8);

/// The eight of block i and, where the lanes reach over two, those of the next one; zeros where there is none.
template <class Lanes, class Block>
inline Lanes load(std::span<const Block> blocks, std::size_t i, const float (Block::*eight)[8]) {
  if constexpr (blocks_of<Lanes> == 1)
    return load8(blocks[i].*eight);
  else
    return join<Lanes>(load8(blocks[i].*eight), i + 1 < blocks.size() ? load8(blocks[i + 1].*eight) : Float8{});
}
template <class Lanes, class Block>
inline void store(std::span<Block> blocks, std::size_t i, float (Block::*eight)[8], Lanes values) {
  if constexpr (blocks_of<Lanes> == 1) {
    store8(blocks[i].*eight, values);
  } else {
    store8(blocks[i].*eight, low_half(values));
    if (i + 1 < blocks.size()) store8(blocks[i + 1].*eight, high_half(values));
  }
}

inline Floats clamped(Floats x, Floats max) { return minimum(maximum(x, Floats{}), max); }

/// Offsets from closest points, by lane, and the share that corner a has of these.
struct OffsetLanes {
  Floats x, y, z, share, squared;

  OffsetLanes(Floats ox, Floats oy, Floats oz, Floats share_of_corner)
      : x(ox), y(oy), z(oz), share(share_of_corner), squared(ox * ox + oy * oy + oz * oz) {}
  [[nodiscard]] OffsetLanes or_nearer(const OffsetLanes& other) const {
    const FloatsMask nearer = other.squared < squared;
    OffsetLanes result = *this;
    result.x = nearer ? other.x : x;
    result.y = nearer ? other.y : y;
    result.z = nearer ? other.z : z;
    result.share = nearer ? other.share : share;
    result.squared = nearer ? other.squared : squared;
    return result;
  }
};

/// The least of the squared lengths of offsets, by lane.
struct LeastSquaredLanes {
  Floats squared;

  explicit LeastSquaredLanes(const OffsetLanes& offset) : squared(offset.squared) {}
  [[nodiscard]] LeastSquaredLanes or_nearer(const OffsetLanes& other) const {
    LeastSquaredLanes result = *this;
    result.squared = minimum(other.squared, squared);
    return result;
  }
};

/// What `Nearest` keeps of the offset from the closest point of a face. For any w the nearest point of the line through
/// w on ac and parallel to ab is found first: with the best w, that is the closest point unless it lies on ac or bc. A
/// shared side ac is left to the other face.
template <class Nearest>
inline Nearest nearest_on(const SampleFace& f, Floats x, Floats y, Floats z) {
  const Floats one = broadcast_floats(1);
  const Floats px = x - f.a.x, py = y - f.a.y, pz = z - f.a.z;
  const Floats on_ab = px * f.ab.x + py * f.ab.y + pz * f.ab.z;
  const Floats on_ac = px * f.ac.x + py * f.ac.y + pz * f.ac.z;
  const Floats w = clamped((f.ab_ab * on_ac - f.ab_ac * on_ab) * f.by_area, one);
  const Floats v = clamped((on_ab - w * f.ab_ac) * f.by_ab, one - w);
  const OffsetLanes inside(px - v * f.ab.x - w * f.ac.x, py - v * f.ab.y - w * f.ac.y, pz - v * f.ab.z - w * f.ac.z,
                           one - v - w);
  const Floats along = clamped((on_ac - on_ab - f.ab_ac + f.ab_ab) * f.by_bc, one), back = one - along;
  const OffsetLanes from_bc(px - back * f.ab.x - along * f.ac.x, py - back * f.ab.y - along * f.ac.y,
                            pz - back * f.ab.z - along * f.ac.z, Floats{});
  if (f.shares_ac) return Nearest(inside).or_nearer(from_bc);
  const Floats on = clamped(on_ac * f.by_ac, one);
  const OffsetLanes from_ac(px - on * f.ac.x, py - on * f.ac.y, pz - on * f.ac.z, one - on);
  return Nearest(inside).or_nearer(from_ac).or_nearer(from_bc);
}

/// The offset from the nearest face so far, and which one it is.
struct Closest {
  OffsetLanes offset{Floats{}, Floats{}, broadcast_floats(HUGE_VALF), Floats{}};
  Floats face{};

  void offer(const OffsetLanes& other, float index) {
    face = other.squared < offset.squared ? broadcast_floats(index) : face;
    offset = offset.or_nearer(other);
  }
};

inline Closest closest_of(std::span<const SamplePoints::Block> points, std::size_t i,
                          std::span<const SampleFace> faces) {
  using Block = SamplePoints::Block;
  Closest at;
  const Floats x = load<Floats>(points, i, &Block::x), y = load<Floats>(points, i, &Block::y),
               z = load<Floats>(points, i, &Block::z);
  for (std::size_t k = 0; k < faces.size(); ++k)
    at.offer(nearest_on<OffsetLanes>(faces[k], x, y, z), static_cast<float>(k));
  return at;
}

inline void offsets(std::span<const SamplePoints::Block> points, std::span<const SampleFace> faces,
                    std::span<SampleOffsets> offsets) {
  for (std::size_t i = 0; i < points.size(); i += blocks_of<Floats>) {
    const auto [at, face] = closest_of(points, i, faces);
    store(offsets, i, &SampleOffsets::x, at.x);
    store(offsets, i, &SampleOffsets::y, at.y);
    store(offsets, i, &SampleOffsets::z, at.z);
    store(offsets, i, &SampleOffsets::squared, at.squared);
    store(offsets, i, &SampleOffsets::share, at.share);
    store(offsets, i, &SampleOffsets::face, face);
  }
}

inline void distances(std::span<const SamplePoints::Block> points, std::span<const SampleFace> faces,
                      std::span<SampleDistances> distances) {
  using Block = SamplePoints::Block;
  for (std::size_t i = 0; i < points.size(); i += blocks_of<Floats>) {
    const Floats x = load<Floats>(points, i, &Block::x), y = load<Floats>(points, i, &Block::y),
                 z = load<Floats>(points, i, &Block::z);
    Floats least = broadcast_floats(HUGE_VALF), face{};
    for (std::size_t k = 0; k < faces.size(); ++k) {
      const Floats squared = nearest_on<LeastSquaredLanes>(faces[k], x, y, z).squared;
      face = squared < least ? broadcast_floats(static_cast<float>(k)) : face;
      least = minimum(squared, least);
    }
    store(distances, i, &SampleDistances::squared, least);
    store(distances, i, &SampleDistances::face, face);
  }
}

/// Sums over the even blocks and over the odd ones: a vector that is wide enough has both side by side.
template <class Sums>
class EvenAndOdd {
 public:
  /// `add(sums, i)` adds block i, and the next one where vectors are wide.
  template <class Add>
  EvenAndOdd(std::size_t blocks, const Add& add) {
    for (std::size_t i = 0; i < blocks; i += 2) add(even_, i);
    for (std::size_t i = 1; blocks_of<Floats> == 1 && i < blocks; i += 2) add(odd_, i);
  }
  /// One of the sums, by eight lanes, over all blocks.
  [[nodiscard]] Float8 of(Floats Sums::*sum) const {
    if constexpr (blocks_of<Floats> == 1)
      return even_.*sum + odd_.*sum;
    else
      return low_half(even_.*sum) + high_half(even_.*sum);
  }

 private:
  Sums even_, odd_;
};

/// The sums of `DeviationSums`, by lane.
struct DeviationLanes {
  Floats sum{}, gx{}, gy{}, gz{}, xx{}, yy{}, zz{}, xy{}, yz{}, zx{};

  /// Offsets in tolerances, of which corner a has these shares, and their squared lengths times the weights, 0 or 1.
  void add(Floats x, Floats y, Floats z, Floats share, Floats square, Floats weight) {
    const Floats fourth = weight * square * square;
    const Floats first = share * fourth, second = share * share * square;
    sum += fourth * square;
    gx += first * x, gy += first * y, gz += first * z;
    xx += second * x * x, yy += second * y * y, zz += second * z * z;
    xy += second * x * y, yz += second * y * z, zx += second * z * x;
  }
};

inline void add_deviations(const SamplePoints& points, std::span<const SampleFace> faces, float by_tolerance,
                           DeviationSums& sums) {
  const std::span<const SamplePoints::Block> blocks = points.blocks;
  Floats worst{};
  using L = DeviationLanes;
  const EvenAndOdd<DeviationLanes> lanes(blocks.size(), [&](L& into, std::size_t i) {
    const OffsetLanes at = closest_of(blocks, i, faces).offset;
    const Floats weight = load<Floats>(blocks, i, &SamplePoints::Block::weight);
    const Floats square = weight * at.squared * (by_tolerance * by_tolerance);
    worst = maximum(square, worst);
    into.add(at.x * by_tolerance, at.y * by_tolerance, at.z * by_tolerance, at.share, square, weight);
  });
  const auto sum_of = [&](Floats L::*of) {
    double sum = 0;
    for (int k = 0; k < 8; ++k) sum += double{lanes.of(of)[k]};
    return sum;
  };
  sums.sum += sum_of(&L::sum);
  sums.worst_squared = std::fmax(sums.worst_squared, double{largest_lane(worst)});
  sums.gradient[0] -= 6 * sum_of(&L::gx), sums.gradient[1] -= 6 * sum_of(&L::gy),
      sums.gradient[2] -= 6 * sum_of(&L::gz);
  sums.curvature[0] += 30 * sum_of(&L::xx), sums.curvature[1] += 30 * sum_of(&L::yy);
  sums.curvature[2] += 30 * sum_of(&L::zz), sums.curvature[3] += 30 * sum_of(&L::xy);
  sums.curvature[4] += 30 * sum_of(&L::yz), sums.curvature[5] += 30 * sum_of(&L::zx);
}

}  // namespace MESHBOUND_ISA
}  // namespace meshbound
