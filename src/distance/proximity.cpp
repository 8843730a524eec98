// SPDX-License-Identifier: MIT
#include "meshbound/proximity.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "distance/kernel/search_kernel.h"
#include "distance/shortcuts/point_like.h"
#include "geometry/magnitude.h"
#include "meshbound/distance.h"
#include "meshbound/error.h"
#include "numeric/rounding.h"

namespace meshbound {
namespace {

/// The least power of two that is at least x >= 1.
double power_of_two_from(double x) {
  constexpr std::uint64_t next_exponent = std::uint64_t{1} << 52;
  const auto bits = std::bit_cast<std::uint64_t>(x), mantissa = bits % next_exponent;
  return std::bit_cast<double>(bits - mantissa + (mantissa != 0 ? next_exponent : 0));
}

}  // namespace

struct Proximity::Impl {
  explicit Impl(const Bvh& model) : bvh(model), data(model.data()), map(data.frame) {
    if (is_along_curve()) return;
    slot_of_triangle.resize(data.triangle_count());
    for (std::uint32_t slot = 0; slot < data.triangle_count(); ++slot)
      slot_of_triangle[data.triangle_of_slot[slot]] = slot;
  }

  [[nodiscard]] bool is_along_curve() const {
    std::uint32_t slot = 0;
    return std::ranges::all_of(data.triangle_of_slot, [&](std::uint32_t triangle) { return triangle == slot++; });
  }
  /// Where a hint stands in the tree; the first slot for one that is no triangle.
  [[nodiscard]] std::uint32_t slot_of(std::uint32_t hint) const {
    if (hint >= data.triangle_count()) return 0;
    return slot_of_triangle.empty() ? hint : slot_of_triangle[hint];
  }

  /// A query point in the working frame; raises `magnitude` and `error` to cover it.
  Vec3 load(const Eigen::Vector3d& point, double& magnitude, double& error) const {
    if (!point.allFinite() || point.cwiseAbs().maxCoeff() > largest_coordinate)
      throw InvalidInput("a query point has a coordinate that is not finite or is beyond 2^1000");
    const Vec3 model{point.x(), point.y(), point.z()};
    const Vec3 working = map(model);
    magnitude = std::max(magnitude, largest_magnitude_of(working));
    error = std::max(error, map.rounding_of(model));
    return working;
  }

  /// Reuses the kernel as long as the goal stays the same: its scratch memory is what makes this class worth keeping.
  SearchKernel& kernel_for(double tolerance, double magnitude, double error) {
    Goal goal;
    goal.decide_only = true;
    goal.tolerance = map.working_length_down(tolerance);
    // Powers of two, so that neighbouring triangles share one goal.
    set_slack(goal, power_of_two_from(magnitude), data.frame.error + error);
    if (!kernel || goal.tolerance != current.tolerance || goal.slack != current.slack) {
      kernel = make_search_kernel(data, goal);
      current = goal;
    }
    kernel->begin({});
    return *kernel;
  }

  const Bvh& bvh;
  const Bvh::Data& data;
  FrameMap map;
  std::vector<std::uint32_t> slot_of_triangle;  ///< empty where the mesh has the order of the slots
  std::unique_ptr<SearchKernel> kernel;
  Goal current;
};

Proximity::Proximity(const Bvh& bvh) : impl_(std::make_unique<Impl>(bvh)) {}
Proximity::Proximity(Proximity&&) noexcept = default;
Proximity& Proximity::operator=(Proximity&&) noexcept = default;
Proximity::~Proximity() = default;

Verdict Proximity::triangle_within(const std::array<Eigen::Vector3d, 3>& triangle, double tolerance,
                                   std::uint32_t& hint, std::uint64_t max_subdivisions) {
  if (!(tolerance >= 0)) throw InvalidInput("the tolerance must be a length of 0 or more");
  double magnitude = 1, error = 0;
  Vec3 p[3];
  for (int k = 0; k < 3; ++k) p[k] = impl_->load(triangle[k], magnitude, error);
  if (!(magnitude <= max_magnitude)) {
    const Bvh single(TriangleMesh{{triangle.begin(), triangle.end()}, {{0, 1, 2}}}, {.threads = 1});
    DistanceOptions options;
    options.threads = 1;
    return check_one_sided_tolerance(single, impl_->bvh, tolerance, options).verdict;
  }
  SearchKernel& kernel = impl_->kernel_for(tolerance, magnitude, error);
  std::uint32_t slot = impl_->slot_of(hint);
  const Swept swept = kernel.sweep({p[0], p[1], p[2]}, slot, max_subdivisions);
  hint = impl_->data.triangle_of_slot[slot];
  if (swept == Swept::NotAtAll || swept == Swept::NotNear) {
    for (const Vec3& corner : p) {
      const Nearest nearest = kernel.nearest(corner, slot, kernel.accepted_squared());
      slot = nearest.slot;
      hint = impl_->data.triangle_of_slot[slot];
      if (nearest.squared <= kernel.accepted_squared()) continue;
      kernel.offer(corner, nearest, 0);
      return kernel.lower().lower > impl_->current.tolerance ? Verdict::Exceeds : Verdict::Undecided;
    }
    kernel.cover(p[0], p[1], p[2], 0, slot, max_subdivisions);
  }
  // What a search accepts may be more than a tolerance near the size of rounding.
  return verdict_of({kernel.lower().lower, impl_->current.proven_upper(kernel.upper_squared(), deepest_cut)},
                    impl_->current.tolerance);
}

double Proximity::upper_distance(const Eigen::Vector3d& point, std::uint32_t& hint, double enough) {
  double magnitude = 1, error = 0;
  const Vec3 p = impl_->load(point, magnitude, error);
  if (!(magnitude <= max_magnitude)) return closest_point(impl_->bvh, point).distance.upper;
  SearchKernel& kernel = impl_->kernel_for(impl_->map.length_down(impl_->current.tolerance), magnitude, error);
  // The slack and the roundings of `proven_upper` are taken off, so that the bound that is returned is at most
  // `enough`.
  const double accepted =
      std::max(0.0, impl_->map.working_length_down(enough) * (1 - 16 * unit_roundoff) - impl_->current.slack);
  const Nearest nearest = kernel.nearest(p, impl_->slot_of(hint), accepted * accepted);
  hint = impl_->data.triangle_of_slot[nearest.slot];
  return impl_->map.length_up(impl_->current.proven_upper(nearest.squared, 0));
}

std::uint32_t Proximity::nearby_triangle(const Eigen::Vector3d& point, std::uint32_t hint, double far) {
  double magnitude = 1, error = 0;
  const Vec3 p = impl_->load(point, magnitude, error);
  if (!(magnitude <= max_magnitude)) return closest_point(impl_->bvh, point).point.triangle;
  SearchKernel& kernel = impl_->kernel_for(impl_->map.length_down(impl_->current.tolerance), magnitude, error);
  const double working_far = impl_->map.working_length_down(far);
  Nearest found = kernel.nearby(p, impl_->slot_of(hint));
  if (found.squared > working_far * working_far) found = kernel.nearest(p, found.slot, 0);
  return impl_->data.triangle_of_slot[found.slot];
}

}  // namespace meshbound
