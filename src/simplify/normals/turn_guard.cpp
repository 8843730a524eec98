// SPDX-License-Identifier: MIT
#include "simplify/normals/turn_guard.h"

#include <algorithm>

#include "numeric/sort_unique.h"
#include "simplify/mesh/face_box.h"

namespace meshbound {
namespace {

/// Squared distances that differ by less than this share count as equal: the nearest point lies on a common edge.
constexpr double tie = 1e-9;

/// By how much squared distances in single precision may be off, with room: they only tell where doubles are needed.
constexpr double single_precision = 1e-3;

/// Faces around a vertex that are looked at: a hub has thousands, around which each collapse would look.
constexpr std::size_t max_around = 24;

/// Samples with one rival that are looked at: a floor is the rival of thousands.
constexpr std::size_t max_with_rival = 64;

constexpr std::size_t lanes = 8;

}  // namespace

void TurnGuard::Compared::clear() {
  samples.clear();
  points.clear();
}

void TurnGuard::Compared::put_first(std::size_t i) {
  std::swap(samples[0], samples[i]);
  points.swap(0, i);
}

std::size_t TurnGuard::Compared::nearest(std::size_t i) const {
  return static_cast<std::size_t>(offsets[i / lanes].face[i % lanes]);
}

void TurnGuard::Compared::set_nearest(std::size_t i, std::size_t face) {
  offsets[i / lanes].face[i % lanes] = static_cast<float>(face);
}

double TurnGuard::Compared::squared(std::size_t i) const { return offsets[i / lanes].squared[i % lanes]; }

void TurnGuard::add(std::uint32_t sample, Compared& to) const {
  to.samples.push_back(sample);
  to.points.add(turns_.sample(sample).at - origin_);
}

void TurnGuard::begin(const TurnedStar& star) {
  origin_ = star.origin;
  faces_.clear();
  moved_.assign(star.moved.begin(), star.moved.end());
  star_.assign(star.removed.begin(), star.removed.end());
  for (const Corner c : star.moved) {
    faces_.push_back({{Vec3{}, mesh_.position(mesh_.end(c)), mesh_.position(mesh_.apex(c))}, {}, c / 3});
    star_.push_back(c / 3);
  }
  own_.clear();
  for (const std::uint32_t face : star_) turns_.for_each_sample(face, [&](std::uint32_t s) { add(s, own_); });
  std::sort(star_.begin(), star_.end());
  has_others_ = false;
}

bool TurnGuard::is_in_star(std::uint32_t face) const { return std::binary_search(star_.begin(), star_.end(), face); }

/// Finds the samples of faces that share a vertex with a face of the star but are not in it, and those that have a
/// rival in the star. The vertices of a star all belong to the region of its collapse, so no other thread changes the
/// faces around it or their samples.
void TurnGuard::find_others() {
  ring_.clear();
  for (const Corner c : moved_) ring_.insert(ring_.end(), {mesh_.end(c), mesh_.apex(c)});
  sort_unique(ring_);
  around_.clear();
  for (const std::uint32_t v : ring_) {
    std::size_t seen = 0;
    mesh_.for_each_corner(v, [&](Corner c) {
      around_.push_back(c / 3);
      return ++seen < max_around;
    });
  }
  sort_unique(around_);
  others_.clear();
  for (const std::uint32_t f : around_)
    if (!is_in_star(f)) turns_.for_each_sample(f, [&](std::uint32_t s) { add(s, others_); });
  numbers_.clear();
  for (const std::uint32_t s : own_.samples) {
    const auto with = turns_.rivals().with(s);
    for (const std::uint32_t other : with.first(std::min(with.size(), max_with_rival))) {
      const std::uint32_t face = turns_.face_of(other);
      const bool is_known = is_in_star(face) || std::binary_search(around_.begin(), around_.end(), face);
      if (!is_known && is_readable(face)) numbers_.push_back(other);
    }
  }
  sort_unique(numbers_);
  for (const std::uint32_t s : numbers_) add(s, others_);
  squared_from_own_.assign(others_.samples.size(), -1);
  has_others_ = true;
}

/// The face outside the star that holds one of the sample's rivals and from which it turns too much, if it is nearer
/// than `below`: the nearest one.
TurnGuard::RivalFace TurnGuard::nearest_rival(std::uint32_t sample, double below) const {
  const FaceTurns::Sample& from = turns_.sample(sample);
  const Eigen::Vector3d at = to_eigen(from.at);
  RivalFace nearest;
  std::uint32_t last = no_index;  // rivals of a sample are often of one face
  for (const std::uint32_t rival : turns_.rivals().of(sample)) {
    const std::uint32_t face = turns_.face_of(rival);
    if (face == last || !is_readable(face) || is_in_star(face)) continue;
    last = face;
    const std::array<Vec3, 3> corners = mesh_.triangle(face);
    if (box_of(corners).squaredExteriorDistance(at) >= below) continue;
    const double squared = squared_distance(corners, from.at);
    const Vec3 normal = turns_.normal(face, corners);
    if (squared < std::min(below, nearest.squared) && !turns_.allows(from.normal, normal)) nearest = {squared, normal};
  }
  return nearest;
}

TurnGuard::Nearest TurnGuard::nearest_face(const FaceTurns::Sample& sample) const {
  Nearest nearest;
  for (const Face& face : faces_) {
    const double squared = squared_distance(face.corners, sample.at);
    if (squared < nearest.squared) nearest.squared = squared, nearest.face = &face;
    if (squared < nearest.squared_of_allowed && turns_.allows(sample.normal, face.normal))
      nearest.squared_of_allowed = squared, nearest.allowed = &face;
  }
  return nearest;
}

/// Whether the sample of the star turns little. Of faces that are equally near it belongs to the one that allows it: the
/// others may stay where they are when that one moves.
bool TurnGuard::holds_own(std::size_t i) {
  const FaceTurns::Sample& sample = turns_.sample(own_.samples[i]);
  const RivalFace rival = nearest_rival(own_.samples[i], (1 + single_precision) * own_.squared(i));
  if (rival.squared == HUGE_VAL && turns_.allows(sample.normal, faces_[own_.nearest(i)].normal)) return true;
  const Nearest nearest = nearest_face(sample);
  if (nearest.squared_of_allowed <= (1 + tie) * std::min(nearest.squared, rival.squared)) {
    own_.set_nearest(i, static_cast<std::size_t>(nearest.allowed - faces_.data()));
    return true;
  }
  deviation_ = turns_.angle(sample.normal, nearest.squared <= rival.squared ? nearest.face->normal : rival.normal);
  return false;
}

/// Whether a sample of another face stays nearer to it, or turns little.
bool TurnGuard::holds_other(std::size_t i) {
  const FaceTurns::Sample& sample = turns_.sample(others_.samples[i]);
  if (turns_.allows(sample.normal, faces_[others_.nearest(i)].normal)) return true;
  double& from_own = squared_from_own_[i];
  if (from_own < 0) from_own = squared_distance(mesh_.triangle(turns_.face_of(others_.samples[i])), sample.at);
  if (from_own < (1 - single_precision) * others_.squared(i)) return true;
  const Nearest nearest = nearest_face(sample);
  if (nearest.squared >= (1 - tie) * from_own) return true;
  if (nearest.squared_of_allowed <= (1 + tie) * nearest.squared) return true;
  deviation_ = turns_.angle(sample.normal, nearest.face->normal);
  return false;
}

template <class Holds>
std::optional<std::size_t> TurnGuard::first_refused(Compared& compared, std::span<const SampleFace> faces,
                                                    const Holds& holds) {
  const std::span<const SamplePoints::Block> blocks = compared.points.blocks;
  compared.offsets.resize(blocks.size());
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    kernel_.offsets(blocks.subspan(b, 1), faces, std::span(compared.offsets).subspan(b, 1));
    for (std::size_t i = lanes * b; i < std::min(lanes * (b + 1), compared.samples.size()); ++i)
      if (!holds(i)) return i;
  }
  return std::nullopt;
}

bool TurnGuard::holds_inside(Vec3 point, std::span<const SampleFace> faces) {
  for (Face& face : faces_) {
    face.corners[0] = point;
    face.normal = turns_.normal(face.number, face.corners);
  }
  const std::optional<std::size_t> refused =
      first_refused(own_, faces, [this](std::size_t i) { return holds_own(i); });
  if (refused) own_.put_first(*refused);
  return !refused;
}

bool TurnGuard::holds_around(std::span<const SampleFace> faces) {
  if (!has_others_) find_others();
  return !first_refused(others_, faces, [this](std::size_t i) { return holds_other(i); });
}

void TurnGuard::give_samples(FaceTurns& turns) {
  for (const std::uint32_t face : star_) turns.clear(face);
  for (std::size_t i = 0; i < own_.samples.size(); ++i) turns.give_to(own_.samples[i], faces_[own_.nearest(i)].number);
}

}  // namespace meshbound
