// SPDX-License-Identifier: MIT
#include "meshbound/level_checker.h"

#include <optional>

#include "distance/levels/level_surface.h"
#include "distance/symmetric.h"
#include "distance/unfinished.h"

namespace meshbound {

struct LevelChecker::Impl {
  /// What is known of the level that was checked last, for the original whose tree has that serial number.
  struct Known {
    std::uint64_t original_serial = 0;
    LevelSurface level;
    SearchMemory from_original;  ///< faces are slots of the level's tree
    SearchMemory from_level;
  };

  explicit Impl(const Bvh& model) : original(&model) {}
  Impl(const MeshView& model, const BvhOptions& options) : own(std::in_place, model, options), original(&*own) {}

  /// What a new level inherits before it is searched.
  [[nodiscard]] Known inherit(const Bvh::Data& tree, const MeshView& level) const {
    Known next;
    next.original_serial = original->data().serial;
    next.level = LevelSurface(tree, level);
    if (known && known->original_serial == next.original_serial) {
      const Successors successors(known->level, next.level);
      next.from_original = inherited_by_original(known->from_original, successors);
      next.from_level = inherited_by_level(known->from_level, successors, tree);
    } else {
      next.from_original.reset(original->data());
      next.from_level.reset(tree);
    }
    next.from_level.names_faces = false;
    return next;
  }

  /// Returns search(tree, options for it, memory), or `unfinished` where the time is over before there is a tree. What
  /// is known is replaced only when nothing threw.
  template <class Result, class Search>
  Result with_level(const MeshView& level, const DistanceOptions& options, Result unfinished, const Search& search) {
    const StopToken stop = stop_of_trees(options, StopToken::Clock::now());
    std::optional<Bvh> tree;
    try {
      tree.emplace(level, BvhOptions{.threads = options.threads, .stop = stop});
    } catch (const Stopped&) {
      return unfinished;
    }
    Known next = inherit(tree->data(), level);
    Result result = search(*tree, after_trees(options, stop), HausdorffMemory{&next.from_original, &next.from_level});
    known = std::move(next);
    return result;
  }

  std::optional<Bvh> own;
  const Bvh* original;
  std::optional<Known> known;
};

LevelChecker::LevelChecker(const MeshView& original, const BvhOptions& options)
    : impl_(std::make_unique<Impl>(original, options)) {}
LevelChecker::LevelChecker(const Bvh& original) : impl_(std::make_unique<Impl>(original)) {}
LevelChecker::LevelChecker(LevelChecker&&) noexcept = default;
LevelChecker& LevelChecker::operator=(LevelChecker&&) noexcept = default;
LevelChecker::~LevelChecker() = default;

ToleranceCheck LevelChecker::check(const MeshView& level, double tolerance, const DistanceOptions& options) {
  return impl_->with_level(level, options, unfinished_check(tolerance),
                           [&](const Bvh& tree, const DistanceOptions& rest, const HausdorffMemory& memory) {
                             return check_tolerance(*impl_->original, tree, tolerance, rest, memory);
                           });
}

HausdorffDistance LevelChecker::measure(const MeshView& level, const DistanceOptions& options) {
  return impl_->with_level(level, options, unfinished_distance(),
                           [&](const Bvh& tree, const DistanceOptions& rest, const HausdorffMemory& memory) {
                             return hausdorff_distance(*impl_->original, tree, rest, memory);
                           });
}

const Bvh& LevelChecker::original() const { return *impl_->original; }

}  // namespace meshbound
