// SPDX-License-Identifier: MIT
#include "meshbound/scene.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>

#include "bvh/bvh_data.h"
#include "meshbound/error.h"
#include "meshbound/motion.h"
#include "meshbound/pose.h"
#include "meshbound/stop_token.h"
#include "numeric/checked_seconds.h"
#include "numeric/numbers_below.h"
#include "numeric/tasks.h"
#include "numeric/thread_count.h"
#include "scene/world_box.h"

namespace meshbound {
namespace {

using BodyPair = std::pair<std::uint32_t, std::uint32_t>;
using MovePair = std::pair<std::uint64_t, std::uint64_t>;

struct Body {
  PlacedModel model;
  const ClosedModel* solid = nullptr;  ///< null: the body has none
  std::uint64_t serial = 0;            ///< version of the tree for which `box` was made
  WorldBox box = {};
  std::uint64_t moves = 0;  ///< counts poses and refits

  void place(const Pose& pose) {
    const PlacedModel placed(*model.bvh, pose);
    box = world_box(placed);
    model.pose = pose;
    serial = model.bvh->data().serial;
    ++moves;
  }
};

/// What is kept about a pair that could not be skipped.
struct PairMemory {
  MovingPair moving;
  MovePair moves;  ///< of both bodies when `check` was made
  std::optional<ToleranceCheck> check = {};
};

/// Whether neither a budget nor `stop_when_deeper` has ended it early.
bool is_complete(const PenetrationDepth& penetration) {
  return std::isfinite(penetration.depth.upper) &&
         std::none_of(penetration.volumes.begin(), penetration.volumes.end(),
                      [](const PenetrationVolume& volume) { return volume.outcome == Outcome::BudgetExhausted; });
}

/// What is kept about a pair of solids whose boxes meet.
struct ContactMemory {
  MovePair moves;                     ///< of both bodies when `penetration` was found
  std::optional<double> error_bound;  ///< for which `penetration` was found
  std::optional<double> decide;       ///< `PenetrationOptions::decide` for which it was found
  std::optional<PenetrationDepth> penetration = {};

  [[nodiscard]] bool answers(const PenetrationOptions& options, const MovePair& now) const {
    return penetration && is_complete(*penetration) && moves == now && error_bound == options.error_bound &&
           decide == options.decide && !options.stop_when_deeper && !options.keep_parts;
  }
};

/// Pairs i < j that `is_near` accepts, ordered by i, then by j. Sweeps along the x axis: `reach(box)` is how far above
/// the lower side of a box the lower side of another box may be, for the two to be tested.
template <class Reach, class IsNear>
std::vector<BodyPair> sweep_and_prune(const std::vector<Body>& bodies, Reach&& reach, IsNear&& is_near) {
  std::vector<std::uint32_t> order = numbers_below(bodies.size());
  const auto low = [&](std::uint32_t i) { return bodies[i].box.lo.x; };
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t i, std::uint32_t j) { return low(i) != low(j) ? low(i) < low(j) : i < j; });
  std::vector<BodyPair> pairs;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const double end = low(order[i]) + reach(bodies[order[i]].box);
    for (std::size_t j = i + 1; j < order.size() && !(low(order[j]) > end); ++j)
      if (is_near(bodies[order[i]].box, bodies[order[j]].box)) pairs.push_back(std::minmax(order[i], order[j]));
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

/// Calls work(i, own) for the numbers in `open`, side by side, each on one thread: `own` are the options of the
/// question without its progress, and with what is left of its time.
template <class Options, class Work>
void for_open_pairs(const std::vector<std::size_t>& open, const Options& options, const Work& work) {
  const StopToken stop = StopToken{}.until(StopToken::Clock::now(), options.budget.seconds);
  with_team(thread_count(options.threads), [&] {
    for_each_task(open.size(), [&](std::size_t k) {
      Options own = options;
      own.threads = 1;
      own.progress = nullptr;
      own.budget.seconds = stop.seconds_left();
      work(open[k], own);
    });
  });
}

/// What rounding may hide along the sweep: the errors of any two boxes, and of the sums.
double rounding_of(const std::vector<Body>& bodies) {
  double largest = 0;
  for (const Body& body : bodies) {
    const WorldBox& box = body.box;
    largest = std::max({largest, 4 * box.error, 0x1p-48 * std::fabs(box.lo.x), 0x1p-48 * std::fabs(box.hi.x)});
  }
  return largest;
}

void check_pose(const ClosedModel* solid, const Pose& pose) {
  if (solid != nullptr && pose.linear().determinant() < 0) throw InvalidInput("the pose of a solid is a reflection");
}

}  // namespace

struct Scene::Impl {
  [[nodiscard]] Body& at(std::uint32_t body) {
    if (body < bodies.size()) return bodies[body];
    throw InvalidInput("the scene has " + std::to_string(bodies.size()) + " bodies; there is none with number " +
                       std::to_string(body));
  }

  /// Makes the boxes of trees that were refitted since.
  void update() {
    for (Body& body : bodies)
      if (body.serial != body.model.bvh->data().serial) body.place(body.model.pose);
  }

  /// The memories of these pairs: kept from the last question for pairs that it had, made anew for the others.
  template <class Memory, class Make>
  static std::vector<Memory*> memories_of(const std::vector<BodyPair>& pairs, std::map<BodyPair, Memory>& memories,
                                          Make&& make) {
    std::map<BodyPair, Memory> kept;
    std::vector<Memory*> found;
    for (const BodyPair& pair : pairs) {
      auto node = memories.extract(pair);
      if (node.empty())
        kept.emplace(pair, make(pair));
      else
        kept.insert(std::move(node));
      found.push_back(&kept.at(pair));
    }
    memories = std::move(kept);
    return found;
  }

  /// Whether the kept answer of a pair is still valid.
  [[nodiscard]] bool stands(const BodyPair& pair, const PairMemory& memory, double tolerance) const {
    return memory.check && memory.check->tolerance == tolerance && memory.check->verdict != Verdict::Undecided &&
           memory.moves == moves_of(pair);
  }
  [[nodiscard]] MovePair moves_of(const BodyPair& pair) const {
    return {bodies[pair.first].moves, bodies[pair.second].moves};
  }

  std::vector<Body> bodies;
  std::map<BodyPair, PairMemory> memories;
  std::map<BodyPair, ContactMemory> contacts;
};

Scene::Scene() : impl_(std::make_unique<Impl>()) {}
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;
Scene::~Scene() = default;

std::uint32_t Scene::add(const Bvh& model, const Pose& pose) {
  Body body{model};
  body.place(pose);
  impl_->bodies.push_back(body);
  return size() - 1;
}

std::uint32_t Scene::add(const ClosedModel& model, const Pose& pose) {
  check_pose(&model, pose);
  const std::uint32_t number = add(model.bvh(), pose);
  impl_->bodies[number].solid = &model;
  return number;
}

void Scene::move(std::uint32_t body, const Pose& pose) {
  Body& moved = impl_->at(body);
  check_pose(moved.solid, pose);
  moved.place(pose);
}

std::uint32_t Scene::size() const { return static_cast<std::uint32_t>(impl_->bodies.size()); }

const PlacedModel& Scene::model(std::uint32_t body) const { return impl_->at(body).model; }

std::vector<std::pair<std::uint32_t, std::uint32_t>> Scene::pairs_near(double margin) const {
  if (!(margin >= 0)) throw InvalidInput("the margin must be a length of 0 or more");
  impl_->update();
  const double rounding = rounding_of(impl_->bodies);
  return sweep_and_prune(
      impl_->bodies, [&](const WorldBox& box) { return (box.hi.x - box.lo.x) + margin + rounding; },
      [&](const WorldBox& a, const WorldBox& b) { return may_be_near(a, b, margin); });
}

SceneCheck Scene::check_tolerance(double tolerance, const DistanceOptions& options) {
  if (!(tolerance >= 0)) throw InvalidInput("the tolerance must be a length of 0 or more");
  (void)checked_seconds(options.budget.seconds);
  impl_->update();
  const double rounding = rounding_of(impl_->bodies);
  const std::vector<BodyPair> pairs = sweep_and_prune(
      impl_->bodies, [&](const WorldBox&) { return tolerance + rounding; },
      [&](const WorldBox& a, const WorldBox& b) { return !(distance_at_least(a, b) > tolerance); });
  const std::vector<PairMemory*> memories = Impl::memories_of(pairs, impl_->memories, [&](const BodyPair& pair) {
    return PairMemory{MovingPair(*model(pair.first).bvh, *model(pair.second).bvh), {}, {}};
  });

  SceneCheck result;
  for (const BodyPair& pair : pairs) result.pairs.push_back({pair.first, pair.second, {}});
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    if (!impl_->stands(pairs[i], *memories[i], tolerance)) open.push_back(i);
  for_open_pairs(open, options, [&](std::size_t i, const DistanceOptions& own) {
    PairMemory& memory = *memories[i];
    memory.check.reset();
    memory.check =
        memory.moving.check_tolerance(model(pairs[i].first).pose, model(pairs[i].second).pose, tolerance, own);
    memory.moves = impl_->moves_of(pairs[i]);
  });
  for (std::size_t i = 0; i < pairs.size(); ++i) result.pairs[i].check = *memories[i]->check;
  const std::uint64_t n = size();
  result.stats.pairs = n > 0 ? n * (n - 1) / 2 : 0;
  result.stats.skipped_by_boxes = result.stats.pairs - pairs.size();
  result.stats.unmoved = pairs.size() - open.size();
  result.stats.searched = open.size();
  for (const std::size_t i : open)
    for (const OneSidedDistance* side : {&result.pairs[i].check.a_to_b, &result.pairs[i].check.b_to_a})
      result.stats.closest_point_queries += side->stats.closest_point_queries;
  return result;
}

SceneContacts Scene::contacts(const PenetrationOptions& options) {
  if (!(options.error_bound.value_or(0) >= 0)) throw InvalidInput("the error bound must be a length of 0 or more");
  (void)checked_seconds(options.budget.seconds);
  const std::vector<Body>& bodies = impl_->bodies;
  std::vector<BodyPair> pairs = pairs_near();
  SceneContacts result;
  ContactStats& stats = result.stats;
  const std::uint64_t n = size();
  stats.pairs = n > 0 ? n * (n - 1) / 2 : 0;
  stats.skipped_by_boxes = stats.pairs - pairs.size();
  stats.without_solid = std::erase_if(pairs, [&](const BodyPair& pair) {
    return bodies[pair.first].solid == nullptr || bodies[pair.second].solid == nullptr;
  });
  const std::vector<ContactMemory*> memories =
      Impl::memories_of(pairs, impl_->contacts, [](const BodyPair&) { return ContactMemory{}; });
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    if (!memories[i]->answers(options, impl_->moves_of(pairs[i]))) open.push_back(i);
  for_open_pairs(open, options, [&](std::size_t i, const PenetrationOptions& own) {
    const Body &a = bodies[pairs[i].first], &b = bodies[pairs[i].second];
    ContactMemory& memory = *memories[i];
    memory = {impl_->moves_of(pairs[i]), options.error_bound, options.decide, {}};
    memory.penetration = penetration_depth({*a.solid, a.model.pose}, {*b.solid, b.model.pose}, own);
  });
  stats.measured = open.size();
  stats.unmoved = pairs.size() - open.size();
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const PenetrationDepth& penetration = *memories[i]->penetration;
    if (penetration.volumes_known && penetration.volumes.empty())
      ++stats.without_volume;
    else
      result.pairs.push_back({pairs[i].first, pairs[i].second, penetration});
  }
  return result;
}

}  // namespace meshbound
