// SPDX-License-Identifier: MIT
/// Many moving models: which pairs of them are near each other, answered anew at every step.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "meshbound/bvh.h"
#include "meshbound/distance.h"
#include "meshbound/penetration_depth.h"
#include "meshbound/pose.h"

namespace meshbound {

/// How the pairs of one call of `Scene::check_tolerance` were answered.
struct SceneStats {
  std::uint64_t pairs = 0;             ///< of all bodies
  std::uint64_t skipped_by_boxes = 0;  ///< their bounding boxes differ by more than the tolerance
  std::uint64_t unmoved = 0;           ///< neither body has moved since the question was answered before
  std::uint64_t searched = 0;  ///< the others: by `check_tolerance`, starting from the result of the step before
  std::uint64_t closest_point_queries = 0;  ///< of the searched pairs
};

/// A pair of bodies that was not skipped.
struct ScenePair {
  std::uint32_t a = 0;   ///< number of a body
  std::uint32_t b = 0;   ///< number of a body, above `a`
  ToleranceCheck check;  ///< `a_to_b` is from body a to body b
};

/// The answer for all pairs. A pair that is not listed exceeds the tolerance.
struct SceneCheck {
  std::vector<ScenePair> pairs;  ///< by a, then by b
  SceneStats stats;              ///< of this call
};

/// How the pairs of one call of `Scene::contacts` were answered.
struct ContactStats {
  std::uint64_t pairs = 0;             ///< of all bodies
  std::uint64_t without_solid = 0;     ///< at least one body of the pair is no `ClosedModel`
  std::uint64_t skipped_by_boxes = 0;  ///< their bounding boxes have no point in common
  std::uint64_t unmoved = 0;           ///< neither body has moved since the question was answered before
  std::uint64_t measured = 0;          ///< the others: by `penetration_depth`
  std::uint64_t without_volume = 0;    ///< of the measured and the unmoved ones: they share no content
};

/// Two bodies that share content, or that a budget of time left open.
struct SceneContact {
  std::uint32_t a = 0;           ///< number of a body
  std::uint32_t b = 0;           ///< number of a body, above `a`
  PenetrationDepth penetration;  ///< of body a and body b
};

/// All contacts of a scene.
struct SceneContacts {
  std::vector<SceneContact> pairs;  ///< by a, then by b
  ContactStats stats;               ///< of this call
};

/// Placed models, called bodies and numbered from 0 in the order in which they were added. What is known of a pair is
/// kept from question to question (`MovingPair`). Not thread-safe; the trees may be shared, by bodies too.
/// Memory: some 200 bytes per body, and a `MovingPair` for each pair that the last question did not skip.
class Scene {
 public:
  Scene();
  Scene(Scene&&) noexcept;             ///< a moved-from object may only be destroyed or assigned to
  Scene& operator=(Scene&&) noexcept;  ///< a moved-from object may only be destroyed or assigned to
  ~Scene();

  /// Adds a body and returns its number. `model` must outlive this; it may be refitted between questions. Throws
  /// `InvalidInput` for a pose that is no rigid motion.
  std::uint32_t add(const Bvh& model, const Pose& pose = Pose::Identity());

  /// Adds a solid, for which `contacts` measures how deep it is in other solids; `model` must outlive this. Throws as
  /// above, and for a pose that reflects.
  std::uint32_t add(const ClosedModel& model, const Pose& pose = Pose::Identity());

  /// Gives a body another pose, model to world. Throws as `add`, and for a number that no body has; the pose is then as
  /// it was. Expected O(log n) for its box.
  void move(std::uint32_t body, const Pose& pose);

  [[nodiscard]] std::uint32_t size() const;                          ///< bodies
  [[nodiscard]] const PlacedModel& model(std::uint32_t body) const;  ///< with its pose

  /// Decides for every pair whether its Hausdorff distance is at most the tolerance (model units). Sides of the boxes
  /// of two bodies in world coordinates lie no further apart than the distance, so a sweep along one axis finds the
  /// pairs that can be within it; those are decided in parallel by `check_tolerance`, each by one thread.
  /// `options.budget` counts for all pairs together in time and for each in subdivisions; pairs that it leaves open are
  /// `Undecided`. `options.progress` is not called. Throws as `check_tolerance`. The same answers for any number of
  /// threads. O(n log n) for n bodies, and the pairs.
  [[nodiscard]] SceneCheck check_tolerance(double tolerance, const DistanceOptions& options = {});

  /// The penetration depth of all pairs of solids that share content. Pairs whose boxes have no point in common are
  /// skipped, pairs that have not moved keep their answer, the rest are measured in parallel, each by one thread.
  /// `options.decide` asks only whether volumes are deeper than that, and `stop_when_deeper` ends each pair at the
  /// first one; `options.budget` counts for all pairs together in time, and what it leaves open is measured again by
  /// the next call. `options.progress` is not called. Throws as `penetration_depth`. The same answers
  /// for any number of threads (`options.threads`; 0: as many as OpenMP has). O(n log n) for n bodies, and the pairs.
  [[nodiscard]] SceneContacts contacts(const PenetrationOptions& options = {});

  /// Pairs of bodies whose boxes in world coordinates are at most `margin` (model units, 0 or more) apart along every
  /// axis, by a, then by b: all pairs that can touch are among them. Throws `InvalidInput` for another margin.
  /// O(n log n), and the pairs that overlap along the first axis.
  [[nodiscard]] std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs_near(double margin = 0) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace meshbound
