// SPDX-License-Identifier: MIT
#include "distance/query_order.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "geometry/hilbert.h"

namespace meshbound {
namespace {

/// Fewer are answered before an order would pay.
constexpr std::size_t min_queries = 256;

/// Steps between queries, in units of the extent of their box over the root of their number: two to three for points on
/// a surface in Morton order, and the root of their number for points at random.
constexpr double max_mean_step = 8;
/// So many steps tell, evenly spread over the queries.
constexpr std::size_t max_steps = 1024;

bool follow_one_another(std::span<const Eigen::Vector3d> queries) {
  const std::size_t steps = std::min(queries.size() - 1, max_steps);
  Eigen::AlignedBox3d box;
  double sum = 0;
  for (std::size_t k = 0; k < steps; ++k) {
    const std::size_t i = k * (queries.size() - 1) / steps;
    box.extend(queries[i]);
    sum += (queries[i + 1] - queries[i]).lpNorm<1>();
  }
  const double most = max_mean_step * box.sizes().maxCoeff() / std::sqrt(static_cast<double>(queries.size()));
  return sum <= static_cast<double>(steps) * most;
}

}  // namespace

std::vector<std::uint32_t> order_of_queries(std::span<const Eigen::Vector3d> queries) {
  if (queries.size() < min_queries || queries.size() > std::numeric_limits<std::uint32_t>::max()) return {};
  if (follow_one_another(queries)) return {};

  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& query : queries) box.extend(query);
  const int index_bits = static_cast<int>(std::bit_width(queries.size() - 1)),
            bits = std::min((64 - index_bits) / 3, 21);
  const double cells = std::ldexp(1.0, bits) - 1, scale = cells / box.sizes().maxCoeff();
  // Coordinates that are not finite, which the search refuses, fall into any cell.
  const auto cell = [&](double x) { return static_cast<std::uint32_t>(std::min(cells, std::max(0.0, x * scale))); };
  std::vector<std::uint64_t> keys(queries.size());
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const Eigen::Vector3d from_min = queries[i] - box.min();
    keys[i] = hilbert_index(cell(from_min.x()), cell(from_min.y()), cell(from_min.z()), bits) << index_bits | i;
  }
  std::sort(keys.begin(), keys.end());
  const std::uint64_t index_mask = (std::uint64_t{1} << index_bits) - 1;
  std::vector<std::uint32_t> order(keys.size());
  std::transform(keys.begin(), keys.end(), order.begin(),
                 [&](std::uint64_t key) { return static_cast<std::uint32_t>(key & index_mask); });
  return order;
}

}  // namespace meshbound
