// SPDX-License-Identifier: MIT
#include "texture/triangle_deviation.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "texture/charts.h"
#include "texture/line_chart.h"
#include "texture/pair_bound.h"

namespace meshbound {
namespace {

using Line = Overlay::Line;
using Node = Overlay::Node;
using Polygon = Overlay::Polygon;

/// How much of a piece a candidate covers.
enum class Cover { None, Part, All };

/// A convex piece of A; every point of it is covered by the candidates of `full`, and perhaps some by those of `part`.
struct Piece {
  Polygon polygon;
  std::vector<std::uint32_t> full, part;
  bool has_all = false;   ///< all candidates were looked at, not only the likely ones
  bool has_near = false;  ///< likely candidates that are farther away than the reach may have been left out
};

/// An upper bound for a piece, and the corner that it comes from.
struct PieceBound {
  double upper = HUGE_VAL;
  const Node* where = nullptr;
};

/// How much of the polygon the candidate covers. None: at most points of its border. For Part, `cut` is set to a line
/// of the candidate with corners of the polygon on both sides.
Cover cover_of(Overlay& overlay, const Polygon& polygon, std::uint32_t candidate, Line& cut) {
  Cover cover = Cover::All;
  for (const Line line : overlay.lines_of(candidate)) {
    bool has_inside = false, has_outside = false;
    for (const auto& corner : polygon) {
      const int side = overlay.side(line, corner.node);
      has_inside = has_inside || side > 0;
      has_outside = has_outside || side < 0;
      if (has_inside && (has_outside || cover == Cover::Part)) break;  // the rest changes nothing
    }
    if (has_outside && !has_inside) return Cover::None;
    if (has_outside && cover == Cover::All) cover = Cover::Part, cut = line;
  }
  return cover;
}

/// Whether the box of a triangle in space is known to be farther away. The box and the distance round by a few units of
/// the last places.
bool is_beyond(const ChartTriangle& t, const std::array<Approximate, 3>& point, double distance) {
  const Eigen::AlignedBox3d place = place_of(*t.source);
  const Eigen::Vector3d p(point[0].value, point[1].value, point[2].value);
  const double largest = p.cwiseAbs().cwiseMax(place.min().cwiseAbs()).cwiseMax(place.max().cwiseAbs()).maxCoeff(),
               error = point[0].error + point[1].error + point[2].error + 0x1p-45 * largest;
  const Eigen::Vector3d outside = (place.min() - p).cwiseMax(p - place.max()).cwiseMax(0.0);
  return outside.stableNorm() * (1 - 0x1p-40) - error > distance;
}

/// Sets the lower bound to the distance from the point to the nearest candidate that covers it, if that is larger or no
/// distance is known yet.
void include(Overlay& overlay, const Node& node, double precision, TriangleDeviation& result) {
  double nearest = HUGE_VAL;
  std::uint32_t candidate = 0;
  const bool has_area = overlay.triangle().chart == Chart::Area;
  const std::array<Approximate, 3> at = has_area ? std::array<Approximate, 3>{} : overlay.near_position(node);
  for (std::uint32_t c = 0; c < overlay.candidates(); ++c) {
    if (!has_area && is_beyond(overlay.candidate(c), at, nearest)) continue;
    if (!overlay.covers(c, node)) continue;
    const Bounds rough = overlay.rough_distance(c, node);
    if (result.far && rough.upper <= result.bounds.lower) return;
    const double lower = overlay.refined(rough, c, node, precision).lower;
    if (lower < nearest) nearest = lower, candidate = c;
    if (result.far && nearest <= result.bounds.lower) return;
  }
  if (nearest == HUGE_VAL) return;
  result.bounds.lower = nearest;
  result.far = FarPoint{node, candidate};
}

/// Candidates from which on the lower bound is raised first, where a few of them are farthest. With 12, runs of
/// `simplify_with_bound` with a texture take 4% longer (seven models at three tolerances), with 64 one of them does.
constexpr std::size_t many_candidates = 256, max_worst = 8;

/// Candidates up to which a piece is not crowded. With 8 of them, runs took 0.92 to 1.2 of the time (a mesh of 12,000
/// triangles with three scalar fields as its texture coordinate).
constexpr std::size_t few_candidates = 24;
/// Share of the candidates of a piece that each of its halves has at most; else halving it in space is in vain.
constexpr double max_share_of_half = 0.75;

class PieceSearch {
 public:
  PieceSearch(Overlay& overlay, const FindOthers& find_others, const DeviationGoal& goal)
      : overlay_(overlay), find_others_(find_others), likely_(overlay.candidates()), goal_(goal) {}

  /// Starts with the whole triangle. Every point of a candidate that covers some area of A lies in a piece that a
  /// candidate covers, or on its border. What no candidate covers is left; all other candidates matter only where they
  /// touch that.
  TriangleDeviation run(Covering& covering) {
    is_bounded_.assign(likely_, 0);
    if (overlay_.triangle().chart == Chart::Area)
      search_beside_near_ones(covering);
    else
      search_without_area();
    const std::vector<std::uint8_t> is_bounded = is_bounded_;  // not by pieces of what is touched below
    for (const Polygon& polygon : std::exchange(uncovered_, {})) {
      result_.uncovered = result_.uncovered + overlay_.share(polygon);
      search_where_touched(polygon, is_bounded);
    }
    if (!result_.far && result_.bounds.upper > goal_.silent) look_at_corners();
    return std::move(result_);
  }

  TriangleDeviation at_corners() {
    look_at_corners();
    return std::move(result_);
  }

 private:
  /// Accepts what candidates cover that are within the limit everywhere, and searches the rest.
  void search_beside_near_ones(Covering& covering) {
    if (overlay_.spanning().size() >= many_candidates) raise_at_worst();
    const std::vector<std::uint32_t> candidates = spanning_from(0);
    const bool has_all = has_others_;
    std::vector<std::uint32_t> near, rest;
    double upper = goal_.min_upper;
    for (const std::uint32_t c : candidates) {
      const double bound = upper_of_pair(overlay_.triangle(), overlay_.candidate(c), upper, goal_.precision);
      const bool is_near = bound <= limit();
      (is_near ? near : rest).push_back(c);
      if (is_near) upper = bound;
    }
    auto uncovered = near.empty() ? std::nullopt : covering.uncovered(overlay_, near);
    if (!uncovered) return search(Piece{overlay_.whole(), {}, candidates, has_all});
    ++result_.pieces;
    accept(upper);
    for (const std::uint32_t c : near) is_bounded_[c] = 1;
    for (Polygon& polygon : *uncovered) search(Piece{std::move(polygon), {}, rest, has_all});
  }

  /// Raises the lower bound where the upper bounds are largest, at the corners of what single candidates cover: most
  /// others are near then, and A is not cut by them. All candidates join the overlay: those that share a sliver with A
  /// only, along its border, would leave the edges of many open.
  void raise_at_worst() {
    add_others();
    std::vector<std::pair<double, std::uint32_t>> worst;
    for (const std::uint32_t c : overlay_.spanning())
      worst.emplace_back(upper_of_pair(overlay_.triangle(), overlay_.candidate(c), limit(), goal_.precision), c);
    const auto last = worst.begin() + static_cast<std::ptrdiff_t>(max_worst);
    std::partial_sort(worst.begin(), last, worst.end(), std::greater<>());
    for (auto at = worst.begin(); at != last && at->first > limit(); ++at) {
      overlay_.clip(overlay_.whole(), at->second, covered_);
      for (const auto& corner : Polygon(covered_)) raise(corner.node);
    }
  }

  /// Bounds a triangle that has no area in the texture. Many candidates may have the texture coordinates of a piece and
  /// lie far from it in space. So pieces are halved in space first, and keep the candidates within reach. Where these
  /// leave a piece uncovered, the search starts again with all likely candidates and halves by coordinates alone: in a
  /// gap between two coordinates candidates move far, and short pieces would be halved far more often than long ones.
  void search_without_area() {
    search(Piece{overlay_.whole(), {}, spanning_likely(), false, true});
    if (!std::exchange(needs_far_, false)) return;
    result_.bounds.upper = -1;
    result_.gave_up = false;
    result_.pieces = 0;
    is_bounded_.assign(overlay_.candidates(), 0);
    search(Piece{overlay_.whole(), {}, spanning_likely()});
  }

  /// The candidates from `first` on that can cover more of A than a line or a point.
  [[nodiscard]] std::vector<std::uint32_t> spanning_from(std::uint32_t first) const {
    const std::span<const std::uint32_t> spanning = overlay_.spanning();
    return {std::lower_bound(spanning.begin(), spanning.end(), first), spanning.end()};
  }

  [[nodiscard]] std::vector<std::uint32_t> spanning_likely() const {
    const std::span<const std::uint32_t> spanning = overlay_.spanning();
    return {spanning.begin(), std::lower_bound(spanning.begin(), spanning.end(), likely_)};
  }

  /// Bounds what candidates cover of an uncovered polygon, which is of its border: but for what lies in pieces with a
  /// bound, or was covered by one of the candidates before. Many may lie on one line.
  void search_where_touched(const Polygon& uncovered, const std::vector<std::uint8_t>& is_bounded) {
    std::vector<std::uint8_t> is_searched(overlay_.candidates(), 0);
    for (std::uint32_t c = 0; c < overlay_.candidates(); ++c) {
      if (is_bounded[c] != 0) continue;
      overlay_.clip(uncovered, c, covered_);
      if (covered_.empty() || lies_in_one(covered_, is_bounded) || lies_in_one(covered_, is_searched)) continue;
      is_searched[c] = 1;
      Piece piece{covered_, {c}, {}, true};
      for (std::uint32_t other = 0; other < overlay_.candidates(); ++other)
        if (other != c) piece.part.push_back(other);
      search(std::move(piece));
    }
  }

  /// Whether one of some candidates covers all of a polygon.
  [[nodiscard]] bool lies_in_one(const Polygon& polygon, const std::vector<std::uint8_t>& is_one) {
    for (std::uint32_t c = 0; c < overlay_.candidates(); ++c) {
      const auto covers = [&](const auto& corner) { return overlay_.covers(c, corner.node); };
      if (is_one[c] != 0 && std::all_of(polygon.begin(), polygon.end(), covers)) return true;
    }
    return false;
  }

  void search(Piece piece) {
    stack_.push_back(std::move(piece));
    while (!stack_.empty()) {
      goal_.stop.check();
      Piece top = std::move(stack_.back());
      stack_.pop_back();
      bound(top);
      spare_.push_back(std::move(top));
    }
  }

  /// A piece to be set anew: one that is done with, for its memory, if there is one.
  Piece unused_piece() {
    if (spare_.empty()) return {};
    Piece piece = std::move(spare_.back());
    spare_.pop_back();
    return piece;
  }

  /// Upper bounds up to it suffice: all finite ones, once the triangle is known to be too far.
  [[nodiscard]] double limit() const {
    if (result_.bounds.lower > goal_.silent) return std::numeric_limits<double>::max();
    return std::max(goal_.lower, result_.bounds.lower) + goal_.error_bound;
  }

  void accept(double upper) { result_.bounds.upper = std::max(result_.bounds.upper, upper); }

  /// An upper bound of the distance to the candidate, as precise as it takes to compare it with the limit and with what
  /// is known already.
  double upper_at(std::uint32_t candidate, const Node& node, double known) {
    const Bounds rough = overlay_.rough_distance(candidate, node);
    if (rough.lower >= known || rough.upper <= limit()) return rough.upper;
    return overlay_.refined(rough, candidate, node, goal_.precision).upper;
  }

  /// Lowers the bound to the candidate's, which must cover the piece: the largest at a corner, as the distance to one
  /// candidate is convex. Returns whether it is within the limit.
  bool lower_bound_to(const Piece& piece, std::uint32_t candidate, PieceBound& bound) {
    PieceBound of_candidate{0, nullptr};
    for (const auto& corner : piece.polygon) {
      const double at = upper_at(candidate, corner.node, bound.upper);
      if (at >= bound.upper) return false;
      if (at >= of_candidate.upper) of_candidate = {at, &corner.node};
    }
    bound = of_candidate;
    return bound.upper <= limit();
  }

  /// Moves the candidates of `part` that cover all of the piece to `full` and drops those that cover nothing, until one
  /// is within the limit. Returns whether one is; else `cuts_` has, for each that is left in `part`, a line of it that
  /// has some of the piece on both sides.
  bool sort_candidates(Piece& piece, PieceBound& bound) {
    cuts_.clear();
    for (const std::uint32_t c : piece.part) {
      Line cut = 0;
      const Cover cover = cover_of(overlay_, piece.polygon, c, cut);
      if (cover == Cover::All) {
        is_bounded_[c] = 1;
        piece.full.push_back(c);
        if (lower_bound_to(piece, c, bound)) return true;
      }
      if (cover != Cover::Part) continue;
      piece.part[cuts_.size()] = c;
      cuts_.push_back(cut);
    }
    piece.part.resize(cuts_.size());
    return false;
  }

  void bound(Piece& piece) {
    ++result_.pieces;
    if (is_crowded(piece) && halve_in_space(piece)) return;
    PieceBound bound;
    for (const std::uint32_t c : piece.full)
      if (lower_bound_to(piece, c, bound)) return accept(bound.upper);
    if (sort_candidates(piece, bound)) return accept(bound.upper);
    const bool is_covered = !piece.full.empty();
    if (is_covered && !has_no_area() && has_many(piece)) drop_far(piece, bound.upper);
    if (is_covered && result_.pieces >= goal_.max_pieces) {
      result_.gave_up = true;
      return accept(bound.upper);
    }
    // A middle one halves pieces: candidates are in spatial order.
    if (!cuts_.empty()) return split(piece, cuts_[cuts_.size() / 2]);
    if (piece.has_near && !is_covered) return give_up_near();
    if (piece.has_near && !is_within_reach(piece)) return take_likely(piece);
    const bool may_do_without_others = has_no_area() && is_covered && !has_others_;
    if (!piece.has_all && !may_do_without_others) return take_all(piece);
    if (!is_covered) return uncovered_.push_back(std::move(piece.polygon));
    if (bound.where == nullptr) return accept(bound.upper);  // the distance overflows
    probe(piece, *bound.where);
    if (bound.upper > limit() && !piece.has_all && has_others_) return take_all(piece);  // the probe has added them
    if (bound.upper <= limit() || piece.full.size() == 1) return accept(bound.upper);
    if (has_no_area()) drop_far(piece, bound.upper);
    if (const auto line = parting_line(piece, *bound.where)) return split(piece, *line);
    accept(bound.upper);
  }

  void add_others() {
    if (std::exchange(has_others_, true)) return;
    for (const ChartTriangle* other : find_others_()) overlay_.add(*other);
    is_bounded_.resize(overlay_.candidates(), 0);
    unlikely_ = spanning_from(likely_);
    Line cut = 0;
    std::erase_if(unlikely_, [&, whole = overlay_.whole()](std::uint32_t c) {
      return cover_of(overlay_, whole, c, cut) == Cover::None;
    });
  }

  /// Raises the lower bound at the corners of A, or at one covered point if no corner is covered.
  void look_at_corners() {
    add_others();
    for (const auto& corner : overlay_.whole()) raise(corner.node);
    for (std::uint32_t c = 0; c < overlay_.candidates() && !result_.far; ++c) {
      overlay_.clip(overlay_.whole(), c, covered_);
      if (!covered_.empty()) raise(covered_.front().node);
    }
  }

  [[nodiscard]] static bool has_many(const Piece& piece) {
    return piece.full.size() + piece.part.size() > few_candidates;
  }

  /// Whether there are many candidates, and the piece is so long that not all can be near all of it.
  [[nodiscard]] bool is_crowded(const Piece& piece) const {
    return piece.has_near && has_many(piece) && place_of_piece(piece.polygon).diagonal().norm() > goal_.reach;
  }

  /// Halves a piece across its longest extent, and leaves each half those candidates that are within reach of it. False
  /// where that does not part them.
  bool halve_in_space(const Piece& piece) {
    const auto line = middle_line(piece.polygon);
    if (!line) return false;
    std::array<Piece, 2> halves = {unused_piece(), unused_piece()};
    std::size_t largest = 0;
    for (const bool flip : {false, true}) {
      Piece& half = halves[flip ? 1 : 0];
      set_half(piece, *line, flip, half);
      drop_beyond_reach(half);
      largest = std::max(largest, half.full.size() + half.part.size());
    }
    const bool is_parted =
        static_cast<double>(largest) <= max_share_of_half * static_cast<double>(piece.full.size() + piece.part.size());
    for (Piece& half : halves) (is_parted && !half.polygon.empty() ? stack_ : spare_).push_back(std::move(half));
    return is_parted;
  }

  /// Whether a candidate is farther than `distance` from all of a piece. Rounding may decide.
  [[nodiscard]] auto is_farther_than(double distance, const Piece& piece) const {
    return [this, distance, place = place_of_piece(piece.polygon)](std::uint32_t c) {
      return distance_between(place, place_of(*overlay_.candidate(c).source)) > distance;
    };
  }

  void drop_beyond_reach(Piece& piece) const {
    const auto is_far = is_farther_than(goal_.reach, piece);
    std::erase_if(piece.full, is_far);
    std::erase_if(piece.part, is_far);
  }

  /// Whether each corner of the piece is within reach of a candidate that covers the piece.
  [[nodiscard]] bool is_within_reach(const Piece& piece) {
    return std::all_of(piece.polygon.begin(), piece.polygon.end(), [&](const auto& corner) {
      return std::any_of(piece.full.begin(), piece.full.end(),
                         [&](std::uint32_t c) { return overlay_.rough_distance(c, corner.node).lower <= goal_.reach; });
    });
  }

  /// Goes on with the piece and all likely candidates.
  void take_likely(Piece& piece) {
    piece.full.clear();
    piece.part = spanning_likely();
    piece.has_all = false;
    piece.has_near = false;
    bound(piece);
  }

  /// Ends a search with near candidates.
  void give_up_near() {
    needs_far_ = true;
    stack_.clear();
  }

  /// Goes on with the piece and the candidates that are not likely.
  void take_all(Piece& piece) {
    add_others();
    piece.part = unlikely_;
    piece.has_all = true;
    bound(piece);
  }

  /// Sets `half` to what of the piece lies inside the line or on it; with `flip`, outside or on it.
  void set_half(const Piece& piece, Line line, bool flip, Piece& half) {
    overlay_.clip(piece.polygon, line, flip, half.polygon);
    half.full = piece.full;
    half.part = piece.part;
    half.has_all = piece.has_all;
    half.has_near = piece.has_near;
  }

  void split(const Piece& piece, Line line) {
    for (const bool flip : {false, true}) {
      Piece half = unused_piece();
      set_half(piece, line, flip, half);
      (half.polygon.empty() ? spare_ : stack_).push_back(std::move(half));
    }
  }

  /// Raises the lower bound at the worst corner of the piece, at a point inside next to it, where only candidates of
  /// the piece count, and at the middle of the piece.
  void probe(const Piece& piece, const Node& worst) {
    constexpr int next_to = 26;  // half of the bits of a double
    raise_in(piece, worst);
    raise_in(piece, inside(piece.polygon, worst, next_to));
    if (piece.full.size() > 1) raise_in(piece, inside(piece.polygon, worst, 0));
  }

  /// A point inside of the piece, about 2^-`closer` of the way from the corner to the middle. Where rounding would move
  /// it out of a thin piece, an exact one.
  Node inside(const Polygon& piece, const Node& corner, int closer) {
    const std::array<double, 3> from = Overlay::rounded(corner);
    std::array<double, 3> weights = from;
    for (const auto& c : piece) {
      const std::array<double, 3> w = Overlay::rounded(c.node);
      for (std::size_t i = 0; i < 3; ++i)
        weights[i] += std::ldexp((w[i] - from[i]) / static_cast<double>(piece.size()), -closer);
    }
    const Node rounded = Overlay::given(weights);
    const bool has_inside = piece.size() > 1;
    return !has_inside || overlay_.is_inside(piece, rounded) ? rounded : overlay_.inside(piece, corner, closer);
  }

  /// As `raise`, at a point of the piece. Mostly one of the candidates that cover the piece is near enough to tell that
  /// nothing is raised.
  void raise_in(const Piece& piece, const Node& node) {
    const auto is_near = [&](std::uint32_t c) {
      return overlay_.rough_distance(c, node).upper <= result_.bounds.lower;
    };
    if (!result_.far || std::none_of(piece.full.begin(), piece.full.end(), is_near)) raise(node);
  }

  void raise(const Node& node) {
    if (has_no_area() && !is_near_likely(node)) add_others();
    include(overlay_, node, goal_.precision, result_);
  }

  [[nodiscard]] bool has_no_area() const { return overlay_.triangle().chart != Chart::Area; }

  /// Whether a likely candidate is so near that none of the others is nearer.
  [[nodiscard]] bool is_near_likely(const Node& node) {
    for (std::uint32_t c = 0; c < likely_; ++c)
      if (overlay_.covers(c, node) && overlay_.rough_distance(c, node).upper <= goal_.reach) return true;
    return false;
  }

  [[nodiscard]] Eigen::AlignedBox3d place_of_piece(const Polygon& polygon) const {
    Eigen::AlignedBox3d place;
    for (const auto& corner : polygon) {
      const std::array<Approximate, 3> at = overlay_.near_position(corner.node);
      place.extend(Eigen::Vector3d(at[0].value, at[1].value, at[2].value));
    }
    return place;
  }

  /// Drops candidates that are farther from all of the piece than `upper`, a bound of one that covers it: where many
  /// share a part of the texture, or the triangle has no area there, most are. Rounding may decide, but some are left:
  /// what none covers is uncovered.
  void drop_far(Piece& piece, double upper) {
    const auto is_far = is_farther_than(upper, piece);
    if (!std::all_of(piece.full.begin(), piece.full.end(), is_far)) std::erase_if(piece.full, is_far);
    std::size_t left = 0;
    for (std::size_t i = 0; i < piece.part.size(); ++i) {
      if (is_far(piece.part[i])) continue;
      piece.part[left] = piece.part[i];
      cuts_[left++] = cuts_[i];
    }
    piece.part.resize(left);
    cuts_.resize(left);
  }

  /// A line that parts what different candidates are near, else one that halves the piece.
  std::optional<Line> parting_line(const Piece& piece, const Node& worst) {
    if (overlay_.triangle().chart == Chart::Segment)
      if (const auto line = line_along_edge(piece, worst)) return line;
    return halving_line(piece);
  }

  /// A line along an edge of a candidate that is near the worst corner of the piece, in the chart where a point is
  /// compared with that of the same place (`LineChart`). Halving alone would come near the edges of candidates in steps
  /// as small as the limit.
  std::optional<Line> line_along_edge(const Piece& piece, const Node& worst) {
    if (!chart_) chart_.emplace(overlay_.triangle());
    for (const std::uint32_t c : piece.full) {
      if (overlay_.candidate(c).chart != Chart::Segment || overlay_.rough_distance(c, worst).upper > limit()) continue;
      for (std::size_t k = 0; k < 3; ++k)
        if (const auto line = line_of_edge(*overlay_.candidate(c).source, k, piece.polygon)) return line;
    }
    return std::nullopt;
  }

  /// The line along edge k of `b` in the chart, if corners of the polygon are clearly on both sides of it.
  std::optional<Line> line_of_edge(const TexturedTriangle& b, std::size_t k, const Polygon& polygon) {
    constexpr double margin = 0x1p-36;  // of the largest value: more than lines and weights are rounded
    const Eigen::Vector2d from = chart_->corner(b, k), way = chart_->corner(b, (k + 1) % 3) - from;
    Eigen::Vector3d at;  // at the corners of A: how far they are from the line, times its length
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector2d step = chart_->corner(*overlay_.triangle().source, i) - from;
      at[static_cast<Eigen::Index>(i)] = way.x() * step.y() - way.y() * step.x();
    }
    const double largest = at.cwiseAbs().maxCoeff();
    if (!(largest > 0 && largest < HUGE_VAL)) return std::nullopt;
    double low = 0, high = 0;
    for (const auto& corner : polygon) {
      const std::array<double, 3> w = Overlay::rounded(corner.node);
      const double value = at.dot(Eigen::Vector3d(w[0], w[1], w[2]));
      low = std::min(low, value), high = std::max(high, value);
    }
    if (!(low < -margin * largest && high > margin * largest)) return std::nullopt;
    return overlay_.add_cut({at[0], at[1], at[2]});
  }

  /// A line that halves the piece where the way to candidates varies most. Across the coordinates of a segment what a
  /// candidate has there may move as far as the candidate is long, however thin the piece is: where coordinates are
  /// rounded, a candidate may have all of its own within a few units of the last place.
  std::optional<Line> halving_line(const Piece& piece) {
    if (overlay_.triangle().chart == Chart::Segment) {
      const double extent = place_of_piece(piece.polygon).diagonal().norm();
      if (std::any_of(piece.full.begin(), piece.full.end(), [&](std::uint32_t c) { return sweeps(c, piece, extent); }))
        if (const auto line = overlay_.add_middle_coordinate(piece.polygon)) return line;
    }
    return middle_line(piece.polygon);
  }

  /// Whether the points of the candidate with coordinates of the piece move by more than `limit` from corner to corner.
  [[nodiscard]] bool sweeps(std::uint32_t candidate, const Piece& piece, double limit) {
    if (overlay_.candidate(candidate).chart == Chart::Point) return false;
    const auto from = overlay_.ends_of_fibre(candidate, piece.polygon.front().node, goal_.precision);
    return std::any_of(piece.polygon.begin() + 1, piece.polygon.end(), [&](const auto& corner) {
      const auto to = overlay_.ends_of_fibre(candidate, corner.node, goal_.precision);
      return std::max((to[0] - from[0]).norm(), (to[1] - from[1]).norm()) > limit;
    });
  }

  /// A line that halves the piece across its longest extent; absent if the piece is too small for that.
  std::optional<Line> middle_line(const Polygon& polygon) {
    double longest = 0, at = 0;
    std::size_t corner = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      double low = 1, high = 0;
      for (const auto& c : polygon) {
        const double w = Overlay::rounded(c.node)[i];
        low = std::min(low, w), high = std::max(high, w);
      }
      if (high - low > longest) longest = high - low, corner = i, at = low + (high - low) / 2;
    }
    if (longest < 0x1p-36) return std::nullopt;
    return overlay_.add_level(corner, static_cast<std::int64_t>(std::ldexp(at, 40)));
  }

  Overlay& overlay_;
  const FindOthers& find_others_;
  bool needs_far_ = false;               ///< near candidates left a piece uncovered
  bool has_others_ = false;              ///< the overlay holds the others too
  std::uint32_t likely_;                 ///< candidates that it held from the start
  std::vector<std::uint32_t> unlikely_;  ///< the others that may cover some area of A
  const DeviationGoal& goal_;
  TriangleDeviation result_;
  std::vector<Piece> stack_, spare_;
  std::vector<Line> cuts_;
  Polygon covered_;
  std::vector<Polygon> uncovered_;
  std::optional<LineChart> chart_;        ///< once asked for; only where A is a segment in the texture
  std::vector<std::uint8_t> is_bounded_;  ///< by candidate: what it covers of A is known to lie in pieces with a bound
};

}  // namespace

TriangleDeviation deviation_by_pieces(Overlay& overlay, Covering& covering, const FindOthers& find_others,
                                      const DeviationGoal& goal) {
  return PieceSearch(overlay, find_others, goal).run(covering);
}

TriangleDeviation deviation_at_corners(Overlay& overlay, const FindOthers& find_others, const DeviationGoal& goal) {
  return PieceSearch(overlay, find_others, goal).at_corners();
}

}  // namespace meshbound
