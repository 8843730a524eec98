// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "fuzz/claims.h"
#include "fuzz/lattice_solids.h"
#include "meshbound/distance.h"
#include "meshbound/penetration_depth.h"
#include "reference/exact_intersection.h"
#include "reference/small_meshes.h"

namespace meshbound::fuzz {
namespace {

using reference::CellSolid;
using reference::ExactPart;

/// Model units. Coordinates are at most some dozens, so that the roundings of the results are far below it.
constexpr double slack = 1e-9;

/// Takes a byte for each choice; zeros once they have run out.
class ByteChoices {
 public:
  explicit ByteChoices(Bytes bytes) : bytes_(bytes) {}
  unsigned operator()(unsigned n) {
    if (bytes_.empty()) return 0;
    const unsigned value = bytes_.front() % n;
    bytes_ = bytes_.subspan(1);
    return value;
  }

 private:
  Bytes bytes_;
};

/// Mostly the identity or a shift by multiples of 1/2, sometimes a rotation by any angle.
Eigen::Isometry3d chosen_pose(const Choose& choose) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  const unsigned kind = choose(8);
  if (kind < 4) return pose;
  const auto shift = [&] { return 0.5 * choose(9) - 2; };
  pose.translation() = Eigen::Vector3d(shift(), shift(), shift());
  if (kind < 6) return pose;
  const auto axis = [&] { return static_cast<double>(choose(5)) - 2; };
  Eigen::Vector3d direction(axis(), axis(), axis());
  if (direction.norm() == 0) direction = Eigen::Vector3d::UnitZ();
  pose.linear() = Eigen::AngleAxisd(0.0625 * choose(101), direction.normalized()).toRotationMatrix();
  return pose;
}

double area(const TriangleMesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles)
    sum += (mesh.vertices[t[1]] - mesh.vertices[t[0]]).cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]).norm() / 2;
  return sum;
}

DistanceOptions to(double error_bound) {
  DistanceOptions options;
  options.error_bound = error_bound;
  options.threads = 1;
  return options;
}

/// Every point of `part` is on `whole`.
void require_within(const TriangleMesh& part, const TriangleMesh& whole, const char* claim) {
  if (part.triangles.empty()) return;
  require(!whole.triangles.empty(), claim);
  const Bvh tree_part(part, {1, {}}), tree_whole(whole, {1, {}});
  require(one_sided_hausdorff_distance(tree_part, tree_whole, to(slack)).bounds.lower <= slack, claim);
}

/// The parts of all volumes on one side, without components that stand for a missing part.
TriangleMesh found_part(const PenetrationDepth& result, bool on_a) {
  TriangleMesh all;
  for (const PenetrationVolume& volume : result.volumes) {
    if (volume.overlap == (on_a ? Overlap::BInsideA : Overlap::AInsideB)) continue;
    all = reference::both(all, on_a ? volume.parts->on_a : volume.parts->on_b);
  }
  return all;
}

void check_part(const TriangleMesh& found, const ExactPart& exact) {
  const TriangleMesh inside = reference::rounded_mesh(exact.inside);
  const TriangleMesh allowed = reference::both(inside, reference::rounded_mesh(exact.contact));
  require_within(inside, found, "a part of a surface inside the other model was not found");
  require_within(found, allowed, "a part of a surface was found that is not inside the other model");
  const double least = reference::area_of(exact.inside), largest = least + reference::area_of(exact.contact);
  require(area(found) >= least - 1e-6 && area(found) <= largest + 1e-6, "the part of a surface has another area");
}

void check_content(const PenetrationDepth& result, const mpq_class& exact) {
  mpq_class lower = 0, upper = 0;
  for (const PenetrationVolume& volume : result.volumes) {
    require(volume.depth.lower >= 0 && volume.depth.lower <= volume.depth.upper, "0 <= lower <= upper");
    require(volume.volume.lower >= 0 && volume.volume.lower <= volume.volume.upper, "the content is an interval");
    lower += mpq_class(volume.volume.lower);
    upper += mpq_class(volume.volume.upper);
  }
  require(lower <= exact && exact <= upper, "the content is outside of its interval");
  require(result.volumes.empty() == (sgn(exact) == 0), "volumes without content");
}

/// The depth is that of the exact parts, where these are all there is.
void check_depth(const PenetrationDepth& result, const ExactPart& on_a, const ExactPart& on_b) {
  if (result.volumes.size() != 1 || result.volumes[0].overlap != Overlap::Crossing) return;
  if (!on_a.contact.empty() || !on_b.contact.empty()) return;
  require(!on_a.inside.empty() && !on_b.inside.empty(), "a crossing volume lacks a part");
  const Bvh a(reference::rounded_mesh(on_a.inside), {1, {}}), b(reference::rounded_mesh(on_b.inside), {1, {}});
  const Bounds depth = hausdorff_distance(a, b, to(1e-6)).bounds, &found = result.depth;
  require(found.lower <= depth.upper + slack && depth.lower <= found.upper + slack,
          "another depth than the exact parts'");
}

}  // namespace

void check_penetration(Bytes content) {
  const Choose choose = ByteChoices(content);
  const Eigen::Isometry3d pose_a = chosen_pose(choose), pose_b = chosen_pose(choose);
  const CellSolid a = lattice_solid(choose), b = lattice_solid(choose);
  const ClosedModel model_a(a.surface, {1, {}}), model_b(b.surface, {1, {}});
  PenetrationOptions options;
  options.keep_parts = true;
  options.error_bound = 1e-6;
  options.budget.subdivisions = 2000;
  const PenetrationDepth result = penetration_depth({model_a, pose_a}, {model_b, pose_b}, options);
  check_content(result, reference::exact_common_content(a, pose_a, b, pose_b));
  const ExactPart on_a = reference::exact_part(a, pose_a, b, pose_b),
                  on_b = reference::exact_part(b, pose_b, a, pose_a);
  if (!result.volumes.empty()) {
    check_part(found_part(result, true), on_a);
    check_part(found_part(result, false), on_b);
  }
  check_depth(result, on_a, on_b);
  const bool contact = in_contact({model_a, pose_a}, {model_b, pose_b});
  require(contact == in_contact({model_b, pose_b}, {model_a, pose_a}), "contact depends on the order");
  const bool meets = !on_a.inside.empty() || !on_a.contact.empty() || !on_b.inside.empty() || !on_b.contact.empty();
  require(contact || !meets, "no contact, although a surface has a part in the other model");
}

}  // namespace meshbound::fuzz
