// SPDX-License-Identifier: MIT
#include "simplify/cover/candidate_faces.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace meshbound {

void CandidateFaces::clear(double tolerance) {
  tolerance_ = tolerance;
  squared_tolerance_ = tolerance * tolerance;
  size_ = 0;
}

void CandidateFaces::add(const TriangleCorners& corners) {
  const int k = size_++;
  corners_[k] = corners;
  prepared_ &= ~(FaceMask{1} << k);
  missing_ |= 1U << (k / PlaneBlock::lanes);
}

void CandidateFaces::make_planes(std::size_t block) {
  const std::size_t first = block * PlaneBlock::lanes;
  const unsigned flat = kernel_.set(blocks_[block], &corners_[first], tolerance_, plane_slack * tolerance_);
  flat_ = (flat_ & ~(FaceMask{15} << first)) | FaceMask{flat} << first;
  missing_ &= ~(1U << block);
}

const PreparedTriangle& CandidateFaces::triangle(int k) {
  PreparedTriangle& triangle = triangles_[k];
  if (((prepared_ >> k) & 1U) == 0) {
    const auto& [a, b, c] = corners_[k];
    triangle = PreparedTriangle({a, b - a, c - a});
    prepared_ |= FaceMask{1} << k;
  }
  return triangle;
}

bool CandidateFaces::holds(int k, Vec3 p) { return triangle(k).is_within(p, squared_tolerance_); }

FaceMask CandidateFaces::holding(Vec3 p, FaceMask among) {
  const double squared_reach = squared_tolerance_ * (1 + 2 * plane_slack);
  FaceMask mask = 0;
  for (FaceMask rest = among; rest != 0;) {
    const int first = std::countr_zero(rest) / PlaneBlock::lanes * PlaneBlock::lanes;
    const unsigned wanted = static_cast<unsigned>(among >> first) & 15U;
    rest &= ~(FaceMask{15} << first);
    const SlabBits bits =
        kernel_.test(planes(static_cast<std::size_t>(first / PlaneBlock::lanes)), p, tolerance_, squared_reach);
    const unsigned inside = bits.inside & wanted & static_cast<unsigned>(flat_ >> first);
    mask |= FaceMask{inside} << first;
    for (unsigned doubtful = (bits.inside | bits.outside) & wanted & ~inside; doubtful != 0; doubtful &= doubtful - 1) {
      const int k = first + std::countr_zero(doubtful);
      if (holds(k, p)) mask |= FaceMask{1} << k;
    }
  }
  return mask;
}

FaceMask CandidateFaces::nearest(Vec3 p, FaceMask among) {
  FaceMask best = 0;
  double min_squared = HUGE_VAL;
  for (FaceMask rest = among; rest != 0; rest &= rest - 1) {
    const double squared = triangle(std::countr_zero(rest)).closest(p).squared_distance;
    if (best != 0 && !(squared < min_squared)) continue;
    min_squared = squared;
    best = rest & (~rest + 1);
  }
  return best;
}

Reach CandidateFaces::reach(Vec3 p, Vec3 q, FaceMask of_p, FaceMask of_q) {
  // Past the side planes by this share of the tolerance a point is still well within it unless it is also high above.
  const double rim = 0.3 * tolerance_;
  constexpr double unknown = 0.5;
  Reach reach;
  for (FaceMask rest = of_p | of_q; rest != 0;) {
    const std::size_t block = static_cast<std::size_t>(std::countr_zero(rest)) / PlaneBlock::lanes;
    const std::size_t first = block * PlaneBlock::lanes;
    rest &= ~(FaceMask{15} << first);
    const unsigned forth = static_cast<unsigned>(of_p >> first) & 15U,
                   back = static_cast<unsigned>(of_q >> first) & 15U;
    const PlaneBlock& at = planes(block);
    const unsigned flat = static_cast<unsigned>(flat_ >> first);
    const Reach here = kernel_.reach(at, forth & flat, back & flat, p, q, tolerance_, rim);
    reach.forth = std::max({reach.forth, here.forth, (forth & ~flat) != 0 ? unknown : 0});
    reach.back = std::max({reach.back, here.back, (back & ~flat) != 0 ? unknown : 0});
  }
  return reach;
}

}  // namespace meshbound
