// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace meshbound {

/// The order in which `closest_points` is to answer queries, by their indices: along a space-filling curve through
/// their box. Empty where they follow one another as they come. O(n), or O(n log n) where they are put in order.
std::vector<std::uint32_t> order_of_queries(std::span<const Eigen::Vector3d> queries);

}  // namespace meshbound
