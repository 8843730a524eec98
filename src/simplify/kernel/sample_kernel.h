// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "geometry/vec3.h"

namespace meshbound {

/// Points in single precision, in blocks of eight, near an origin of their own: a guide needs no more.
struct SamplePoints {
  struct alignas(32) Block {
    float x[8] = {}, y[8] = {}, z[8] = {};
    float weight[8] = {};  ///< 0 for those that fill up the last block
    bool operator==(const Block&) const = default;
  };
  std::vector<Block> blocks;

  void clear() { blocks.clear(), lane_ = 8; }
  void add(Vec3 p) {
    if (lane_ == 8) blocks.emplace_back(), lane_ = 0;
    Block& block = blocks.back();
    block.x[lane_] = static_cast<float>(p.x);
    block.y[lane_] = static_cast<float>(p.y);
    block.z[lane_] = static_cast<float>(p.z);
    block.weight[lane_++] = 1;
  }
  /// Two points change places.
  void swap(std::size_t i, std::size_t j) {
    Block &of_i = blocks[i / 8], &of_j = blocks[j / 8];
    std::swap(of_i.x[i % 8], of_j.x[j % 8]);
    std::swap(of_i.y[i % 8], of_j.y[j % 8]);
    std::swap(of_i.z[i % 8], of_j.z[j % 8]);
  }
  [[nodiscard]] std::size_t size() const { return 8 * blocks.size() - (8 - lane_); }
  [[nodiscard]] Vec3 at(std::size_t i) const {
    const Block& block = blocks[i / 8];
    return {block.x[i % 8], block.y[i % 8], block.z[i % 8]};
  }

 private:
  std::size_t lane_ = 8;  ///< the next one of the last block
};

/// A triangle a, a + ab, a + ac with what does not depend on the point that is asked for.
struct SampleFace {
  Vec<float> a, ab, ac;
  float ab_ab = 0, ab_ac = 0, ac_ac = 0;
  float by_area = 0, by_ab = 0, by_ac = 0, by_bc = 0;  ///< reciprocals of squares, 0 where these are
  bool shares_ac = false;                              ///< with another face, whose ab it is

  SampleFace(Vec3 corner, Vec3 second, Vec3 third);
};

/// Notes which faces share their side ac: in the fan around a vertex all do but those at a border.
void note_shared_sides(std::span<SampleFace> faces);

/// The sum over points of (distance / tolerance)^6, with its slope when corner a of every face is moved: for Newton's
/// method, distances as to a plane through the closest point.
struct DeviationSums {
  double sum = 0, worst_squared = 0;  ///< the largest (distance / tolerance)^2
  double gradient[3] = {0, 0, 0};
  double curvature[6] = {0, 0, 0, 0, 0, 0};  ///< xx, yy, zz, xy, yz, zx

  /// A point `offset` (in tolerances) off its closest one, which moves by `share` of what the corner does.
  void add(Vec3 offset, double share);
};

/// Vectors to eight points from the closest point that some faces have to each, the share that corner a has of that
/// point, and which face it lies on.
struct alignas(32) SampleOffsets {
  float x[8], y[8], z[8], squared[8], share[8], face[8];
  bool operator==(const SampleOffsets&) const = default;
};

/// Squared distances of eight points from the closest of some faces, and which one that is.
struct alignas(32) SampleDistances {
  float squared[8], face[8];
  bool operator==(const SampleDistances&) const = default;
};

/// The inner loops over sample points, see `SimplifyKernels`.
struct SampleKernel {
  /// Offsets of all points, by block; there must be a face.
  void (*offsets)(std::span<const SamplePoints::Block> points, std::span<const SampleFace> faces,
                  std::span<SampleOffsets> offsets);
  /// What `offsets` says of distances alone, in less time.
  void (*distances)(std::span<const SamplePoints::Block> points, std::span<const SampleFace> faces,
                    std::span<SampleDistances> distances);
  /// Adds the points, each against the face nearest to it. `by_tolerance` is 1 / tolerance.
  void (*add_deviations)(const SamplePoints& points, std::span<const SampleFace> faces, float by_tolerance,
                         DeviationSums& sums);
};

}  // namespace meshbound
