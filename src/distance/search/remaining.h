// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

namespace meshbound {

/// The triangles of A that no step of a search has bounded yet: each step takes what the one before it left over. At
/// first these are all triangles, then all but those that are flagged as dropped, and in the end a list of slots, since
/// the flags of a large model cost more to read than few triangles to bound. Not thread-safe while triangles are
/// dropped.
class Remaining {
 public:
  /// All triangles of a model.
  explicit Remaining(std::uint32_t triangle_count) : triangle_count_(triangle_count) {}
  /// A list of slots.
  Remaining(std::uint32_t triangle_count, std::vector<std::uint32_t> slots)
      : triangle_count_(triangle_count), slots_(std::move(slots)), listed_(true) {}

  [[nodiscard]] bool is_list() const { return listed_; }
  [[nodiscard]] bool is_whole() const { return !listed_ && alive_.empty(); }

  /// The flags by slot, 0 for a triangle that is dropped. Not to be called once this is a list.
  [[nodiscard]] std::vector<std::uint8_t>& flags() {
    if (alive_.empty()) alive_.assign(triangle_count_, 1);
    return alive_;
  }

  /// Slots to look at: slot(0) ... slot(size() - 1), of which a list holds only those that are left.
  [[nodiscard]] std::uint32_t size() const {
    return listed_ ? static_cast<std::uint32_t>(slots_.size()) : triangle_count_;
  }
  [[nodiscard]] std::uint32_t slot(std::uint32_t i) const { return listed_ ? slots_[i] : i; }
  /// Whether a slot that was to be looked at is left.
  [[nodiscard]] bool holds(std::uint32_t slot) const { return listed_ || alive_.empty() || alive_[slot] != 0; }
  [[nodiscard]] bool holds_any(std::uint32_t begin, std::uint32_t end) const {
    return alive_.empty() ||
           std::find(alive_.begin() + begin, alive_.begin() + end, std::uint8_t{1}) != alive_.begin() + end;
  }

  /// These triangles as a list, unless none has been dropped.
  [[nodiscard]] Remaining listed() && {
    if (listed_ || is_whole()) return std::move(*this);
    std::vector<std::uint32_t> slots;
    for (std::uint32_t slot = 0; slot < triangle_count_; ++slot)
      if (alive_[slot] != 0) slots.push_back(slot);
    return {triangle_count_, std::move(slots)};
  }

 private:
  std::uint32_t triangle_count_;
  std::vector<std::uint8_t> alive_;  ///< by slot; empty: all are
  std::vector<std::uint32_t> slots_;
  bool listed_ = false;
};

}  // namespace meshbound
