// SPDX-License-Identifier: MIT
/// What a search has proven so far: the current lower and upper bounds of h(A, B) (paper, Table 1), and the target
/// that decides which pieces of A still need work. Compiled once per instruction set.
#pragma once
#include <algorithm>
#include <cmath>
#include <span>

#include "bvh/nearest.h"
#include "proof/cover_record.h"
#include "proof/goal.h"

namespace meshbound {
inline namespace MESHBOUND_ISA {

class ProvenBounds {
 public:
  ProvenBounds(const Bvh::Data& target, const Goal& goal) : b_(target), goal_(goal) { set_lower({}); }

  /// Starts from a proven lower bound (0 is one); forgets the upper bound.
  void begin(const LowerBound& lower) {
    set_lower(lower);
    upper_squared_ = 0;
  }

  /// The triangle of A, by slot, that the points offered from now on belong to.
  void set_from(std::uint32_t from_slot) { from_slot_ = from_slot; }

  /// Offers a point of A, made by `cuts` cuts, at a computed squared distance to the nearest triangle of B: raises the
  /// lower bound if it proves one.
  void offer(const Vec3& p, const Nearest& nearest, std::uint32_t cuts) {
    if (nearest.squared <= offered_squared_) return;
    const double certified = certified_distance(b_, p, nearest.squared, counters_.queries);
    if (std::sqrt(nearest.squared) - certified <= goal_.slack) offered_squared_ = nearest.squared;
    const double proven = goal_.proven_lower(certified, cuts);
    if (proven > lower_.lower) set_lower({proven, p, nearest.slot, from_slot_});
  }

  /// From now on each piece that is accepted leaves the triangle of B that bounds it here; null: nowhere.
  void record_in(CoverRecord* record) { record_ = record; }

  /// Records that a piece of A is within this squared distance of B, of the triangle at `slot` where that is known, and
  /// needs no more work.
  void accept(double squared, std::uint32_t slot = no_slot) {
    if (is_recorded(squared) && slot != record_->last) record_->add(slot);
  }
  /// As above, for a piece that several triangles bound together.
  void accept(double squared, std::span<const std::uint32_t> slots) {
    if (is_recorded(squared)) record_->add(slots);
  }
  [[nodiscard]] bool accepts(double squared) const { return squared <= accepted_squared_; }

  /// Accepts a piece whose bound meets the target; says whether it did.
  bool done_with(double squared, std::uint32_t slot = no_slot) {
    if (!accepts(squared)) return false;
    accept(squared, slot);
    return true;
  }

  /// Accepts a piece with the bound it has, as it is too deep or the budget ran out.
  void give_up(double squared) {
    accept(squared);
    ++counters_.given_up;
  }

  /// In a decision: nothing more needs to be looked at.
  [[nodiscard]] bool decided() const { return goal_.decide_only && lower_.lower > goal_.tolerance; }

  [[nodiscard]] const Goal& goal() const { return goal_; }
  [[nodiscard]] double accepted_squared() const { return accepted_squared_; }
  [[nodiscard]] double upper_squared() const { return upper_squared_; }
  [[nodiscard]] const LowerBound& lower() const { return lower_; }
  [[nodiscard]] const Bvh::Data& target() const { return b_; }
  [[nodiscard]] WalkCounters& counters() { return counters_; }
  [[nodiscard]] const WalkCounters& counters() const { return counters_; }

 protected:
  const Bvh::Data& b_;
  Goal goal_;
  LowerBound lower_;
  double accepted_squared_ = 0;
  double offered_squared_ = 0;
  double upper_squared_ = 0;
  std::uint32_t from_slot_ = 0;
  CoverRecord* record_ = nullptr;
  WalkCounters counters_;

 private:
  /// Raises the upper bound, also that of the record, if there is one.
  bool is_recorded(double squared) {
    upper_squared_ = std::max(upper_squared_, squared);
    if (record_ != nullptr) record_->squared = std::max(record_->squared, squared);
    return record_ != nullptr;
  }
  void set_lower(const LowerBound& lower) {
    lower_ = lower;
    const double accepted = goal_.accepted(lower.lower);
    // Room for the roundings, of 16 u at most, that turn a distance into an upper bound again: corners on a chord are
    // placed exactly at the target.
    accepted_squared_ = accepted * accepted * (1 - 64 * 0x1p-53);
    offered_squared_ = (lower.lower + goal_.slack) * (lower.lower + goal_.slack);
  }
};

}  // namespace MESHBOUND_ISA
}  // namespace meshbound
