// SPDX-License-Identifier: MIT
#include "verify/parity_check.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <type_traits>

namespace meshbound::verify {
namespace {

constexpr double drawn_in_share = 0x1p-10;  ///< of the tolerance
constexpr std::size_t largest_patch = 65536;

/// Twice the signed area of a, b, c as seen.
template <class Number, class Point>
Number turn(const Point& a, const Point& b, const Point& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// A point between the corners 0, n / 2 and n - 1.
template <class Number, class CornerAt>
Vec<Number> middle_of(std::size_t n, const CornerAt& corner_at) {
  return Number(0.5) * corner_at(0) + Number(0.25) * (corner_at(n / 2) + corner_at(n - 1));
}

/// For each vertex the first one with the same position.
std::vector<std::uint32_t> representatives(const TriangleMesh& mesh) {
  std::vector<std::uint32_t> order, first(mesh.vertices.size());
  for (const Triangle& t : mesh.triangles) order.insert(order.end(), t.begin(), t.end());
  const auto key = [&](std::uint32_t v) {
    const Eigen::Vector3d& p = mesh.vertices[v];
    return std::tuple(p.x(), p.y(), p.z());
  };
  std::sort(order.begin(), order.end());
  order.erase(std::unique(order.begin(), order.end()), order.end());
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  for (std::size_t i = 0; i < order.size(); ++i)
    first[order[i]] = i > 0 && key(order[i]) == key(order[i - 1]) ? first[order[i - 1]] : order[i];
  return first;
}

/// A power of two that takes the triangle to about size 1, so that products neither overflow nor underflow.
double scale_of(const Corners& triangle) {
  const double size =
      std::max((triangle[1] - triangle[0]).cwiseAbs().maxCoeff(), (triangle[2] - triangle[0]).cwiseAbs().maxCoeff());
  return size > 0 && std::isfinite(size) ? std::ldexp(1.0, std::clamp(-std::ilogb(size), -960, 960)) : 1;
}

}  // namespace

ParityCheck::ParityCheck(const TriangleMesh& mesh, double tolerance, Work& work)
    : mesh_(mesh), tolerance_(tolerance), work_(work), visited_(mesh.triangles.size(), 0) {
  find_edges();
}

/// Triangles of which two corners coincide are left out: they have no area, and are never needed for P.
void ParityCheck::find_edges() {
  struct Side {
    std::uint32_t low, high, triangle, corner;
    bool operator<(const Side& other) const { return std::tie(low, high) < std::tie(other.low, other.high); }
  };
  const std::vector<std::uint32_t> first = representatives(mesh_);
  edges_of_.assign(mesh_.triangles.size(), {no_edge, no_edge, no_edge});
  std::vector<Side> sides;
  for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
    const Triangle& c = mesh_.triangles[t];
    if (first[c[0]] == first[c[1]] || first[c[1]] == first[c[2]] || first[c[2]] == first[c[0]]) continue;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(first[c[k]], first[c[(k + 1) % 3]]);
      sides.push_back({low, high, t, k});
    }
  }
  std::sort(sides.begin(), sides.end());
  for (const Side& side : sides) {
    if (edges_.empty() || edges_.back().low != side.low || edges_.back().high != side.high)
      edges_.push_back({side.low, side.high, static_cast<std::uint32_t>(users_.size()), 0});
    users_.push_back(side.triangle);
    edges_.back().end = static_cast<std::uint32_t>(users_.size());
    edges_of_[side.triangle][side.corner] = static_cast<std::uint32_t>(edges_.size() - 1);
  }
}

template <class Number>
ParityCheck::Seen<Number> ParityCheck::see(const View<Number>& view, std::uint32_t vertex) const {
  const Vec<Number> p = Number(scale_) * (to_vec<Number>(mesh_.vertices[vertex]) - view.origin);
  return {dot(view.x_axis, p), dot(view.y_axis, p), dot(view.z_axis, p)};
}

/// Seen along two sides of the triangle, which span its plane. The triangle is counter-clockwise there, the Gram
/// determinant of the sides being positive, and so are its pieces. Corners are ways from the first one of the triangle.
template <class Number, class CornerAt>
ParityCheck::View<Number> ParityCheck::make_view(const CornerAt& corner_at) const {
  View<Number> view;
  view.origin = to_vec<Number>((*triangle_)[0]);
  view.x_axis = Number(scale_) * (to_vec<Number>((*triangle_)[1]) - view.origin);
  view.y_axis = Number(scale_) * (to_vec<Number>((*triangle_)[2]) - view.origin);
  view.z_axis = cross(view.x_axis, view.y_axis);
  const Number limit = Number(scale_) * Number(tolerance_) * Number(1 - drawn_in_share);
  view.squared_limit = limit * limit * dot(view.z_axis, view.z_axis);
  const std::size_t n = piece_->size();
  const Vec<Number> middle = middle_of<Number>(n, corner_at);
  for (std::size_t i = 0; i < n; ++i) {
    const Vec<Number> p = Number(scale_) * (corner_at(i) + Number(drawn_in_) * (middle - corner_at(i)));
    view.window.push_back({dot(view.x_axis, p), dot(view.y_axis, p), Number(0)});
  }
  return view;
}

/// No corner of the piece moves by more than the share of the tolerance, and so no point of it.
template <class Number, class CornerAt>
bool ParityCheck::drawn_in_enough(const CornerAt& corner_at) const {
  const std::size_t n = piece_->size();
  const Vec<Number> middle = middle_of<Number>(n, corner_at);
  const Number allowed = Number(scale_) * Number(tolerance_) * Number(drawn_in_share);
  for (std::size_t i = 0; i < n; ++i) {
    const Vec<Number> moved = Number(scale_ * drawn_in_) * (middle - corner_at(i));
    const Number room = allowed * allowed - dot(moved, moved);
    if (!surely_not_negative(room)) return false;
  }
  return true;
}

/// The numbers of a decision are products and quotients of those of all corners of the piece, and each side of the
/// window takes such.
void ParityCheck::count_exact(std::uint64_t bits) {
  if (piece_bits_ == 0) {
    for (const std::uint32_t corner : *piece_) piece_bits_ += bits_of(corners_->exact(corner));
    for (const Eigen::Vector3d& corner : *triangle_) piece_bits_ += bits_of(corner);
  }
  work_.add_exact(piece_->size() * (piece_bits_ + bits));
}

const ParityCheck::View<Exact>& ParityCheck::exact_view() {
  if (!exact_) {
    count_exact(0);
    exact_ = make_view<Exact>([&](std::size_t i) { return corners_->exact((*piece_)[i]) - corners_->exact(0); });
  }
  return *exact_;
}

const ParityCheck::View<Exact>& ParityCheck::exact_view(const Edge& edge) {
  count_exact(bits_of(mesh_.vertices[edge.low]) + bits_of(mesh_.vertices[edge.high]));
  return exact_view();
}

const ParityCheck::View<Exact>& ParityCheck::exact_view(std::uint32_t triangle) {
  std::uint64_t bits = 0;
  for (const std::uint32_t vertex : mesh_.triangles[triangle]) bits += bits_of(mesh_.vertices[vertex]);
  count_exact(bits);
  return exact_view();
}

/// Chooses the share by doubles, then proves it.
bool ParityCheck::draw_in(const PieceCorners& corners, const Piece& piece) {
  const auto rough = [&](std::size_t i) -> const Vec<Interval>& { return corners.way(piece[i]); };
  const Vec<Interval> middle = middle_of<Interval>(piece.size(), rough);
  double reach = 0;
  for (std::size_t i = 0; i < piece.size(); ++i) {
    const Vec<Interval> way = middle - rough(i);
    reach = std::max({reach, std::hypot(way.x.middle(), way.y.middle(), way.z.middle())});
  }
  const double wanted = 0.999 * drawn_in_share * tolerance_ / reach;
  if (!(wanted > 0x1p-60)) return false;  // with the smallest scale still a normal double: nothing is rounded
  drawn_in_ = std::min(0.5, std::ldexp(1.0, std::ilogb(wanted)));
  if (drawn_in_enough<Interval>(rough)) return true;
  count_exact(0);
  return drawn_in_enough<Exact>([&](std::size_t i) -> const Vec<Exact>& { return corners_->exact((*piece_)[i]); });
}

/// What the triangle has above and below the window, by clipping.
template <class Number>
bool ParityCheck::heights_hold(const View<Number>& view, std::uint32_t triangle) const {
  std::vector<Seen<Number>> polygon;
  for (const std::uint32_t vertex : mesh_.triangles[triangle]) polygon.push_back(see(view, vertex));
  const auto is_low = [&](const Seen<Number>& p) {
    const Number room = view.squared_limit - p.h * p.h;
    return surely_not_negative(room);
  };
  if (std::all_of(polygon.begin(), polygon.end(), is_low)) return true;
  const std::size_t sides = view.window.size();
  for (std::size_t side = 0; side < sides && !polygon.empty(); ++side) {
    const Seen<Number>&a = view.window[side], &b = view.window[(side + 1) % sides];
    std::vector<Number> inside;
    for (const Seen<Number>& p : polygon) inside.push_back(turn<Number>(a, b, p));
    std::vector<Seen<Number>> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const std::size_t j = (i + 1) % polygon.size();
      const bool i_out = surely_negative(inside[i]), j_out = surely_negative(inside[j]);
      if (!i_out) kept.push_back(polygon[i]);
      if (i_out == j_out) continue;
      if (!surely_positive(inside[i]) && !surely_positive(inside[j])) {
        if constexpr (std::is_same_v<Number, Exact>) continue;  // it touches the side in a corner, which is kept
        return false;
      }
      const Seen<Number>&p = polygon[i], &q = polygon[j];
      const Number share = inside[i] / (inside[i] - inside[j]);
      kept.push_back({p.x + share * (q.x - p.x), p.y + share * (q.y - p.y), p.h + share * (q.h - p.h)});
    }
    polygon = std::move(kept);
  }
  return std::all_of(polygon.begin(), polygon.end(), is_low);
}

/// A line along a side of the window or along the edge separates the two, if anything does: these are the directions
/// of the sides of their difference.
template <class Number>
bool ParityCheck::is_clear(const View<Number>& view, const Edge& edge) const {
  const Seen<Number> p = see(view, edge.low), q = see(view, edge.high);
  const std::size_t sides = view.window.size();
  for (std::size_t side = 0; side < sides; ++side) {
    const Seen<Number>&a = view.window[side], &b = view.window[(side + 1) % sides];
    if (surely_negative(turn<Number>(a, b, p)) && surely_negative(turn<Number>(a, b, q))) return true;
  }
  bool all_left = true, all_right = true;
  for (const Seen<Number>& corner : view.window) {
    const Number side = turn<Number>(p, q, corner);
    all_left = all_left && surely_positive(side);
    all_right = all_right && surely_negative(side);
  }
  return all_left || all_right;
}

/// Whether the ray from the first corner of the window in the direction of x crosses the edge. A half-open rule, so
/// that a vertex at the height of the ray counts for one of two edges. Of an edge that an even number of triangles have
/// any answer is right, as long as it is the same for all of them.
template <class Number>
std::optional<bool> ParityCheck::crosses_ray(const View<Number>& view, const Edge& edge) const {
  const Seen<Number>& from = view.window[0];
  Seen<Number> low = see(view, edge.low), high = see(view, edge.high);
  const Number low_side = low.y - from.y, high_side = high.y - from.y;
  const bool low_above = surely_positive(low_side), high_above = surely_positive(high_side);
  const bool told = std::is_same_v<Number, Exact> ||
                    ((low_above || surely_negative(low_side)) && (high_above || surely_negative(high_side)));
  if (!told) return std::nullopt;
  if (low_above == high_above) return false;
  if (low_above) std::swap(low, high);
  const Number side = turn<Number>(low, high, from);
  if (surely_positive(side)) return true;
  if (surely_negative(side) || std::is_same_v<Number, Exact>) return false;
  return std::nullopt;
}

bool ParityCheck::grow(std::uint32_t seed) {
  if (++round_ == 0) {
    std::fill(visited_.begin(), visited_.end(), 0);
    round_ = 1;
  }
  patch_.assign(1, seed);
  visited_[seed] = round_;
  bool odd = false;
  for (std::size_t i = 0; i < patch_.size(); ++i) {
    const std::uint32_t triangle = patch_[i];
    work_.add_seen_triangle(piece_->size());
    if (work_.is_too_much()) return false;
    if (edges_of_[triangle][0] == no_edge) return false;
    if (!heights_hold(rough_, triangle) && !heights_hold(exact_view(triangle), triangle)) return false;
    for (const std::uint32_t index : edges_of_[triangle]) {
      const Edge& edge = edges_[index];
      std::optional<bool> crosses = crosses_ray(rough_, edge);
      if (!crosses) crosses = crosses_ray(exact_view(edge), edge);
      odd = odd != *crosses;
      if (is_clear(rough_, edge)) continue;
      const std::uint32_t users = edge.end - edge.begin;
      if (users % 2 != 0 && !is_clear(exact_view(edge), edge)) return false;
      if (users % 2 != 0) continue;
      work_.add_known_triangles(users - 2);  // as few as two are part of the work for their triangles
      for (std::uint32_t k = edge.begin; k < edge.end; ++k) {
        if (visited_[users_[k]] == round_) continue;
        if (patch_.size() == largest_patch) return false;
        visited_[users_[k]] = round_;
        patch_.push_back(users_[k]);
      }
    }
  }
  return odd;
}

bool ParityCheck::proves(const Corners& triangle, PieceCorners& corners, const Piece& piece, std::uint32_t seed) {
  triangle_ = &triangle;
  corners_ = &corners;
  piece_ = &piece;
  exact_.reset();
  piece_bits_ = 0;
  scale_ = scale_of(triangle);
  if (piece.size() < 3 || !draw_in(corners, piece)) return false;
  rough_ = make_view<Interval>([&](std::size_t i) -> const Vec<Interval>& { return corners.way(piece[i]); });
  // A triangle without area has no normal to look along.
  if (!surely_positive(rough_.squared_limit) && !surely_positive(exact_view().squared_limit)) return false;
  return grow(seed);
}

}  // namespace meshbound::verify
