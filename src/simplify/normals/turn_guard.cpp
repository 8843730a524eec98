// SPDX-License-Identifier: MIT
#include "simplify/normals/turn_guard.h"

#include <algorithm>

#include "geometry/boxes.h"
#include "numeric/sort_unique.h"

namespace meshbound {
namespace {

/// Squared distances that differ by less than this share count as equal: the nearest point lies on a common edge.
constexpr double tie = 1e-9;

/// By how much squared distances in single precision may be off, with room: they only tell where doubles are needed.
constexpr double single_precision = 1e-3;

/// Samples with one rival that are looked at: a floor is the rival of thousands.
constexpr std::size_t max_with_rival = 64;

/// In squared distances of the sample from the star: faces beside those that hold nearer rivals are looked at. Runs
/// take as long with 1.5, 3 and 5; all would cost a tenth where surfaces bend much (four models at three tolerances).
constexpr double near_rival = 2;

/// In squared distances of the sample from the star: rivals beyond are left alone, so that what holds them would have
/// to have moved by three quarters of the way. With 64 or with all rivals as many faces come out of twelve runs (six
/// models at 1% and 0.1%, 30 degrees); these checks take up to half as long again with all. With 4 up to 4% more faces
/// come out, as more is taken back.
constexpr double far_rival = 16;

constexpr std::size_t lanes = 8;

/// Blocks of samples that are compared before it is asked which of them hold: the widest vectors take two.
constexpr std::size_t blocks_at_once = 2;

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
  return static_cast<std::size_t>(distances[i / lanes].face[i % lanes]);
}

void TurnGuard::Compared::set_nearest(std::size_t i, std::size_t face) {
  distances[i / lanes].face[i % lanes] = static_cast<float>(face);
}

double TurnGuard::Compared::squared(std::size_t i) const { return distances[i / lanes].squared[i % lanes]; }

TurnGuard::TurnGuard(const FaceTurns& turns, const ArrayMesh& mesh) : turns_(turns), mesh_(mesh) {}

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
  in_star_.clear();
  for (const std::uint32_t face : star_) {
    in_star_.insert(face);
    turns_.for_each_sample(face, [&](std::uint32_t s) { add(s, own_); });
  }
  has_others_ = false;
}

/// Finds the samples of faces beside the star, and those that have a rival in it. The vertices of a star all belong to
/// the region of its collapse, so no other thread changes the faces beside it or their samples.
void TurnGuard::find_others() {
  around_.clear();
  others_.clear();
  for (const Corner c : moved_) {
    const Corner across = mesh_.twin(next_corner(c));
    if (across == no_index || in_star_.contains(across / 3) || !around_.insert(across / 3)) continue;
    turns_.for_each_sample(across / 3, [&](std::uint32_t s) { add(s, others_); });
  }
  numbers_.clear();
  for (const std::uint32_t s : own_.samples) {
    const auto with = turns_.rivals().with(s);
    for (const std::uint32_t other : with.first(std::min(with.size(), max_with_rival))) {
      const std::uint32_t face = turns_.face_of(other);
      const bool is_known = in_star_.contains(face) || around_.contains(face);
      if (!is_known && is_readable(face)) numbers_.push_back(other);
    }
  }
  sort_unique(numbers_);
  for (const std::uint32_t s : numbers_) add(s, others_);
  squared_from_own_.assign(others_.samples.size(), -1);
  has_others_ = true;
}

/// Sets `nearest` to a face outside the star that the sample turns too much from, if its squared distance is less than
/// `below` and than that of the present `nearest`.
void TurnGuard::look_at(std::uint32_t face, const FaceTurns::Sample& sample, double below,
                        std::optional<RivalFace>& nearest) const {
  if (!is_readable(face) || in_star_.contains(face)) return;
  const double limit = nearest ? nearest->squared : below;
  const TriangleCorners corners = mesh_.triangle(face);
  if (squared_distance(box_of(corners), sample.at) >= limit) return;
  const double squared = squared_distance(corners, sample.at);
  if (squared >= limit) return;
  const Vec3 normal = turns_.normal(face, corners);
  if (!turns_.allows(sample.normal, normal)) nearest = {squared, normal};
}

/// The nearest of the faces outside the star that hold rivals of sample i and that it turns too much from; absent where
/// none is nearer to the sample than the star is.
std::optional<TurnGuard::RivalFace> TurnGuard::nearest_rival(std::size_t i) const {
  const FaceTurns::Sample& sample = turns_.sample(own_.samples[i]);
  std::optional<RivalFace> nearest;
  std::uint32_t last = no_index;  // rivals of a sample are often of one face
  const double below = (1 + single_precision) * own_.squared(i);
  for (const Rivals::Rival& rival : turns_.rivals().of(own_.samples[i])) {
    if (rival.squared > far_rival * below) break;
    const std::uint32_t face = turns_.face_of(rival.triangle);
    if (face != last) look_at(face, sample, below, nearest);
    last = face;
  }
  return nearest;
}

/// As `nearest_rival`, for the faces that share an edge with one that holds a near rival: a rival belongs to the face
/// nearest to its middle, and the part of it that is nearest to the sample may have become another face.
std::optional<TurnGuard::RivalFace> TurnGuard::nearest_beside_rivals(std::size_t i) const {
  const FaceTurns::Sample& sample = turns_.sample(own_.samples[i]);
  const double below = (1 + single_precision) * own_.squared(i);
  std::optional<RivalFace> nearest;
  for (const Rivals::Rival& rival : turns_.rivals().of(own_.samples[i])) {
    if (rival.squared > near_rival * below) break;
    const std::uint32_t face = turns_.face_of(rival.triangle);
    if (!is_readable(face)) continue;
    for (Corner c = 3 * face; c < 3 * face + 3; ++c)
      if (mesh_.twin(c) != no_index) look_at(mesh_.twin(c) / 3, sample, below, nearest);
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

/// Whether the sample turns little from the nearest face, of the star or of those that hold its rivals.
bool TurnGuard::holds_own(std::size_t i) {
  const std::optional<RivalFace> rival = nearest_rival(i);
  const Vec3 normal = turns_.sample(own_.samples[i]).normal;
  return (!rival && turns_.allows(normal, faces_[own_.nearest(i)].normal)) || holds_against(i, rival);
}

/// Compares in doubles. Of faces that are equally near the sample belongs to the one that it turns little from: the
/// others may stay where they are when that one moves.
bool TurnGuard::holds_against(std::size_t i, const std::optional<RivalFace>& rival) {
  const FaceTurns::Sample& sample = turns_.sample(own_.samples[i]);
  const Nearest nearest = nearest_face(sample);
  const bool is_rival_nearer = rival && rival->squared < nearest.squared;
  if (nearest.squared_of_allowed <= (1 + tie) * (is_rival_nearer ? rival->squared : nearest.squared)) {
    own_.set_nearest(i, static_cast<std::size_t>(nearest.allowed - faces_.data()));
    return true;
  }
  deviation_ = turns_.angle(sample.normal, is_rival_nearer ? rival->normal : nearest.face->normal);
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
  compared.distances.resize(blocks.size());
  for (std::size_t b = 0; b < blocks.size(); b += blocks_at_once) {
    const std::size_t count = std::min(blocks_at_once, blocks.size() - b);
    kernel_.distances(blocks.subspan(b, count), faces, std::span(compared.distances).subspan(b, count));
    for (std::size_t i = lanes * b; i < std::min(lanes * (b + count), compared.samples.size()); ++i)
      if (!holds(i)) return i;
  }
  return std::nullopt;
}

bool TurnGuard::holds_inside(Vec3 point, std::span<const SampleFace> faces) {
  for (Face& face : faces_) {
    face.corners[0] = point;
    face.normal = turns_.normal(face.number, face.corners);
  }
  const std::optional<std::size_t> refused = first_refused(own_, faces, [this](std::size_t i) { return holds_own(i); });
  if (refused) own_.put_first(*refused);
  return !refused;
}

bool TurnGuard::holds_around(std::span<const SampleFace> faces) {
  for (std::size_t i = 0; i < own_.samples.size(); ++i) {
    const std::optional<RivalFace> rival = nearest_beside_rivals(i);
    if (rival && !holds_against(i, rival)) return false;
  }
  if (!has_others_) find_others();
  return !first_refused(others_, faces, [this](std::size_t i) { return holds_other(i); });
}

void TurnGuard::give_samples(FaceTurns& turns) {
  for (const std::uint32_t face : star_) turns.clear(face);
  for (std::size_t i = 0; i < own_.samples.size(); ++i) turns.give_to(own_.samples[i], faces_[own_.nearest(i)].number);
}

}  // namespace meshbound
