// SPDX-License-Identifier: MIT
/// Levels of detail: one decimation with growing tolerances, each level bounded against the original itself.
#pragma once
#include <functional>
#include <memory>
#include <span>

#include "meshbound/error.h"
#include "meshbound/mesh_view.h"
#include "meshbound/simplify.h"

namespace meshbound {

/// A level of a chain. `distance` is a measurement of `mesh` against the original, independent of the decimation.
using LodLevel = SimplifiedLevel;

/// Options of a chain: those of `simplify_with_bound` without `tolerance`, `levels` and targets, which must stay unset.
/// `time_limit` is for all decimation of the chain together.
using LodOptions = SimplifyOptions;

/// Takes level `index`, 0 for the smallest tolerance; returning false ends the chain.
using LodSink = std::function<bool(std::size_t index, LodLevel&& level)>;

/// A chain that makes a level only when it is asked for, as for a viewer that approaches some models only. Not
/// thread-safe. Memory: O(original).
class LodChain {
 public:
  /// Nothing is decimated yet. `original` is copied. Throws `InvalidInput` as `simplify_with_bound` does, and for
  /// options that are to stay unset.
  explicit LodChain(TriangleMesh original, const LodOptions& options = {});
  /// Makes a chain for a mesh in buffers of the caller, which are copied.
  explicit LodChain(const MeshView& original, const LodOptions& options = {})
      : LodChain(meshbound::to_triangle_mesh(original), options) {}
  LodChain(LodChain&&) noexcept;             ///< a moved-from object may only be destroyed or assigned to
  LodChain& operator=(LodChain&&) noexcept;  ///< a moved-from object may only be destroyed or assigned to
  ~LodChain();

  /// The level of `tolerance`, model units: decimation goes on from the level before, and the result is measured
  /// against the original. Expected O(n log n) for all levels together, and a measurement for each. Throws
  /// `InvalidInput` when that is smaller than the one before, negative or not finite.
  ///
  /// After an exception of `progress` the chain goes on: this level may be asked for again, or a later one. They hold
  /// as all do, and may differ from those of a chain that was left alone. After `std::bad_alloc` a chain may only be
  /// destroyed.
  [[nodiscard]] LodLevel next(double tolerance);

  /// How far the texture of the levels that follow may move (`SimplifyOptions::texture_tolerance`, which is that of the
  /// levels before), model units. O(1). Throws `InvalidInput` when that is smaller than before or not a number, or
  /// where the options have no texture coordinates.
  void set_texture_tolerance(double tolerance);

  /// Facts about the run so far: a `SimplifyResult` without levels.
  [[nodiscard]] SimplifyResult describe() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Makes the levels of the given tolerances, each larger than the one before, and hands each to `sink` as soon as it is
/// there. A level after the one for which the sink returns false is never computed. Returns how many levels the sink
/// was given. Throws as `LodChain`, for tolerances before the first level is computed, and passes on what the sink
/// throws.
std::size_t build_lod_chain(const MeshView& original, std::span<const double> tolerances, const LodOptions& options,
                            const LodSink& sink);

}  // namespace meshbound
