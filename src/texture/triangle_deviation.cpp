// SPDX-License-Identifier: MIT
#include "texture/triangle_deviation.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "texture/covering.h"

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
    }
    if (has_outside && !has_inside) return Cover::None;
    if (has_outside && cover == Cover::All) cover = Cover::Part, cut = line;
  }
  return cover;
}

/// Moves the candidates of `part` that cover all of the piece to `full` and drops those that cover nothing. Returns a
/// line to cut the piece by, of a candidate that `is_preferred` if possible; absent if no candidate covers it in part.
template <class IsPreferred>
std::optional<Line> sort_candidates(Overlay& overlay, Piece& piece, const IsPreferred& is_preferred) {
  std::vector<std::uint32_t> part;
  std::vector<Line> preferred, others;
  for (const std::uint32_t c : piece.part) {
    Line cut = 0;
    const Cover cover = cover_of(overlay, piece.polygon, c, cut);
    if (cover == Cover::All) piece.full.push_back(c);
    if (cover != Cover::Part) continue;
    part.push_back(c);
    (is_preferred(c) ? preferred : others).push_back(cut);
  }
  piece.part = std::move(part);
  const std::vector<Line>& cuts = preferred.empty() ? others : preferred;
  if (cuts.empty()) return std::nullopt;
  return cuts[cuts.size() / 2];  // a middle one halves pieces: candidates are in spatial order
}

/// The candidates that can cover more of A than a line or a point.
std::vector<std::uint32_t> spanning_candidates(const Overlay& overlay) {
  std::vector<std::uint32_t> found;
  const Chart chart = overlay.triangle().chart;
  for (std::uint32_t c = 0; c < overlay.candidates(); ++c)
    if (chart != Chart::Area || overlay.candidate(c).chart == Chart::Area) found.push_back(c);
  return found;
}

/// Sets the lower bound to the distance from the point to the nearest candidate that covers it, if that is larger or no
/// distance is known yet.
void include(Overlay& overlay, const Node& node, double precision, TriangleDeviation& result) {
  double nearest = HUGE_VAL;
  std::uint32_t candidate = 0;
  for (std::uint32_t c = 0; c < overlay.candidates(); ++c) {
    if (!overlay.covers(c, node)) continue;
    const double lower = overlay.distance(c, node, precision).lower;
    if (lower < nearest) nearest = lower, candidate = c;
    if (result.far && nearest <= result.bounds.lower) return;
  }
  if (nearest == HUGE_VAL) return;
  result.bounds.lower = nearest;
  result.far = FarPoint{node, candidate};
}

/// What a candidate covers of A.
Polygon covered_by(Overlay& overlay, std::uint32_t candidate) {
  Polygon covered = overlay.whole();
  overlay.clip(covered, candidate);
  return covered;
}

/// The largest distance to the candidate over a polygon that it covers; -1 where that is empty.
double upper_at_corners(Overlay& overlay, const Polygon& covered, std::uint32_t candidate, double precision) {
  double upper = -1;
  for (const auto& corner : covered) upper = std::max(upper, overlay.distance(candidate, corner.node, precision).upper);
  return upper;
}

class PieceSearch {
 public:
  PieceSearch(Overlay& overlay, const DeviationByCandidates& known, const DeviationGoal& goal)
      : overlay_(overlay), uppers_(known.uppers), goal_(goal), result_(known.all) {}

  /// Starts with the whole triangle. What no candidate covers drops out, and every point of a candidate that covers
  /// more of A than a line or a point lies in a piece or on its border. The other candidates matter only if something
  /// dropped out: then each candidate is searched by itself, starting from what it covers.
  TriangleDeviation run() {
    result_.bounds.upper = 0;
    std::vector<std::uint32_t> spanning = spanning_candidates(overlay_);
    std::erase_if(spanning, [&](std::uint32_t c) { return uppers_[c] < 0; });
    search(Piece{overlay_.whole(), {}, std::move(spanning)});
    for (std::uint32_t c = 0; c < overlay_.candidates() && has_uncovered_; ++c) {
      if (uppers_[c] < 0) continue;
      Piece piece{overlay_.whole(), {c}, {}};
      overlay_.clip(piece.polygon, c);
      for (std::uint32_t other = 0; other < overlay_.candidates(); ++other)
        if (other != c && uppers_[other] >= 0) piece.part.push_back(other);
      search(std::move(piece));
    }
    return result_;
  }

 private:
  void search(Piece piece) {
    stack_.push_back(std::move(piece));
    while (!stack_.empty()) {
      Piece top = std::move(stack_.back());
      stack_.pop_back();
      bound(std::move(top));
    }
  }

  [[nodiscard]] double limit() const { return std::max(goal_.lower, result_.bounds.lower) + goal_.error_bound; }

  void accept(double upper) { result_.bounds.upper = std::max(result_.bounds.upper, upper); }

  /// The candidate's largest upper bound at a corner of the piece, and that corner in `where`: an upper bound for the
  /// whole piece, as the distance to one candidate is convex.
  double upper_of(const Piece& piece, std::uint32_t candidate, const Node*& where) {
    double upper = 0;
    for (const auto& corner : piece.polygon) {
      const double at = overlay_.distance(candidate, corner.node, goal_.precision).upper;
      if (at >= upper) upper = at, where = &corner.node;
    }
    return upper;
  }

  double min_upper(const Piece& piece, const Node*& where) {
    double min = HUGE_VAL;
    for (const std::uint32_t c : piece.full) {
      const Node* at = nullptr;
      const double upper = upper_of(piece, c, at);
      if (upper < min) min = upper, where = at;
    }
    return min;
  }

  void bound(Piece piece) {
    ++result_.pieces;
    const Node* where = nullptr;
    if (const double upper = min_upper(piece, where); upper <= limit()) return accept(upper);
    const auto is_near = [&](std::uint32_t c) { return uppers_[c] <= limit(); };  // what it covers needs no other one
    const std::optional<Line> cut = sort_candidates(overlay_, piece, is_near);
    if (piece.full.empty()) {
      if (cut) return split(piece, *cut);
      has_uncovered_ = true;
      return;
    }
    const double upper = min_upper(piece, where);
    if (upper <= limit()) return accept(upper);
    if (result_.pieces >= goal_.max_pieces) {
      result_.gave_up = true;
      return accept(upper);
    }
    if (cut) return split(piece, *cut);
    probe(piece, *where);
    if (upper <= limit() || piece.full.size() == 1) return accept(upper);
    if (const auto middle = middle_line(piece.polygon)) return split(piece, *middle);
    accept(upper);
  }

  void split(const Piece& piece, Line line) {
    for (const bool flip : {false, true}) {
      Piece half{{}, piece.full, piece.part};
      overlay_.clip(piece.polygon, line, flip, half.polygon);
      if (!half.polygon.empty()) stack_.push_back(std::move(half));
    }
  }

  /// Raises the lower bound at the worst corner of the piece, at a point inside next to it, where only candidates of
  /// the piece count, and at the middle of the piece.
  void probe(const Piece& piece, const Node& worst) {
    constexpr double next_to = 0x1p-26;
    std::array<double, 3> middle{};
    for (const auto& corner : piece.polygon) {
      const std::array<double, 3> w = Overlay::rounded(corner.node);
      for (std::size_t i = 0; i < 3; ++i) middle[i] += w[i] / static_cast<double>(piece.polygon.size());
    }
    const std::array<double, 3> corner = Overlay::rounded(worst);
    std::array<double, 3> near = corner;
    for (std::size_t i = 0; i < 3; ++i) near[i] += next_to * (middle[i] - corner[i]);
    raise(worst);
    raise(Overlay::given(near));
    if (piece.full.size() > 1) raise(Overlay::given(middle));
  }

  void raise(const Node& node) { include(overlay_, node, goal_.precision, result_); }

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
  const std::vector<double>& uppers_;  ///< -1 for a candidate that covers nothing
  const DeviationGoal& goal_;
  TriangleDeviation result_;
  std::vector<Piece> stack_;
  bool has_uncovered_ = false;
};

/// An upper bound for all of A: the largest of the candidates' upper bounds that are at most `limit`, provided that
/// these candidates together cover A. Absent if that cannot be decided.
std::optional<double> upper_of_near_candidates(Overlay& overlay, const std::vector<double>& uppers, double limit) {
  if (overlay.triangle().chart != Chart::Area) return std::nullopt;
  double upper = 0;
  std::vector<std::uint32_t> near = spanning_candidates(overlay);
  std::erase_if(near, [&](std::uint32_t c) { return uppers[c] < 0 || uppers[c] > limit; });
  for (const std::uint32_t c : near) upper = std::max(upper, uppers[c]);
  if (!Covering().is_complete(overlay, near)) return std::nullopt;
  return upper;
}

/// The share of A that no candidate covers. Pieces are cut by lines of candidates, a middle one first, so that a cut
/// halves the remaining candidates on average.
class Uncovered {
 public:
  explicit Uncovered(Overlay& overlay) : overlay_(overlay) {}

  Approximate of(Piece piece) {
    const std::optional<Line> cut = sort_candidates(overlay_, piece, [](std::uint32_t) { return true; });
    if (!piece.full.empty()) return {};
    if (!cut) return overlay_.share(piece.polygon);
    Approximate total;
    for (const bool flip : {false, true}) {
      Piece half{{}, {}, piece.part};
      overlay_.clip(piece.polygon, *cut, flip, half.polygon);
      total = total + of(std::move(half));
    }
    return total;
  }

 private:
  Overlay& overlay_;
};

}  // namespace

std::optional<double> upper_of_complete_cover(Overlay& overlay, double precision) {
  if (overlay.triangle().chart != Chart::Area) return std::nullopt;
  if (!Covering().is_complete(overlay, spanning_candidates(overlay))) return std::nullopt;
  double upper = 0;
  for (std::uint32_t c = 0; c < overlay.candidates(); ++c)
    upper = std::max(upper, upper_at_corners(overlay, covered_by(overlay, c), c, precision));
  return upper;
}

DeviationByCandidates deviation_by_candidates(Overlay& overlay, double precision) {
  DeviationByCandidates found;
  std::optional<Node> covered_point;
  for (std::uint32_t c = 0; c < overlay.candidates(); ++c) {
    const Polygon covered = covered_by(overlay, c);
    found.uppers.push_back(upper_at_corners(overlay, covered, c, precision));
    found.all.bounds.upper = std::max(found.all.bounds.upper, found.uppers.back());
    if (!covered.empty()) covered_point = covered.front().node;
  }
  for (const auto& corner : overlay.whole()) include(overlay, corner.node, precision, found.all);
  if (!found.all.far && covered_point) include(overlay, *covered_point, precision, found.all);
  return found;
}

TriangleDeviation deviation_by_pieces(Overlay& overlay, const DeviationByCandidates& known, const DeviationGoal& goal) {
  const double limit = std::max(goal.lower, known.all.bounds.lower) + goal.error_bound;
  const auto upper = upper_of_near_candidates(overlay, known.uppers, limit);
  if (!upper) return PieceSearch(overlay, known, goal).run();
  TriangleDeviation result = known.all;
  result.bounds.upper = std::max(*upper, result.bounds.lower);
  result.pieces = 1;
  return result;
}

Approximate uncovered_share(Overlay& overlay) {
  std::vector<std::uint32_t> candidates = spanning_candidates(overlay);
  if (overlay.triangle().chart == Chart::Area && Covering().is_complete(overlay, candidates)) return {};
  return Uncovered(overlay).of({overlay.whole(), {}, std::move(candidates)});
}

}  // namespace meshbound
