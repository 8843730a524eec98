// SPDX-License-Identifier: MIT
#include "simplify/mesh/crowded_edge.h"

#include <Eigen/Geometry>
#include <cmath>

namespace meshbound {
namespace {

/// Triangles of a smaller height over the edge, as a share of their longest side, have no angle: 16 roundings of
/// floats, which files hold, may turn them.
constexpr double min_share_of_height = 0x1p-20;

double largest_of(const Eigen::Vector3d& v) { return v.cwiseAbs().maxCoeff(); }

}  // namespace

AngleAroundEdge::AngleAroundEdge(const Eigen::Vector3d& from, const Eigen::Vector3d& to, const Eigen::Vector3d& zero)
    : from_(from), to_(to), along_(((to - from) / largest_of(to - from)).normalized()) {
  x_ = height(zero).value_or(along_.unitOrthogonal());
  y_ = along_.cross(x_);
}

std::optional<Eigen::Vector3d> AngleAroundEdge::height(const Eigen::Vector3d& corner) const {
  const double size = std::max(largest_of(corner - from_), largest_of(corner - to_));  // of no square: none overflows
  const Eigen::Vector3d way = (corner - from_) / size;
  const Eigen::Vector3d across = way - way.dot(along_) * along_;
  const double height = across.norm();
  if (!(height > min_share_of_height)) return std::nullopt;
  return across / height;
}

std::optional<double> AngleAroundEdge::of(const Eigen::Vector3d& corner) const {
  const auto across = height(corner);
  if (!across) return std::nullopt;
  const double x = across->dot(x_), y = across->dot(y_), share = x / (std::abs(x) + std::abs(y));
  return y < 0 ? 3 + share : 1 - share;
}

/// Pairs are brackets: seen counter-clockwise from outside, a face that runs downward has its back towards greater
/// angles, one that runs upward towards smaller ones. The order begins where no bracket is open.
std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs_around_edge(std::span<const std::uint8_t> runs_upward,
                                                                       bool around_material) {
  const auto size = static_cast<std::uint32_t>(runs_upward.size());
  const auto opens = [&](std::uint32_t i) { return (runs_upward[i] != 0) != around_material; };
  std::uint32_t first = 0;
  int open = 0, fewest_open = 0;
  for (std::uint32_t i = 0; i < size; ++i) {
    open += opens(i) ? 1 : -1;
    if (open >= fewest_open) continue;
    fewest_open = open;
    first = i + 1;
  }
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  if (open != 0) return pairs;
  std::vector<std::uint32_t> brackets;
  for (std::uint32_t k = 0; k < size; ++k) {
    const std::uint32_t i = (first + k) % size;
    if (opens(i)) {
      brackets.push_back(i);
      continue;
    }
    pairs.emplace_back(brackets.back(), i);
    brackets.pop_back();
  }
  return pairs;
}

}  // namespace meshbound
