// SPDX-License-Identifier: MIT
#include "bvh/bvh_data.h"
#include "distance/symmetric.h"
#include "meshbound/motion.h"
#include "meshbound/pose.h"

namespace meshbound {

struct MovingPair::Impl {
  Impl(const Bvh& model_a, const Bvh& model_b) : a(&model_a), b(&model_b) {
    a_to_b.rigid = b_to_a.rigid = true;
    forget();
  }

  /// What is known about the trees in their current state.
  HausdorffMemory memory() {
    if (a->data().serial != serial_a || b->data().serial != serial_b) forget();
    return {&a_to_b, &b_to_a};
  }

  void forget() {
    serial_a = a->data().serial;
    serial_b = b->data().serial;
    a_to_b.reset(a->data());
    b_to_a.reset(b->data());
  }

  const Bvh* a;
  const Bvh* b;
  std::uint64_t serial_a = 0, serial_b = 0;
  SearchMemory a_to_b, b_to_a;
};

MovingPair::MovingPair(const Bvh& a, const Bvh& b) : impl_(std::make_unique<Impl>(a, b)) {}
MovingPair::MovingPair(MovingPair&&) noexcept = default;
MovingPair& MovingPair::operator=(MovingPair&&) noexcept = default;
MovingPair::~MovingPair() = default;

HausdorffDistance MovingPair::hausdorff_distance(const Pose& pose_a, const Pose& pose_b,
                                                 const DistanceOptions& options) {
  return meshbound::hausdorff_distance({*impl_->a, pose_a}, {*impl_->b, pose_b}, options, impl_->memory());
}

ToleranceCheck MovingPair::check_tolerance(const Pose& pose_a, const Pose& pose_b, double tolerance,
                                           const DistanceOptions& options) {
  return meshbound::check_tolerance({*impl_->a, pose_a}, {*impl_->b, pose_b}, tolerance, options, impl_->memory());
}

}  // namespace meshbound
