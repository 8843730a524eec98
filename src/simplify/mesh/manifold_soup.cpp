// SPDX-License-Identifier: MIT
#include "simplify/mesh/manifold_soup.h"

#include <algorithm>
#include <bit>
#include <span>
#include <string>
#include <tuple>
#include <utility>

#include "geometry/position_table.h"
#include "mesh/mesh_arrays.h"
#include "meshbound/error.h"
#include "numeric/buckets.h"
#include "numeric/no_index.h"
#include "simplify/mesh/crowded_edge.h"

namespace meshbound {
namespace {

constexpr std::size_t max_triangles = 0xffffffff / 3;

constexpr std::uint32_t next(std::uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }
constexpr std::uint32_t previous(std::uint32_t corner) { return corner % 3 == 0 ? corner + 2 : corner - 1; }

std::uint32_t& at(std::vector<Triangle>& table, std::uint32_t corner) {
  return reinterpret_cast<std::uint32_t*>(table.data())[corner];
}
std::uint32_t at(const std::vector<Triangle>& table, std::uint32_t corner) {
  return reinterpret_cast<const std::uint32_t*>(table.data())[corner];
}

class ManifoldBuilder {
 public:
  /// `neighbours`, `look` and `number` may be empty.
  ManifoldBuilder(const MeshView& soup, std::vector<std::uint32_t> first,
                  std::span<const TriangleNeighbours> neighbours, std::span<const std::uint32_t> look,
                  std::span<const std::uint32_t> number, const std::vector<bool>& at_rim)
      : soup_(soup),
        neighbours_(neighbours),
        look_(look),
        number_(number),
        is_shared_(first.size(), 0),
        first_(std::move(first)) {
    at_rim_.resize(at_rim.size(), false);
    for (std::uint32_t v = 0; v < at_rim.size(); ++v)
      if (at_rim[v]) at_rim_[first_[v]] = true;
    for (std::uint32_t v = 0; v < first_.size(); ++v) {
      if (first_[v] == v) continue;
      is_shared_[first_[v]] = 1;
      has_shared_ = true;
    }
  }

  ManifoldSoup build() && {
    take_distinct_triangles();
    join_edges();
    if (!is_oriented_) orient();
    split_vertices();
    close_slits();
    return std::move(result_);
  }

 private:
  /// A triangle, seen from the lowest of its corners.
  struct Seen {
    std::uint32_t middle, highest, triangle;
  };
  /// An edge of a face, seen from the lower of its ends.
  struct Side {
    std::uint32_t high, corner;
  };
  /// An edge of more than two faces: `crowds_[begin ... end)`. Those before `flat` come in the order of their angles
  /// around it, the others have none.
  struct Crowd {
    std::uint32_t begin, flat, end;
  };

  [[nodiscard]] Triangle welded(std::uint32_t triangle) const {
    const Triangle corners = soup_.triangle(triangle);
    return {first_[corners[0]], first_[corners[1]], first_[corners[2]]};
  }

  /// Whether another triangle may have the corners of this one: not where vertices have their positions for themselves
  /// and two different triangles lie across edges that have no third one.
  [[nodiscard]] bool may_be_repeated(std::uint32_t triangle) const {
    return neighbours_.empty() || has_shared(welded(triangle)) || !lies_between_two(neighbours_[triangle]);
  }
  [[nodiscard]] bool has_shared(const Triangle& corners) const {
    return has_shared_ && (is_shared_[corners[0]] | is_shared_[corners[1]] | is_shared_[corners[2]]) != 0;
  }

  void take_distinct_triangles();
  void join_neighbours();
  [[nodiscard]] std::uint32_t corner_across(std::uint32_t corner, std::uint32_t face) const;
  void join_edges();
  [[nodiscard]] Crowd add_crowd(std::span<const Side> faces);
  bool join_in_pairs(const Crowd& crowd, bool around_material);
  void cut_all(const Crowd& crowd);
  [[nodiscard]] bool meets_itself(const Crowd& crowd) const;
  void orient();
  void turn_over(const std::vector<std::uint8_t>& turned);
  void number_fans();
  void split_vertices();
  void close_slits();

  [[nodiscard]] bool runs_upward(std::uint32_t corner) const {
    return at(result_.faces, corner) < at(result_.faces, next(corner));
  }
  void join(std::uint32_t a, std::uint32_t b) {
    at(result_.twin, a) = b;
    at(result_.twin, b) = a;
  }
  [[nodiscard]] bool is_at_rim(std::uint32_t corner) const {
    return !at_rim_.empty() && at_rim_[at(result_.faces, corner)] && at_rim_[at(result_.faces, next(corner))];
  }
  /// Joins edges that may run in one direction, unless there may be more of them. Whether it did.
  bool join_unoriented(std::uint32_t a, std::uint32_t b) {
    const bool is_oriented = runs_upward(a) != runs_upward(b);
    if (!is_oriented && is_at_rim(a)) return false;
    join(a, b);
    is_oriented_ = is_oriented_ && is_oriented;
    return true;
  }
  void cut(std::uint32_t corner) {
    at(result_.twin, at(result_.twin, corner)) = no_index;
    at(result_.twin, corner) = no_index;
  }
  /// The corner at the same vertex across the edge that leaves `corner`, or across the one that enters it.
  [[nodiscard]] std::uint32_t across_leaving(std::uint32_t corner) const {
    const std::uint32_t twin = at(result_.twin, corner);
    return twin == no_index ? no_index : next(twin);
  }
  [[nodiscard]] std::uint32_t across_entering(std::uint32_t corner) const { return at(result_.twin, previous(corner)); }

  /// Marks repetitions among triangles with the same corners in `dropped`, and sets the sheets of the others.
  void sort_out(std::span<const Seen> same, std::vector<std::uint8_t>& dropped);
  /// Whether the lowest corner of a triangle is followed by the highest: of two triangles with the same corners, one
  /// is the back of the other where this differs.
  [[nodiscard]] bool shows_back(std::uint32_t triangle) const {
    const auto [a, b, c] = welded(triangle);
    return (a < b) + (b < c) + (c < a) == 1;
  }
  [[nodiscard]] std::uint32_t sheet_of(std::uint32_t corner) const {
    return sheet_.empty() ? 0 : sheet_[result_.triangle_of[corner / 3]];
  }

  MeshView soup_;
  std::span<const TriangleNeighbours> neighbours_;
  std::span<const std::uint32_t> look_;
  std::span<const std::uint32_t> number_;
  std::vector<std::uint32_t> sheet_;     ///< by triangle of the soup; empty: all are on the first one
  std::vector<std::uint8_t> is_shared_;  ///< by vertex of the soup: another one has it as its first
  bool has_shared_ = false;              ///< any is
  std::vector<bool> at_rim_;             ///< by first vertex at a position; empty: none is
  bool is_oriented_ = true;              ///< twins run in opposite directions, everywhere
  std::vector<std::uint32_t> first_;     ///< by vertex of the soup: the first one with its coordinates
  std::vector<Crowd> crowded_;           ///< edges of more than two faces that are joined in pairs
  std::vector<std::uint32_t> crowds_;    ///< the edges of their faces
  std::vector<Triangle> fan_;            ///< by face and corner: the vertex for its fan or ring
  ManifoldSoup result_;                  ///< until `split_vertices`, corners are vertices of the soup
};

void ManifoldBuilder::sort_out(std::span<const Seen> same, std::vector<std::uint8_t>& dropped) {
  if (same.size() == 1) return;
  std::vector<std::pair<std::uint32_t, bool>> looks;  // by sheet
  for (const Seen& seen : same) {
    const std::uint32_t t = seen.triangle;
    const auto look = look_.empty() ? std::pair(0U, false) : std::pair(look_[t], shows_back(t));
    if (std::find(looks.begin(), looks.end(), look) != looks.end()) {
      dropped[t] = 1;
      result_.repetitions.push_back({t, same.front().triangle});
      continue;
    }
    if (!looks.empty() && sheet_.empty()) sheet_.assign(soup_.triangle_count(), 0);
    if (!looks.empty()) sheet_[t] = static_cast<std::uint32_t>(looks.size());
    looks.push_back(look);
  }
}

/// Triangles with three different corners, the first one of each set of corners and look.
void ManifoldBuilder::take_distinct_triangles() {
  const auto triangles = static_cast<std::uint32_t>(soup_.triangle_count());
  std::vector<std::uint8_t> dropped(triangles, 0);
  std::vector<std::uint32_t> candidates;
  for (std::uint32_t t = 0; t < triangles; ++t) {
    const auto [a, b, c] = welded(t);
    if (a == b || b == c || c == a)
      dropped[t] = 1;
    else if (may_be_repeated(t))
      candidates.push_back(t);
  }
  const auto for_each_candidate = [&](const auto& add) {
    for (const std::uint32_t t : candidates) {
      auto [a, b, c] = welded(t);
      if (a > b) std::swap(a, b);
      if (b > c) std::swap(b, c);
      if (a > b) std::swap(a, b);
      add(a, Seen{b, c, t});
    }
  };
  Buckets<Seen> by_lowest_vertex(first_.size(), for_each_candidate);
  for (std::size_t v = 0; v < by_lowest_vertex.size(); ++v) {
    const std::span<Seen> here = by_lowest_vertex[v];
    const auto corners = [](const Seen& seen) { return std::tuple(seen.middle, seen.highest); };
    const auto number = [&](const Seen& seen) { return number_.empty() ? seen.triangle : number_[seen.triangle]; };
    std::sort(here.begin(), here.end(), [&](const Seen& a, const Seen& b) {
      return std::tuple(corners(a), number(a)) < std::tuple(corners(b), number(b));
    });
    for (std::size_t i = 0, end = 0; i < here.size(); i = end) {
      while (end < here.size() && corners(here[end]) == corners(here[i])) ++end;
      sort_out(here.subspan(i, end - i), dropped);
    }
  }
  result_.dropped_triangles = static_cast<std::size_t>(std::count(dropped.begin(), dropped.end(), 1));
  result_.triangle_of.reserve(triangles - result_.dropped_triangles);
  result_.faces.reserve(triangles - result_.dropped_triangles);
  for (std::uint32_t t = 0; t < triangles; ++t) {
    if (dropped[t] != 0) continue;
    result_.triangle_of.push_back(t);
    result_.faces.push_back(welded(t));
  }
}

/// The corner of the face whose edge has the ends of that at `corner`.
std::uint32_t ManifoldBuilder::corner_across(std::uint32_t corner, std::uint32_t face) const {
  const std::uint32_t from = at(result_.faces, corner), to = at(result_.faces, next(corner));
  const auto [a, b, c] = result_.faces[face];
  const auto has_ends = [&](std::uint32_t p, std::uint32_t q) {  // without branches, which cannot be foretold
    return static_cast<unsigned>(((p == from) & (q == to)) | ((p == to) & (q == from)));
  };
  const unsigned found = has_ends(a, b) | has_ends(b, c) << 1 | has_ends(c, a) << 2;
  return found == 0 ? no_index : 3 * face + static_cast<std::uint32_t>(std::countr_zero(found));
}

/// Twins across edges of exactly two triangles of the soup, which are those whose vertices have their positions for
/// themselves where a tree has found neighbours.
void ManifoldBuilder::join_neighbours() {
  if (neighbours_.empty()) return;
  std::vector<std::uint32_t> numbers;  // of the faces, by triangle; empty: their own
  if (result_.dropped_triangles > 0) {
    numbers.assign(soup_.triangle_count(), no_index);
    for (std::uint32_t f = 0; f < result_.faces.size(); ++f) numbers[result_.triangle_of[f]] = f;
  }
  for (std::uint32_t f = 0; f < result_.faces.size(); ++f) {
    const std::uint32_t t = result_.triangle_of[f];
    const bool has_shared = this->has_shared(result_.faces[f]);
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t across = neighbours_[t][k];
      if (across == no_index || across < t) continue;
      if (has_shared && (is_shared_[result_.faces[f][k]] | is_shared_[result_.faces[f][next(k)]]) != 0) continue;
      const std::uint32_t face = numbers.empty() ? across : numbers[across];
      const std::uint32_t twin = face == no_index ? no_index : corner_across(3 * f + k, face);
      if (twin != no_index && sheet_of(twin) == sheet_of(3 * f + k)) join_unoriented(3 * f + k, twin);
    }
  }
}

/// The faces of a crowded edge in the order of their angles around it.
ManifoldBuilder::Crowd ManifoldBuilder::add_crowd(std::span<const Side> faces) {
  const auto opposite = [&](const Side& side) { return soup_.vertex(at(result_.faces, previous(side.corner))); };
  const std::uint32_t from = at(result_.faces, faces[0].corner), to = at(result_.faces, next(faces[0].corner));
  const AngleAroundEdge angle(soup_.vertex(std::min(from, to)), soup_.vertex(std::max(from, to)), opposite(faces[0]));
  std::vector<std::pair<double, std::uint32_t>> by_angle;
  Crowd crowd{static_cast<std::uint32_t>(crowds_.size()), 0, 0};
  std::vector<std::uint32_t> flat;
  for (const Side& side : faces) {
    if (const auto found = angle.of(opposite(side)))
      by_angle.emplace_back(*found, side.corner);
    else
      flat.push_back(side.corner);
  }
  std::sort(by_angle.begin(), by_angle.end());
  for (const auto& [at_angle, corner] : by_angle) crowds_.push_back(corner);
  crowd.flat = static_cast<std::uint32_t>(crowds_.size());
  crowds_.insert(crowds_.end(), flat.begin(), flat.end());
  crowd.end = static_cast<std::uint32_t>(crowds_.size());
  return crowd;
}

/// False, and none are joined, where they cannot be paired.
bool ManifoldBuilder::join_in_pairs(const Crowd& crowd, bool around_material) {
  const std::span<const std::uint32_t> corners = std::span(crowds_).subspan(crowd.begin, crowd.flat - crowd.begin);
  if (corners.size() == 2) return join_unoriented(corners[0], corners[1]);
  std::vector<std::uint8_t> upward;
  for (const std::uint32_t corner : corners) upward.push_back(runs_upward(corner) ? 1 : 0);
  const auto pairs = pairs_around_edge(upward, around_material);
  for (const auto& [i, j] : pairs) join(corners[i], corners[j]);
  return !pairs.empty();
}

void ManifoldBuilder::cut_all(const Crowd& crowd) {
  for (std::uint32_t i = crowd.begin; i < crowd.end; ++i)
    if (at(result_.twin, crowds_[i]) != no_index) cut(crowds_[i]);
}

/// Whether two edges of it that are no twins have the same ends, by `fan_`. O(n log n).
bool ManifoldBuilder::meets_itself(const Crowd& crowd) const {
  std::vector<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>> edges;  // lower end, higher end, corner
  for (std::uint32_t i = crowd.begin; i < crowd.end; ++i) {
    const auto [low, high] = std::minmax({at(fan_, crowds_[i]), at(fan_, next(crowds_[i]))});
    edges.emplace_back(low, high, crowds_[i]);
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    const auto& [low, high, corner] = edges[i];
    const auto& [next_low, next_high, next_corner] = edges[i + 1];
    if (low == next_low && high == next_high && at(result_.twin, corner) != next_corner) return true;
  }
  return false;
}

/// Twins across edges of exactly two faces, and of more where these can be paired.
void ManifoldBuilder::join_edges() {
  const auto corners = static_cast<std::uint32_t>(3 * result_.faces.size());
  result_.twin.assign(result_.faces.size(), {no_index, no_index, no_index});
  join_neighbours();
  std::vector<std::uint32_t> open;
  for (std::uint32_t c = 0; c < corners; ++c)
    if (at(result_.twin, c) == no_index) open.push_back(c);
  const auto for_each_side = [&](const auto& add) {
    for (const std::uint32_t c : open) {
      const std::uint32_t from = at(result_.faces, c), to = at(result_.faces, next(c));
      add(std::min(from, to), Side{std::max(from, to), c});
    }
  };
  Buckets<Side> by_lower_vertex(first_.size(), for_each_side);
  for (std::size_t v = 0; v < by_lower_vertex.size(); ++v) {
    const std::span<Side> here = by_lower_vertex[v];
    const auto edge = [&](const Side& side) { return std::tuple(side.high, sheet_of(side.corner)); };
    std::sort(here.begin(), here.end(), [&](const Side& a, const Side& b) {
      return std::tuple(edge(a), a.corner) < std::tuple(edge(b), b.corner);
    });
    for (std::size_t i = 0, end = 0; i < here.size(); i = end) {
      while (end < here.size() && edge(here[end]) == edge(here[i])) ++end;
      if (end - i == 2) join_unoriented(here[i].corner, here[i + 1].corner);
      if (end - i <= 2) continue;
      const Crowd crowd = add_crowd(here.subspan(i, end - i));
      if (join_in_pairs(crowd, true))
        crowded_.push_back(crowd);
      else
        crowds_.resize(crowd.begin);
    }
  }
}

/// A flood fill over each component, breadth first.
void ManifoldBuilder::orient() {
  constexpr std::uint8_t unseen = 2;
  std::vector<std::uint8_t> turned(result_.faces.size(), unseen);
  std::vector<std::uint32_t> component;
  for (std::uint32_t first = 0; first < result_.faces.size(); ++first) {
    if (turned[first] != unseen) continue;
    component.assign(1, first);
    turned[first] = 0;
    std::size_t turned_faces = 0;
    for (std::size_t i = 0; i < component.size(); ++i) {
      const std::uint32_t f = component[i];
      for (std::uint32_t c = 3 * f; c < 3 * f + 3; ++c) {
        const std::uint32_t twin = at(result_.twin, c);
        if (twin == no_index) continue;
        const bool agree = runs_upward(c) != runs_upward(twin);
        const auto wanted = static_cast<std::uint8_t>(turned[f] ^ (agree ? 0 : 1));
        std::uint8_t& neighbour = turned[twin / 3];
        if (neighbour == unseen) {
          neighbour = wanted;
          turned_faces += wanted;
          component.push_back(twin / 3);
        } else if (neighbour != wanted) {
          cut(c);
        }
      }
    }
    if (2 * turned_faces <= component.size()) continue;
    for (const std::uint32_t f : component) turned[f] ^= 1;
  }
  turn_over(turned);
}

void ManifoldBuilder::turn_over(const std::vector<std::uint8_t>& turned) {
  for (std::uint32_t f = 0; f < result_.faces.size(); ++f) {
    for (std::uint32_t& twin : result_.twin[f])
      if (twin != no_index && turned[twin / 3] != 0) twin += 2 - 2 * (twin % 3);
    if (turned[f] == 0) continue;
    std::swap(result_.faces[f][1], result_.faces[f][2]);
    std::swap(result_.twin[f][0], result_.twin[f][2]);
    result_.split = true;
  }
  for (std::uint32_t& corner : crowds_)
    if (turned[corner / 3] != 0) corner += 2 - 2 * (corner % 3);
}

/// A vertex for each fan or ring of faces.
void ManifoldBuilder::number_fans() {
  const auto corners = static_cast<std::uint32_t>(3 * result_.faces.size());
  fan_.assign(result_.faces.size(), {no_index, no_index, no_index});
  result_.vertex_of.clear();
  std::vector<bool> has_vertex(first_.size(), false);
  for (std::uint32_t first = 0; first < corners; ++first) {
    if (at(fan_, first) != no_index) continue;
    const auto number = static_cast<std::uint32_t>(result_.vertex_of.size());
    const std::uint32_t of = at(result_.faces, first);
    result_.vertex_of.push_back(of);
    if (has_vertex[of]) result_.split = true;
    has_vertex[of] = true;
    std::uint32_t c = first;
    do {
      at(fan_, c) = number;
      c = across_leaving(c);
    } while (c != no_index && c != first);
    if (c == first) continue;
    for (c = across_entering(first); c != no_index; c = across_entering(c)) at(fan_, c) = number;
  }
}

/// Where the faces of a crowded edge hang together around both of its ends, its pairs would have one edge between them.
/// They are joined the other way round then, which takes them apart at one end at least in most cases; else they are
/// cut, which only parts fans, so that one round of cuts suffices.
void ManifoldBuilder::split_vertices() {
  number_fans();
  for (const bool may_join : {true, false}) {
    bool has_changed = false;
    for (const Crowd& crowd : crowded_) {
      if (!meets_itself(crowd)) continue;
      has_changed = true;
      cut_all(crowd);
      if (may_join && is_oriented_) join_in_pairs(crowd, false);
    }
    if (has_changed) number_fans();
  }
  result_.faces = std::move(fan_);
}

/// Joins the two ends of a fan where they are one edge that `join_edges` left cut: two of the faces at an edge of more
/// than two, which hang together around both of its vertices. A fan has one leaving and one entering edge at its ends,
/// so this never finds two pairs.
void ManifoldBuilder::close_slits() {
  const auto corners = static_cast<std::uint32_t>(3 * result_.faces.size());
  for (std::uint32_t first = 0; first < corners; ++first) {
    if (at(result_.twin, first) != no_index) continue;
    std::uint32_t last = first;
    for (std::uint32_t c = first; c != no_index; c = across_entering(c)) last = c;
    const std::uint32_t entering = previous(last);
    if (at(result_.faces, entering) == at(result_.faces, next(first))) join(first, entering);
  }
}

}  // namespace

ManifoldSoup manifold_soup(const MeshView& soup, std::span<const std::uint32_t> look) {
  return manifold_soup(soup, first_at_position(positions_of(soup)), {}, look);
}

ManifoldSoup manifold_soup(const MeshView& soup, std::vector<std::uint32_t> first_at_position,
                           std::span<const TriangleNeighbours> neighbours, std::span<const std::uint32_t> look,
                           std::span<const std::uint32_t> number, const std::vector<bool>& at_rim) {
  if (soup.triangle_count() > max_triangles)
    throw InvalidInput("the mesh has " + std::to_string(soup.triangle_count()) +
                       " triangles; decimation takes 2^32 / 3 of them at most, simplify it in pieces");
  return ManifoldBuilder(soup, std::move(first_at_position), neighbours, look, number, at_rim).build();
}

}  // namespace meshbound
