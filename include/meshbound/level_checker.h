// SPDX-License-Identifier: MIT
#pragma once
#include <memory>

#include "meshbound/bvh.h"
#include "meshbound/distance.h"

namespace meshbound {

/// One original against many levels: of a chain of levels of detail, or of a mesh that an editor changes step by step.
/// The original's tree is built once. Proofs that a triangle is near enough, and closest triangles to begin with, are
/// kept from level to level; what did not change is not checked again:
///
///     level -> original    a triangle that is, bit for bit, one of the level before keeps its bound
///     original -> level    a triangle keeps its bound while the level's triangles that it was covered by are there
///
/// Levels may come in any order, of any size and numbering; an unrelated one only gains nothing. Answers carry the same
/// guarantees as those of `check_tolerance` and `hausdorff_distance`; as other points and pieces are looked at, bounds
/// may differ inside these guarantees. `DistanceStats::proven_before` counts the triangles that were not checked.
/// Not thread-safe: use one per thread. Memory: 30 to 50 bytes per triangle of the original and of one level. Where
/// nothing can be kept, writing proofs down makes a check 3 to 10% slower than `check_tolerance` (measured).
class LevelChecker {
 public:
  /// Builds a tree of its own. Throws as `Bvh`.
  explicit LevelChecker(const MeshView& original, const BvhOptions& options = {});
  /// Uses a tree that must outlive this. After a refit of the tree, or when another tree is moved into it, everything
  /// is checked anew.
  explicit LevelChecker(const Bvh& original);
  LevelChecker(LevelChecker&&) noexcept;             ///< a moved-from object may only be destroyed or assigned to
  LevelChecker& operator=(LevelChecker&&) noexcept;  ///< a moved-from object may only be destroyed or assigned to
  ~LevelChecker();

  /// Decides H(original, level) <= tolerance; `a` of the result is the original. Throws as `Bvh` and `check_tolerance`;
  /// then what was kept stays as it was. O(n log n) for the level's tree, and the search for what changed.
  [[nodiscard]] ToleranceCheck check(const MeshView& level, double tolerance, const DistanceOptions& options = {});

  /// Measures H(original, level); `a` of the result is the original. The kept bounds save work where they lie below the
  /// distance plus the error bound. Throws as `Bvh` and `hausdorff_distance`; then what was kept stays as it was. O(n
  /// log n) for the level's tree, and the search for what changed.
  [[nodiscard]] HausdorffDistance measure(const MeshView& level, const DistanceOptions& options = {});

  [[nodiscard]] const Bvh& original() const;  ///< its tree

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace meshbound
