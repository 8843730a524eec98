// SPDX-License-Identifier: MIT
#include "penetration/placed_pair.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/eigen_vec3.h"
#include "geometry/magnitude.h"
#include "geometry/triangle_corners.h"
#include "meshbound/error.h"
#include "numeric/rounding.h"

namespace meshbound {
namespace {

Vec3 magnitudes(const Vec3& v) { return {std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}; }
Vec3 smaller(const Vec3& p, const Vec3& q) { return {std::min(p.x, q.x), std::min(p.y, q.y), std::min(p.z, q.z)}; }
Vec3 larger(const Vec3& p, const Vec3& q) { return {std::max(p.x, q.x), std::max(p.y, q.y), std::max(p.z, q.z)}; }

void require_motion(const Pose& pose) {
  if (!pose.matrix().allFinite()) throw InvalidInput("a pose has an entry that is not finite");
  if (!(pose.linear().determinant() > 0)) throw InvalidInput("a pose is a reflection; penetration needs rigid motions");
  if (!(pose.translation().cwiseAbs().maxCoeff() <= largest_coordinate))
    throw InvalidInput("a pose moves a model out of the range of coordinates (2^1000)");
}

/// A bound of the rounding error of a computed dot(a, cross(b, c)) for differences a, b, c of points whose coordinates
/// are off by at most h / 2 each; infinite where underflow or overflow could matter. `d`: the largest magnitudes of the
/// differences by axis, enlarged by h.
///
///
/// Let D be the product of the components of d. A computed difference has a relative error of u besides h; the
/// determinant is a sum of 6 products of three differences. Each product takes part in three differences, two products
/// and five additions: the roundings are at most 10 u (1 + 10 u) times the sum of the magnitudes, which is at most 6 D:
/// less than 64 u D, in whatever order. The error h of the differences changes each of the 6 products by at most h (d_x
/// d_y + d_y d_z + d_z d_x). Underflow cannot matter where D is above 1e-200 and no d above 1e60.
double error_of_volume(const Vec3& d, double h) {
  const double product = d.x * d.y * d.z;
  if (!(product > 1e-200) || !(d.x < 1e60) || !(d.y < 1e60) || !(d.z < 1e60))
    return std::numeric_limits<double>::infinity();
  return (64 * unit_roundoff * product + 6 * h * (d.x * d.y + d.y * d.z + d.z * d.x)) * (1 + 16 * unit_roundoff);
}

/// Sign of `volume`, computed as dot(a, cross(b, c)) for differences of points whose coordinates are off by at most
/// `error` each; 0 where doubles cannot tell.
int certain_sign(double volume, const Vec3& a, const Vec3& b, const Vec3& c, double error) {
  const double h = 2 * error;
  const Vec3 d = larger(larger(magnitudes(a), magnitudes(b)), magnitudes(c)) + Vec3{h, h, h};
  const double bound = error_of_volume(d, h);
  if (volume > bound) return 1;
  return volume < -bound ? -1 : 0;
}

}  // namespace

void PlacedPair::place(const ClosedModel::Data& a, const Pose& pose_a, const ClosedModel::Data& b, const Pose& pose_b) {
  sides_[0].model = &a;
  sides_[0].pose = pose_a;
  sides_[1].model = &b;
  sides_[1].pose = pose_b;
  for (Side& side : sides_) {
    side.map.reset();
    side.points.clear(side.model->positions.size());
    side.boxes.clear(side.model->triangles.size());
    side.block_boxes.clear(side.model->triangles.size() / block_width + 1);
    side.exact_points.clear(side.model->positions.size());
  }
  const auto frame = [this](std::uint32_t side) -> const Frame& { return model(side).tree.data().frame; };
  tree_side_ = frame(1).exponent > frame(0).exponent ? 1 : 0;
  const std::uint32_t other = 1 - tree_side_;
  tree_mapping_ = mapping_between(frame(other), sides_[other].pose, frame(tree_side_), sides_[tree_side_].pose);
  require_motion(pose_a);
  require_motion(pose_b);
  stop_ = {};
  is_exact_ready_ = false;
  exact_decisions_ = perturbed_decisions_ = 0;
  set_frame();
}

/// The origin is the centre of side 0 in the world, so coordinates are small where the models meet.
void PlacedPair::set_frame() {
  const Vec3 center = sides_[0].model->tree.data().frame.center;
  origin_ = to_vec3(sides_[0].pose * Eigen::Vector3d(center.x, center.y, center.z));
  double largest = 0;
  for (Side& side : sides_) {
    side.center = side.model->tree.data().frame.center;
    set_offset(side);
    largest = std::max(largest, 3 * side.model->reach + largest_magnitude_of(side.offset));
  }
  std::frexp(largest, &exponent_);
  exponent_ = std::max(exponent_, -1000);  // the reciprocal of its power of two is a number
  for (Side& side : sides_) {
    const bool is_plain = side.pose.linear() == Eigen::Matrix3d::Identity() && largest_magnitude_of(side.offset) == 0 &&
                          largest_magnitude_of(side.center) == 0;
    const double magnitude = 3 * side.model->reach + largest_magnitude_of(side.offset);
    // One rounding each for the difference with the centre, the products, three additions and the offset, whose
    // magnitude is at most `magnitude`; and the rounding of the scaled rotation if that underflows.
    side.error = is_plain ? 0 : std::ldexp(magnitude, -exponent_) * 10 * unit_roundoff;
    if (!is_plain) side.error += std::ldexp(0x1p-1073, -exponent_);  // an offset that is no normal number
    side.error += 0x1p-960;  // products of it stay normal numbers: others take many times as long
    const auto row = [&](int i) -> Vec3 {
      return {std::ldexp(side.pose.linear()(i, 0), -exponent_), std::ldexp(side.pose.linear()(i, 1), -exponent_),
              std::ldexp(side.pose.linear()(i, 2), -exponent_)};
    };
    side.rows = {row(0), row(1), row(2)};
    side.offset = {std::ldexp(side.offset.x, -exponent_), std::ldexp(side.offset.y, -exponent_),
                   std::ldexp(side.offset.z, -exponent_)};
  }
  constexpr double largest_difference = 2.5;  // of coordinates of magnitude about 1, with their errors
  volume_error_ = error_of_volume({largest_difference, largest_difference, largest_difference}, 2 * largest_error());
}

/// R center + t - origin, model units, with a relative error of 2 u.
void PlacedPair::set_offset(Side& side) {
  const Vec3 translation = to_vec3(side.pose.translation());
  if (largest_magnitude_of(side.center) == 0) {
    side.offset = translation - origin_;
    return;
  }
  prepare_exact();
  const ExactPoint moved = (*side.map)(side.center) - ExactPoint{in_units(origin_.x, unit_), in_units(origin_.y, unit_),
                                                                 in_units(origin_.z, unit_)};
  const auto rounded = [this](const mpz_class& value) {
    long exponent = 0;
    const double mantissa = mpz_get_d_2exp(&exponent, value.get_mpz_t());
    return std::ldexp(mantissa, static_cast<int>(exponent) + unit_);
  };
  side.offset = {rounded(moved.x), rounded(moved.y), rounded(moved.z)};
}

void PlacedPair::prepare_exact() {
  if (is_exact_ready_) return;
  unit_ = std::min({lowest_bit(origin_.x), lowest_bit(origin_.y), lowest_bit(origin_.z)});
  for (const Side& side : sides_) unit_ = std::min(unit_, ExactMap::image_bit(side.pose, side.model->lowest_bit));
  for (Side& side : sides_) side.map.emplace(side.pose, side.model->lowest_bit, unit_);
  is_exact_ready_ = true;
}

const Vec3& PlacedPair::place_vertex(Side& side, std::uint32_t vertex) {
  const Vec3 p = side.model->positions[vertex] - side.center;
  return side.points.set(vertex, Vec3{dot(side.rows[0], p), dot(side.rows[1], p), dot(side.rows[2], p)} + side.offset);
}

const Box& PlacedPair::place_box(std::uint32_t side, std::uint32_t triangle) {
  const Triangle& t = model(side).triangles[triangle];
  const Vec3 a = local({side, t[0]}), b = local({side, t[1]}), c = local({side, t[2]});
  const double e = 2 * sides_[side].error;
  const Vec3 margin{e, e, e};
  const auto least = [](double x, double y, double z) { return std::min(std::min(x, y), z); };
  const auto largest = [](double x, double y, double z) { return std::max(std::max(x, y), z); };
  return sides_[side].boxes.set(
      triangle, {Vec3{least(a.x, b.x, c.x), least(a.y, b.y, c.y), least(a.z, b.z, c.z)} - margin,
                 Vec3{largest(a.x, b.x, c.x), largest(a.y, b.y, c.y), largest(a.z, b.z, c.z)} + margin});
}

const Box& PlacedPair::place_block_box(std::uint32_t side, std::uint32_t block) {
  const Bvh::Data& tree = model(side).tree.data();
  const std::uint32_t first = block * block_width, end = std::min(first + block_width, tree.triangle_count());
  Box all = box(side, tree.triangle_of_slot[first]);
  for (std::uint32_t slot = first + 1; slot < end; ++slot) {
    const Box& own = box(side, tree.triangle_of_slot[slot]);
    all = {smaller(all.lo, own.lo), larger(all.hi, own.hi)};
  }
  return sides_[side].block_boxes.set(block, all);
}

const ExactPoint& PlacedPair::exact(PairVertex v) {
  prepare_exact();
  Side& side = sides_[v.side];
  if (side.exact_points.has(v.vertex)) return side.exact_points[v.vertex];
  return side.exact_points.set(v.vertex, (*side.map)(side.model->positions[v.vertex]));
}

Eigen::Vector3d PlacedPair::to_world(const Vec3& local) const {
  return {std::ldexp(local.x, exponent_) + origin_.x, std::ldexp(local.y, exponent_) + origin_.y,
          std::ldexp(local.z, exponent_) + origin_.z};
}

Vec3 PlacedPair::to_local(const ExactPoint& numerator, const mpz_class& denominator) {
  prepare_exact();
  const auto coordinate = [&](const mpz_class& value, double origin) {
    mpq_class ratio(value - denominator * in_units(origin, unit_), denominator);
    ratio.canonicalize();
    long top = 0, bottom = 0;
    // The quotient of two integers of any length: scaled so that it is a normal double, then scaled back.
    const double t = mpz_get_d_2exp(&top, ratio.get_num_mpz_t()), b = mpz_get_d_2exp(&bottom, ratio.get_den_mpz_t());
    return std::ldexp(t / b, static_cast<int>(top - bottom) + unit_ - exponent_);
  };
  return {coordinate(numerator.x, origin_.x), coordinate(numerator.y, origin_.y), coordinate(numerator.z, origin_.z)};
}

int PlacedPair::certain_orientation(PairVertex p, PairVertex q, PairVertex r, PairVertex s) {
  const Vec3 from = local(p), a = local(q) - from, b = local(r) - from, c = local(s) - from;
  const double volume = dot(a, cross(b, c));
  const int sign = sign_beyond_error(volume);
  return sign != 0 ? sign : certain_sign(volume, a, b, c, largest_error());
}

int PlacedPair::orientation(PairVertex p, PairVertex q, PairVertex r, PairVertex s) {
  if (const int sign = certain_orientation(p, q, r, s); sign != 0) return sign;
  ++exact_decisions_;
  return sgn(volume_of(exact(p), exact(q), exact(r), exact(s)));
}

int PlacedPair::sign_of_first(const ExactPoint& normal, int sign) {
  for (const mpz_class* coordinate : {&normal.x, &normal.y, &normal.z})
    if (sgn(*coordinate) != 0) return sign * sgn(*coordinate);
  return 0;
}

int PlacedPair::side_of_plane(std::uint32_t side, const Triangle& triangle, std::uint32_t vertex) {
  const PairVertex p{side, triangle[0]}, q{side, triangle[1]}, r{side, triangle[2]};
  const int sign = orientation(p, q, r, {1 - side, vertex});
  if (sign != 0) return sign;
  ++perturbed_decisions_;
  // Moving side 0 by t adds the product of t with the normal to the volume, or subtracts it if side 0 has the triangle.
  return sign_of_first(cross(exact(q) - exact(p), exact(r) - exact(p)), side == 0 ? -1 : 1);
}

/// As `side_of_plane` for three vertices, with the plane computed once.
std::array<int, 3> PlacedPair::sides_of_plane(std::uint32_t side, const Triangle& triangle, const Triangle& vertices) {
  const Vec3 p = local({side, triangle[0]}), a = local({side, triangle[1]}) - p, b = local({side, triangle[2]}) - p;
  const Vec3 normal = cross(a, b);
  std::array<int, 3> signs{};
  for (std::size_t k = 0; k < 3; ++k) {
    signs[k] = sign_beyond_error(dot(local({1 - side, vertices[k]}) - p, normal));
    if (signs[k] == 0) signs[k] = side_of_plane(side, triangle, vertices[k]);
  }
  return signs;
}

int PlacedPair::edge_turn(std::uint32_t p0, std::uint32_t q0, std::uint32_t p1, std::uint32_t q1) {
  const PairVertex p{0, p0}, q{0, q0}, r{1, p1}, s{1, q1};
  const int sign = orientation(p, q, r, s);
  if (sign != 0) return sign;
  // With u = q - p, v = r - p and w = s - p, moving side 0 by t gives u . ((v - t) x (w - t)), which is the volume plus
  // t . (u x (w - v)).
  return sign_of_first(cross(exact(q) - exact(p), exact(s) - exact(r)), 1);
}

bool PlacedPair::is_beyond(std::uint32_t side, const Vec3& p, const Eigen::AlignedBox3d& box) const {
  const Side &own = sides_[side], &other = sides_[1 - side];
  const Eigen::Vector3d world = own.pose * Eigen::Vector3d(p.x, p.y, p.z);
  const Eigen::Vector3d moved = other.pose.linear().transpose() * (world - other.pose.translation());
  // About ten roundings of numbers of this magnitude, and poses that deviate from rigid motions by at most 1e-9.
  const double magnitude = 4 * (own.model->reach + other.model->reach + own.pose.translation().cwiseAbs().maxCoeff() +
                                other.pose.translation().cwiseAbs().maxCoeff());
  const double margin = magnitude * 1e-8;
  const auto outside = (moved.array() < box.min().array() - margin) || (moved.array() > box.max().array() + margin);
  return outside.any();
}

bool PlacedPair::goes_through(std::uint32_t side, const Triangle& triangle, std::uint32_t p, std::uint32_t q) {
  // The turns of the edge around those of the triangle, seen from p.
  const Vec3 from = local({1 - side, p}), edge = local({1 - side, q}) - from;
  const TriangleCorners corners{local({side, triangle[0]}) - from, local({side, triangle[1]}) - from,
                                local({side, triangle[2]}) - from};
  const auto turn = [&](std::size_t k) {
    const std::size_t next = next_corner(k);
    if (const int sign = sign_beyond_error(dot(edge, cross(corners[k], corners[next]))); sign != 0) return sign;
    // Exchanging the two edges is an even permutation of the four points.
    return side == 1 ? edge_turn(p, q, triangle[k], triangle[next]) : edge_turn(triangle[k], triangle[next], p, q);
  };
  const int first = turn(0);
  return turn(1) == first && turn(2) == first;
}

}  // namespace meshbound
