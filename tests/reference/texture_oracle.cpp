// SPDX-License-Identifier: MIT
#include "reference/texture_oracle.h"

#include <algorithm>
#include <vector>

namespace meshbound::reference {
namespace {

using Point2 = std::array<mpq_class, 2>;
using Point3 = std::array<mpq_class, 3>;

template <std::size_t N>
std::array<mpq_class, N> minus(const std::array<mpq_class, N>& p, const std::array<mpq_class, N>& q) {
  std::array<mpq_class, N> r;
  for (std::size_t i = 0; i < N; ++i) r[i] = p[i] - q[i];
  return r;
}

template <std::size_t N>
std::array<mpq_class, N> blend(const std::array<mpq_class, N>& p, const std::array<mpq_class, N>& q,
                               const mpq_class& t) {
  std::array<mpq_class, N> r;
  for (std::size_t i = 0; i < N; ++i) r[i] = p[i] + t * (q[i] - p[i]);
  return r;
}

mpq_class dot(const Point3& p, const Point3& q) { return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]; }

mpq_class turn(const Point2& p, const Point2& q, const Point2& r) {
  return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
}

Point2 coordinate(const TexturedTriangle& t, std::size_t k) { return {t.coordinates[k].x(), t.coordinates[k].y()}; }

Point3 corner(const TexturedTriangle& t, std::size_t k) {
  return {t.corners[k].x(), t.corners[k].y(), t.corners[k].z()};
}

template <class Point, class At>
Point weighted(const TexturedTriangle& t, const RationalWeights& w, const At& at) {
  Point p;
  for (std::size_t k = 0; k < 3; ++k) {
    const Point c = at(t, k);
    for (std::size_t i = 0; i < p.size(); ++i) p[i] += w[k] * c[i];
  }
  return p;
}

mpq_class to_segment(const Point3& p, const Point3& q, const Point3& r) {
  const Point3 along = minus(r, q), way = minus(p, q);
  const mpq_class length = dot(along, along);
  mpq_class t = length == 0 ? mpq_class(0) : mpq_class(dot(along, way) / length);
  t = std::clamp<mpq_class>(t, 0, 1);
  const Point3 rest = minus(p, blend(q, r, t));
  return dot(rest, rest);
}

/// By the foot of p in the plane, where its weights are not negative, and by the edges.
mpq_class to_triangle(const Point3& p, const std::array<Point3, 3>& c) {
  mpq_class least = std::min({to_segment(p, c[0], c[1]), to_segment(p, c[1], c[2]), to_segment(p, c[2], c[0])});
  const Point3 ab = minus(c[1], c[0]), ac = minus(c[2], c[0]), ap = minus(p, c[0]);
  const mpq_class bb = dot(ab, ab), bc = dot(ab, ac), cc = dot(ac, ac), pb = dot(ap, ab), pc = dot(ap, ac);
  const mpq_class gram = bb * cc - bc * bc;
  if (gram == 0) return least;
  const mpq_class v = (pb * cc - pc * bc) / gram, w = (pc * bb - pb * bc) / gram;
  if (v < 0 || w < 0 || v + w > 1) return least;
  Point3 foot;
  for (std::size_t i = 0; i < 3; ++i) foot[i] = c[0][i] + v * ab[i] + w * ac[i];
  const Point3 rest = minus(p, foot);
  return std::min<mpq_class>(least, dot(rest, rest));
}

/// Points of the edges of b with the texture coordinate u; the ends of an edge where all of it has.
std::vector<Point3> on_edges(const TexturedTriangle& b, const Point2& u) {
  std::vector<Point3> found;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    const Point2 from = coordinate(b, k), to = coordinate(b, next);
    if (from == to) {
      if (from == u) found.push_back(corner(b, k)), found.push_back(corner(b, next));
      continue;
    }
    const std::size_t axis = from[0] != to[0] ? 0 : 1;
    const mpq_class t = (u[axis] - from[axis]) / (to[axis] - from[axis]);
    if (t < 0 || t > 1 || blend(from, to, t) != u) continue;
    found.push_back(blend(corner(b, k), corner(b, next), t));
  }
  return found;
}

/// Squared distance from x to the points of b with the texture coordinate u.
std::optional<mpq_class> to_fibre(const Point3& x, const TexturedTriangle& b, const Point2& u) {
  const std::array<Point2, 3> c = {coordinate(b, 0), coordinate(b, 1), coordinate(b, 2)};
  const mpq_class all = turn(c[0], c[1], c[2]);
  if (all != 0) {
    const RationalWeights w = {turn(c[1], c[2], u) / all, turn(c[2], c[0], u) / all, turn(c[0], c[1], u) / all};
    if (w[0] < 0 || w[1] < 0 || w[2] < 0) return std::nullopt;
    const Point3 rest = minus(x, weighted<Point3>(b, w, corner));
    return dot(rest, rest);
  }
  if (c[0] == u && c[1] == u && c[2] == u) return to_triangle(x, {corner(b, 0), corner(b, 1), corner(b, 2)});
  std::optional<mpq_class> least;
  const std::vector<Point3> points = on_edges(b, u);
  for (const Point3& p : points) {
    for (const Point3& q : points) {
      const mpq_class squared = to_segment(x, p, q);
      if (!least || squared < *least) least = squared;
    }
  }
  return least;
}

/// Corners of what b covers of a, as weights in a, in any order.
std::vector<RationalWeights> overlap(const TexturedTriangle& a, const TexturedTriangle& b) {
  std::vector<Point2> points;
  const auto inside = [](const TexturedTriangle& t, const Point2& u) {
    const mpq_class all = turn(coordinate(t, 0), coordinate(t, 1), coordinate(t, 2));
    for (std::size_t k = 0; k < 3; ++k)
      if (turn(coordinate(t, k), coordinate(t, (k + 1) % 3), u) * all < 0) return false;
    return true;
  };
  for (std::size_t k = 0; k < 3; ++k) {
    if (inside(b, coordinate(a, k))) points.push_back(coordinate(a, k));
    if (inside(a, coordinate(b, k))) points.push_back(coordinate(b, k));
  }
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const Point2 p = coordinate(a, i), q = coordinate(a, (i + 1) % 3);
      const Point2 r = coordinate(b, j), s = coordinate(b, (j + 1) % 3);
      const mpq_class at_p = turn(r, s, p), at_q = turn(r, s, q);
      if (at_p == at_q) continue;
      const mpq_class t = at_p / (at_p - at_q);
      if (t < 0 || t > 1) continue;
      const Point2 crossing = blend(p, q, t);
      if (inside(a, crossing) && inside(b, crossing)) points.push_back(crossing);
    }
  }
  std::vector<RationalWeights> result;
  const mpq_class all = turn(coordinate(a, 0), coordinate(a, 1), coordinate(a, 2));
  for (const Point2& u : points)
    result.push_back({turn(coordinate(a, 1), coordinate(a, 2), u) / all,
                      turn(coordinate(a, 2), coordinate(a, 0), u) / all,
                      turn(coordinate(a, 0), coordinate(a, 1), u) / all});
  return result;
}

/// Twice the area of the hull in the plane of two of the weights: the share of the triangle.
mpq_class hull_share(const std::vector<RationalWeights>& weights) {
  std::vector<Point2> points;
  for (const RationalWeights& w : weights) points.push_back({w[1], w[2]});
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return 0;
  std::vector<Point2> hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t base = hull.size();
    for (const Point2& p : points) {
      while (hull.size() >= base + 2 && turn(hull[hull.size() - 2], hull.back(), p) <= 0) hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  mpq_class share = 0;
  for (std::size_t i = 1; i + 1 < hull.size(); ++i) share += turn(hull[0], hull[i], hull[i + 1]);
  return share;
}

}  // namespace

std::optional<mpq_class> squared_deviation_at(const TexturedTriangle& a, const RationalWeights& weights,
                                              const TexturedMesh& mesh) {
  const Point3 x = weighted<Point3>(a, weights, corner);
  const Point2 u = weighted<Point2>(a, weights, coordinate);
  std::optional<mpq_class> least;
  for (const TexturedTriangle& b : mesh.triangles) {
    if (b.material != a.material) continue;
    const std::optional<mpq_class> squared = to_fibre(x, b, u);
    if (squared && (!least || *squared < *least)) least = squared;
  }
  return least;
}

bool has_area_in_texture(const TexturedTriangle& t) {
  return turn(coordinate(t, 0), coordinate(t, 1), coordinate(t, 2)) != 0;
}

mpq_class squared_deviation_of_charts(const TexturedMesh& a, const TexturedMesh& b, bool with_touches) {
  mpq_class largest = 0;
  for (const TexturedTriangle& t : a.triangles) {
    for (const TexturedTriangle& s : b.triangles) {
      if (!has_area_in_texture(t) || !has_area_in_texture(s) || t.material != s.material) continue;
      const std::vector<RationalWeights> corners = overlap(t, s);
      if (!with_touches && hull_share(corners) == 0) continue;
      for (const RationalWeights& w : corners)
        largest = std::max<mpq_class>(largest,
                                      *to_fibre(weighted<Point3>(t, w, corner), s, weighted<Point2>(t, w, coordinate)));
    }
  }
  return largest;
}

mpq_class uncovered_share(const TexturedTriangle& a, const TexturedMesh& mesh) {
  mpq_class covered = 0;
  for (const TexturedTriangle& b : mesh.triangles)
    if (has_area_in_texture(b) && b.material == a.material) covered += hull_share(overlap(a, b));
  return 1 - covered;
}

int compare_root(const mpq_class& squared, double length) {
  const mpq_class other(length);
  return cmp(squared, mpq_class(other * other));
}

}  // namespace meshbound::reference
