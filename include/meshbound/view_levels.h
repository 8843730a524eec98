// SPDX-License-Identifier: MIT
/// Levels of detail for a scene that cameras look at: for each instance the coarsest level whose proven error covers
/// few enough pixels. Levels that no camera needs are never computed.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "meshbound/lod_chain.h"
#include "meshbound/pose.h"
#include "meshbound/screen_space.h"
#include "meshbound/triangle_mesh.h"

namespace meshbound {

/// A perspective view.
struct ViewCamera {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();     ///< world coordinates
  Eigen::Vector3d direction = -Eigen::Vector3d::UnitZ();  ///< the view axis; any length but 0
  Screen screen;                                          ///< height and vertical field of view
  double aspect_ratio = 16.0 / 9;                         ///< width of the screen by its height
};

/// A model at a place in the scene.
struct ViewInstance {
  std::size_t model = 0;  ///< index among the models
  /// Model to world. Deviations count as if it stretched all directions as much as the one that it stretches most.
  AffineMap pose = AffineMap::Identity();
  std::optional<std::size_t> group;  ///< instances with the same number, at most 2^24, are one group
};

/// The largest deviation, in world units and rounded down, that covers at most `pixels` of the screen wherever on it
/// the box is seen: at the box's least depth, and in the corner of the screen, where a length covers most. 0 where the
/// box reaches the camera's plane; infinite where all of it lies behind. Throws `InvalidInput` unless the direction
/// has a length, the aspect ratio is positive, the position is finite and the pose an affine map of finite entries, and
/// as `screen_space_tolerance`. O(1).
[[nodiscard]] double view_tolerance(const ViewCamera& camera, double pixels, const Eigen::AlignedBox3d& box,
                                    const AffineMap& pose);

/// What is asked of `view_levels`.
struct ViewOptions {
  double pixels = 1;  ///< that the error of an instance may cover
  /// Tolerances of the levels of each model, as shares of its bounding-box diagonal: `finest_share` times powers of
  /// `ratio`, up to `coarsest_share`.
  double finest_share = 0x1p-14;
  double coarsest_share = 0x1p-3;  ///< of the diagonal
  double ratio = 2;                ///< of a tolerance to the next finer one, 1.01 or more
  LodOptions lod;                  ///< of all chains; `time_limit` is that of all chains together
};

/// A level of a model. Level 0 is the model itself.
struct ViewLevel {
  double tolerance = 0;  ///< for which it was made, model units
  /// Proven bound of its distance from the model, model units, and never smaller than that of a finer level, so that an
  /// engine may search the levels by it.
  double error = 0;
  std::size_t faces = 0;  ///< triangles
};

/// What one camera sees of the instances.
struct ViewChoice {
  static constexpr std::uint32_t hidden = 0xffffffff;  ///< it lies behind the camera or is a point
  std::vector<std::uint32_t> level;                    ///< for each instance, a level of its model or `hidden`
  std::size_t triangles = 0;                           ///< that are drawn
  std::size_t full_triangles = 0;                      ///< that would be drawn of the models themselves
};

/// The levels of a scene and who uses them.
struct ViewLevels {
  std::vector<std::vector<ViewLevel>> models;  ///< of each model, finest first: those that were computed
  std::vector<ViewChoice> cameras;             ///< in the order of the cameras
  /// For each camera, of each group the largest error of its instances' levels in world units: never smaller than that
  /// of a part.
  std::vector<std::vector<double>> group_errors;
  std::size_t levels_computed = 0;  ///< without the models themselves
  std::size_t levels_skipped = 0;   ///< of the tolerances that were to be had: needed by no instance
};

/// Receives a level of a model as soon as it is made; `level` counts from 1.
using ViewSink = std::function<void(std::size_t model, std::size_t level, const LodLevel& mesh)>;

/// Chooses levels for all cameras. Which tolerances are needed follows from the boxes alone, so each model's chain
/// makes those levels and no other; an instance then gets the coarsest level whose error projects to at most
/// `ViewOptions::pixels`. Throws `InvalidInput` for an instance of a model that is not there or with a pose that
/// `view_tolerance` refuses, a group beyond 2^24, shares of the diagonal and ratios that make no ladder of tolerances
/// (`ViewOptions`), and as `view_tolerance` and `LodChain`. Time: the levels that are made. `sink` may be
/// empty.
[[nodiscard]] ViewLevels view_levels(std::span<const TriangleMesh> models, std::span<const ViewInstance> instances,
                                     std::span<const ViewCamera> cameras, const ViewOptions& options,
                                     const ViewSink& sink = {});

}  // namespace meshbound
