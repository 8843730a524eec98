// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <span>
#include <vector>

#include "meshbound/bvh.h"
#include "meshbound/deviation_map.h"

namespace meshbound {

/// Calls take(i, found) with what `closest_points` finds on `other` for each of the points, in order and on the calling
/// thread. Throws `Stopped` soon after the options say so, and as `closest_points`.
template <class Take>
void measure_points(std::span<const Eigen::Vector3d> points, const Bvh& other, const DeviationOptions& options,
                    Take&& take) {
  constexpr std::size_t points_per_batch = std::size_t{1} << 16;  // answers take 10 MB
  for (std::size_t begin = 0; begin < points.size(); begin += points_per_batch) {
    const auto batch = points.subspan(begin, std::min(points_per_batch, points.size() - begin));
    const std::vector<ClosestPoint> found = closest_points(other, batch, {options.threads, options.stop});
    for (std::size_t i = 0; i < found.size(); ++i) take(begin + i, found[i]);
  }
}

}  // namespace meshbound
