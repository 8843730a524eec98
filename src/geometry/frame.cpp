// SPDX-License-Identifier: MIT
#include "geometry/frame.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "geometry/magnitude.h"
#include "numeric/rounding.h"

namespace meshbound {
namespace {

/// A model further from the origin than this many of its sizes is centred; nearer ones lose only a few bits to their
/// offset.
constexpr double far_offset = 8;

/// For a model that is a single point: smaller than any other model in its neighbourhood.
constexpr int point_exponent = -1020;

Vec3 scaled(const Vec3& v, int exponent) {
  return {std::ldexp(v.x, exponent), std::ldexp(v.y, exponent), std::ldexp(v.z, exponent)};
}

/// What x - c loses to rounding: the exact residual of Knuth's two-sum.
double difference_residual(double x, double c) {
  const double d = x - c, back = d + c;
  return std::fabs((x - back) + ((back - d) - c));
}

/// What scaling d by 2^-exponent loses: nothing, but where a coordinate becomes a denormal number, which then is off by
/// at most 2^-1075. sqrt(3) 2^-1075 < 2^-1074.
double underflow(const Vec3& d, int exponent) {
  if (exponent <= 0) return 0;
  const auto least = std::bit_cast<double>(static_cast<std::uint64_t>(exponent + 1) << 52);  // 2^(exponent - 1022)
  const auto is_lost = [least](double x) { return (x != 0) & (std::fabs(x) < least); };
  return is_lost(d.x) | is_lost(d.y) | is_lost(d.z) ? 0x1p-1074 : 0;
}

/// Multiples of a power of two no smaller than the size: c has few bits, so x - c is exact for |x - c| <= |x|.
double coarse_center(double lo, double hi, double size) {
  const double middle = lo / 2 + hi / 2;
  int exponent = 0;
  std::frexp(size, &exponent);
  const double grid = std::ldexp(1.0, std::max(exponent, -1000));
  return std::fabs(middle) / grid < 0x1p52 ? std::round(middle / grid) * grid : middle;
}

}  // namespace

Vec3 Frame::to_working(const Vec3& p) const { return scaled(p - center, -exponent); }

Vec3 Frame::to_model(const Vec3& w) const { return scaled(w, exponent) + center; }

double Frame::rounding_of(const Vec3& p) const {
  const double lost = underflow(p - center, exponent);
  if (center.x == 0 && center.y == 0 && center.z == 0) return lost;
  const double residual =
      difference_residual(p.x, center.x) + difference_residual(p.y, center.y) + difference_residual(p.z, center.z);
  return residual > 0 ? next_up(std::ldexp(next_up(residual), -exponent) + lost) : lost;
}

double Frame::length_up(double working) const {
  const double model = std::ldexp(working, exponent);
  return std::ldexp(model, -exponent) >= working ? model : next_up(model);
}

double Frame::length_down(double working) const {
  const double model = std::ldexp(working, exponent);
  return std::ldexp(model, -exponent) <= working ? model : next_down(model);
}

double Frame::working_length_down(double model) const {
  const double working = std::ldexp(model, -exponent);
  return std::ldexp(working, exponent) <= model ? working : next_down(working);
}

Frame frame_for_box(const Vec3& lo, const Vec3& hi) {
  Frame frame;
  const double size = largest_magnitude_of(hi - lo),
               reach = std::max(largest_magnitude_of(lo), largest_magnitude_of(hi));
  if (reach > far_offset * size) {
    frame.center = size > 0 ? Vec3{coarse_center(lo.x, hi.x, size), coarse_center(lo.y, hi.y, size),
                                   coarse_center(lo.z, hi.z, size)}
                            : lo;
  }
  const double radius = std::max(largest_magnitude_of(lo - frame.center), largest_magnitude_of(hi - frame.center));
  frame.exponent = point_exponent;
  if (radius > 0) std::frexp(radius, &frame.exponent);
  return frame;
}

}  // namespace meshbound
