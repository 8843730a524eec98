// SPDX-License-Identifier: MIT
#include "tiles/plane_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace meshbound {
namespace {

/// Fewer keys than these of a sample say nothing about where the plane lies: all items between the known keys are
/// sampled anew. With so many, the range that is expected is smaller than the one that is known.
constexpr std::size_t min_keys = 8;

constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

const Vec3& CutExtent::longest_axis() const {
  Eigen::Index axis = 0;
  box_.sizes().maxCoeff(&axis);
  return (*axes_)[static_cast<std::size_t>(axis)];
}

void CutSample::add(const CutItem& item) {
  if (given_++ % step_ != 0) return;
  if (items_.size() == max_items_) {
    step_ *= 2;
    for (std::size_t i = 1; 2 * i < items_.size(); ++i) items_[i] = items_[2 * i];
    items_.resize((items_.size() + 1) / 2);
    if ((given_ - 1) % step_ != 0) return;
  }
  items_.push_back(item);
}

PlaneSearch::PlaneSearch(CutPart part, const CutAxes& axes, std::size_t rank)
    : axis_(part.extent.longest_axis()),
      rank_(rank),
      sample_(std::move(part.sample)),
      low_{-infinity, 0},
      high_{infinity, 0},
      within_(part.extent.count()),
      before_(axes),
      behind_(axes) {}

void PlaneSearch::begin_round(std::size_t max_items) {
  before_.clear();
  behind_.clear();
  between_ = CutSample(max_items);
  from_ = low_;
  to_ = high_;
  std::vector<CutKey> keys;
  for (const CutItem& item : sample_)
    if (const CutKey key = key_of(item, axis_); !(key < low_) && key < high_) keys.push_back(key);
  if (keys.size() < min_keys) return;
  std::sort(keys.begin(), keys.end());
  // Where samples are taken at random, the share of keys before the middle is off by sqrt(keys) / 2 one time in three.
  const auto keys_before = static_cast<std::size_t>(static_cast<double>(keys.size()) *
                                                    static_cast<double>(rank_ - below_) / static_cast<double>(within_));
  const std::size_t margin = 1 + static_cast<std::size_t>(std::sqrt(static_cast<double>(keys.size())));
  if (keys_before >= margin) from_ = keys[keys_before - margin];
  if (keys_before + margin < keys.size()) to_ = keys[keys_before + margin];
}

std::optional<CutPlane> PlaneSearch::end_round() {
  const std::size_t before = before_.count(), until = before + between_.given();
  if (rank_ < before) {  // the sample has misled
    high_ = from_;
    within_ = before - below_;
    sample_.clear();
    return std::nullopt;
  }
  if (rank_ >= until) {
    low_ = to_;
    within_ -= until - below_;
    below_ = until;
    sample_.clear();
    return std::nullopt;
  }
  std::vector<CutItem>& items = between_.items();
  if (!between_.has_all()) {
    low_ = from_;
    high_ = to_;
    below_ = before;
    within_ = between_.given();
    sample_ = std::move(items);
    return std::nullopt;
  }
  const auto first_behind = items.begin() + static_cast<std::ptrdiff_t>(rank_ - before);
  std::nth_element(items.begin(), first_behind, items.end(), [&](const CutItem& item, const CutItem& other) {
    return key_of(item, axis_) < key_of(other, axis_);
  });
  std::for_each(items.begin(), first_behind, [&](const CutItem& item) { before_.add(item); });
  std::for_each(first_behind, items.end(), [&](const CutItem& item) { behind_.add(item); });
  return CutPlane{axis_, key_of(*first_behind, axis_)};
}

std::pair<CutPart, CutPart> PlaneSearch::halves(const CutPlane& plane) {
  std::vector<CutItem> behind;
  std::erase_if(sample_, [&](const CutItem& item) {
    if (plane.has_behind(item)) behind.push_back(item);
    return plane.has_behind(item);
  });
  return {{before_, std::move(sample_)}, {behind_, std::move(behind)}};
}

}  // namespace meshbound
