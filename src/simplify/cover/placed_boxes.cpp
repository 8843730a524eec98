// SPDX-License-Identifier: MIT
#include "simplify/cover/placed_boxes.h"

#include <algorithm>
#include <cmath>

#include "meshbound/mesh_summary.h"

namespace meshbound {
namespace {

using Boxes = std::vector<Eigen::AlignedBox3d>;

/// The exponent of the mean diagonal of the boxes whose counterpart in `counted` is not empty; 0 where that mean is 0
/// or no number.
int exponent_of_size(const Boxes& boxes, const Boxes& counted) {
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < boxes.size(); ++i)
    if (!counted[i].isEmpty()) sum += diagonal_of(boxes[i]), ++count;
  const double mean = sum / count;
  return std::isnormal(mean) ? std::ilogb(mean) : 0;
}

PlacedBoxes::BoxOfBoth placed(const Eigen::AlignedBox3d& in_texture, const Eigen::AlignedBox3d& in_space,
                              int exponent) {
  PlacedBoxes::BoxOfBoth box;
  const auto scaled = [exponent](double x) { return std::ldexp(x, exponent); };
  box.min() << scaled(in_texture.min().x()), scaled(in_texture.min().y()), in_texture.min().z(), in_space.min();
  box.max() << scaled(in_texture.max().x()), scaled(in_texture.max().y()), in_texture.max().z(), in_space.max();
  return box;
}

std::vector<PlacedBoxes::BoxOfBoth> placed(const Boxes& in_texture, const Boxes& in_space, int exponent) {
  std::vector<PlacedBoxes::BoxOfBoth> boxes(in_texture.size());
  for (std::size_t i = 0; i < boxes.size(); ++i)
    if (!in_texture[i].isEmpty()) boxes[i] = placed(in_texture[i], in_space[i], exponent);
  return boxes;
}

/// Boxes that are looked at, from all over a mesh, and the boxes that each of them meets on average from which on many
/// share a part of the texture. Where every triangle meets those around it only, these are some 20; then a second tree
/// is not worth its time: a run with a texture tolerance executes 8% more (DamagedHelmet at 1%).
constexpr std::size_t samples = 256, many_met = 48;

bool are_crowded(const BoxTree& tree, const Boxes& boxes) {
  const std::size_t step = boxes.size() / samples + 1;
  std::vector<std::uint32_t> met;
  std::size_t looked_at = 0;
  for (std::size_t i = 0; i < boxes.size(); i += step) {
    if (boxes[i].isEmpty()) continue;
    ++looked_at;
    tree.find(boxes[i], met);
  }
  return met.size() > many_met * looked_at;
}

}  // namespace

PlacedBoxes::PlacedBoxes(const Boxes& in_texture, const Boxes& in_space) : in_texture_(in_texture) {
  if (!are_crowded(in_texture_, in_texture)) return;
  exponent_ = exponent_of_size(in_space, in_texture) - exponent_of_size(in_texture, in_texture);
  in_both_.emplace(placed(in_texture, in_space, exponent_));
  rank_.resize(in_texture.size());
  for (std::uint32_t k = 0; k < rank_.size(); ++k) rank_[in_texture_.order()[k]] = k;
}

void PlacedBoxes::find(const Eigen::AlignedBox3d& in_texture, const Eigen::AlignedBox3d& in_space,
                       std::vector<std::uint32_t>& found) const {
  if (!in_both_) return in_texture_.find(in_texture, found);
  const auto before = static_cast<std::ptrdiff_t>(found.size());
  in_both_->find(placed(in_texture, in_space, exponent_), found);
  std::sort(found.begin() + before, found.end(),
            [this](std::uint32_t i, std::uint32_t j) { return rank_[i] < rank_[j]; });
}

}  // namespace meshbound
