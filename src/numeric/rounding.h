// SPDX-License-Identifier: MIT
/// The floating-point model behind every bound, and the constants derived from it.
///
/// Model. IEEE 754 double, round to nearest, no contraction, no flush to zero (src/CMakeLists.txt sets the flags,
/// `check_floating_point_model` tests them when the first tree is built). With u = 2^-53 each +, -, *, / and sqrt gives
/// the exact result times (1 + d), |d| <= u, plus at most 2^-1075 where it underflows.
///
/// Working frame. All geometry of a pair of models is held in coordinates of magnitude at most M (`Frame` gives M = 1
/// for the model that owns the tree). Every error below is a length in those units, at most k u M with k stated. An
/// underflow adds 2^-1075 << u, which the roundings up of each k absorb.
///
/// Distances that feed an upper bound (primal). The closest point of triangle (a, a+ab, a+ac) to p is never trusted: we
/// evaluate |p - q| for q = a + v ab + w ac with computed v, w >= 0, v + w <= 1 + 2u, or q on an edge likewise. Each
/// coordinate of the offset has terms of at most 2M, and is reached from exact inputs by: ab, ac (1 rounding each,
/// 2uM), p - a (2uM), two products (2uM each), two differences (4uM and 6uM). Sum: 20uM a coordinate, 35uM as a length;
/// along bc, bp and bc carry one more rounding each (4uM), 28uM a coordinate, 49uM as a length. The excess of v + w
/// moves q off the triangle by at most 2u * 2 sqrt(3) M < 7uM. The length of the offset from its coordinates has a
/// relative error of 3u, at most 3u * 2 sqrt(3) M < 11uM. Together less than 64uM (49 + 11 along bc, 35 + 7 + 11
/// inside).
///
/// Distances that feed a lower bound (dual). Whatever the direction n is, d(p, T) >= min over the corners c of T of
/// n.(p - c) / |n|, because T lies in the half-space beyond its nearest corner. p - c carries 4uM a coordinate (7uM as
/// a length, with c = a + ab itself rounded), the dot product 3u |n| |p - c| <= 11u M |n|, the norm 3u and the quotient
/// u of at most 2 sqrt(3) M (14uM). Together less than 32uM.
///
/// Cuts. A new corner x = s + t (e - s) of a piece, 0 <= t <= 1, misses the exact point of that parameter by 2uM (e -
/// s), 2uM (product) and uM (the sum, itself at most M): 5uM a coordinate, less than 9uM as a length. The pieces on
/// both sides share x, so they cover a surface that is displaced from the piece by at most 9uM for each cut on the way
/// down; the distance to a mesh is 1-Lipschitz, so that is what the bounds lose.
///
/// Changing frames. Mapping a point by scale 2^k, rotation and translation costs at most `Mapping::error`.
///
/// Where these errors enter the bounds: `Goal::proven_upper` and `Goal::proven_lower` (proof/goal.h), with the slacks
/// that `set_slack` (distance/kernel/search_kernel.h) makes of the constants below.
#pragma once
#include <cmath>
#include <limits>

namespace meshbound {

inline constexpr double unit_roundoff = 0x1p-53;

/// Largest errors of the model above, in units of u M. Rounded up to powers of two to leave room.
inline constexpr double primal_error = 64 * unit_roundoff;
inline constexpr double dual_error = 64 * unit_roundoff;
inline constexpr double cut_error = 16 * unit_roundoff;

inline double next_up(double x) { return std::nextafter(x, std::numeric_limits<double>::infinity()); }
inline double next_down(double x) { return std::nextafter(x, -std::numeric_limits<double>::infinity()); }

/// Throws `Error` when this build or process does not compute as the model says (`-ffast-math`, flush to zero, another
/// rounding mode, fused multiply-adds). Cheap; called by the calling thread of what needs the model. Threads that work
/// for it take over its mode (numeric/floating_point_mode.h).
void check_floating_point_model();

}  // namespace meshbound
