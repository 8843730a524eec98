// SPDX-License-Identifier: MIT
#pragma once
#include <gmpxx.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "meshbound/bounds.h"
#include "meshbound/texture_deviation.h"
#include "texture/approximate.h"
#include "texture/exact_length.h"

namespace meshbound {

/// What a triangle covers in the texture.
enum class Chart : std::uint8_t { Area, Segment, Point };

/// A triangle with an area in the texture, continued as a plane: the position at each texture coordinate, in doubles.
class LiftedPlane {
 public:
  LiftedPlane() = default;
  explicit LiftedPlane(const TexturedTriangle& triangle);

  /// Whether the corners of a triangle are known to be within `limit` of the points of this plane with their texture
  /// coordinates. The offset is linear in the texture coordinate, so its length over the triangle is largest at one of
  /// them. O(1).
  [[nodiscard]] bool is_within(const TexturedTriangle& triangle, double limit) const;
  friend Approximate distance_at(const LiftedPlane& p, const LiftedPlane& q, const Eigen::Vector2d& at);
  /// An upper bound of the lengths of both derivatives of the position together.
  [[nodiscard]] double max_derivative() const;

 private:
  [[nodiscard]] Eigen::Vector3d way(const Eigen::Vector2d& step) const {
    return step.x() * way_[0] + step.y() * way_[1];
  }
  [[nodiscard]] double error(const Eigen::Vector2d& step) const { return 6 * (step.cwiseAbs().sum() * error_); }

  Eigen::Vector2d from_ = Eigen::Vector2d::Zero();  ///< texture coordinate of a corner
  Eigen::Vector3d at_ = Eigen::Vector3d::Zero();    ///< its position
  /// Derivatives of the position by u and v.
  std::array<Eigen::Vector3d, 2> way_ = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  double error_ = HUGE_VAL;  ///< of any coordinate of a derivative; infinite: nothing is known
};

/// The distance between the points of two planes with a texture coordinate; 2^-300 stands for all that is less.
[[nodiscard]] Approximate distance_at(const LiftedPlane& p, const LiftedPlane& q, const Eigen::Vector2d& at);

/// A triangle with what is known of its texture coordinates from the start.
struct ChartTriangle {
  const TexturedTriangle* source = nullptr;
  Chart chart = Chart::Area;
  bool turned = false;                            ///< the coordinates go round clockwise
  std::array<std::uint8_t, 3> along = {0, 1, 2};  ///< of a segment: its first, middle and last corner in the texture
  LiftedPlane plane;                              ///< set where it has an area
  std::uint32_t number = 0;                       ///< in its mesh
  /// By edge, each opposite to a corner: a triangle on the other side of it in the texture, which has this one across
  /// the same edge; null where none is known.
  std::array<const ChartTriangle*, 3> across{};
};

/// Units, as exponents of 2, that all texture coordinates and all positions are multiples of.
struct ExactUnits {
  int texture = 0, position = 0;
};

/// A triangle A of one mesh, cut by the texture coordinates of triangles of another mesh, its *candidates*.
///
/// The domain is A itself, in barycentric coordinates: its points p have weights of sum 1. A *line* is a linear
/// function of the weights; its positive side is inside. The points of A whose texture coordinate candidate c covers
/// are those inside all lines of c, three or four: the area of two vectors between texture coordinates is linear in p.
/// So nothing here divides by the area of a triangle in the texture, and A may have none.
///
/// Each point is a corner of A, a point with given weights, or where two lines cross, so it stands for an exact point
/// however long ago it was made. Signs are decided by doubles with an error bound, and where these do not tell, by
/// integers.
///
/// Not thread-safe: each thread has its own.
class Overlay {
 public:
  using Line = std::uint32_t;  ///< 0, 1, 2: the edges of A opposite to the corners 0, 1, 2
  using Weights = std::array<Approximate, 3>;
  using NearPoint = std::array<Approximate, 3>;  ///< in space

  struct Node {
    static constexpr Line is_corner = ~Line{0}, is_given = ~Line{0} - 1, is_exact = ~Line{0} - 2;
    Line first = 0;                       ///< a line through the point; or the number of a corner, or of exact weights
    Line second = is_corner;              ///< another one
    Weights weights;                      ///< times one positive number
    const Eigen::Vector2d* at = nullptr;  ///< its texture coordinate if it is a corner of a triangle, else null
  };
  struct PolygonCorner {
    Node node;
    Line to_next = 0;  ///< the line that the edge to the next corner lies on
  };
  /// Convex, its corners in their order; may be a segment or a point.
  using Polygon = std::vector<PolygonCorner>;

  explicit Overlay(const ExactUnits& units) : units_(units) {}

  /// Starts an overlay of this triangle, without candidates.
  void begin(const ChartTriangle& a);
  /// Adds a candidate with the next number, counted from 0, unless all of A is known to lie beyond one of its lines.
  /// Triangles must outlive their use here.
  void add(const ChartTriangle& b);
  [[nodiscard]] const ChartTriangle& triangle() const { return *a_; }
  [[nodiscard]] std::uint32_t candidates() const { return static_cast<std::uint32_t>(candidates_.size()); }
  [[nodiscard]] const ChartTriangle& candidate(std::uint32_t c) const { return *candidates_[c].triangle; }
  /// The number of a candidate; absent if the triangle is none, or if another one has the same number in its mesh.
  /// O(1).
  [[nodiscard]] std::optional<std::uint32_t> number_of(const ChartTriangle& b) const;
  /// The candidates that can cover more of A than a line or a point, in ascending order; valid until one is added.
  [[nodiscard]] std::span<const std::uint32_t> spanning() const { return spanning_; }

  /// The whole triangle A.
  [[nodiscard]] const Polygon& whole() const { return whole_; }
  [[nodiscard]] std::span<const Line> lines_of(std::uint32_t candidate) const;
  /// Where a corner of a candidate with an area in the texture lies, which may be outside A.
  [[nodiscard]] Node corner_of(std::uint32_t candidate, std::size_t corner);
  /// The line on which the weight of `corner` is `numerator` / 2^40.
  [[nodiscard]] Line add_level(std::size_t corner, std::int64_t numerator);
  /// The line where a linear function with these values at the corners of A is 0. They are rounded to 2^-40 of the
  /// largest, which must not be 0.
  [[nodiscard]] Line add_cut(const std::array<double, 3>& at);
  /// A line of points with one texture coordinate that parts the corners of a polygon by theirs; absent if all have the
  /// same one. A must be a segment in the texture.
  [[nodiscard]] std::optional<Line> add_middle_coordinate(const Polygon& polygon);
  /// The point with weights in the given proportion: none negative, at least one positive.
  [[nodiscard]] static Node given(const std::array<double, 3>& weights);
  /// A point inside of the polygon, however thin, about 2^-`closer` of the way from one of its corners to the middle;
  /// valid until another overlay begins. It is made of integers: `given` is faster where rounding does no harm.
  [[nodiscard]] Node inside(const Polygon& polygon, const Node& corner, int closer);

  /// The side of the line that the point lies on: 1 inside, 0 on the line, -1 outside.
  [[nodiscard]] int side(Line line, const Node& node);
  /// The side of the line of an edge that the polygon lies on: 1 or -1; 0 where it has no area.
  [[nodiscard]] int inner_side(Line line, const Polygon& polygon);
  /// Whether the point lies inside of the polygon, not on its border. False where the polygon has no area.
  [[nodiscard]] bool is_inside(const Polygon& polygon, const Node& node);
  /// Whether all of the polygon lies on one side of the line, or on it.
  [[nodiscard]] bool is_on_one_side(Line line, const Polygon& polygon);
  /// Sets `result` to what of the polygon lies inside the line or on it; with `flip`, outside or on it.
  void clip(const Polygon& polygon, Line line, bool flip, Polygon& result);
  /// Sets `result`, another polygon, to what the candidate covers of this one.
  void clip(const Polygon& polygon, std::uint32_t candidate, Polygon& result);
  [[nodiscard]] bool covers(std::uint32_t candidate, const Node& node);

  /// Bounds of the distance from the point to the nearest point of the candidate with the same texture coordinate; the
  /// candidate must cover the point. An interval wider than `precision` is computed again exactly, to neighbouring
  /// doubles.
  [[nodiscard]] Bounds distance(std::uint32_t candidate, const Node& node, double precision);
  /// Bounds of that distance by doubles alone: they enclose it, however far apart they are.
  [[nodiscard]] Bounds rough_distance(std::uint32_t candidate, const Node& node);
  /// `distance`, where `rough` is what `rough_distance` says of the point.
  [[nodiscard]] Bounds refined(const Bounds& rough, std::uint32_t candidate, const Node& node, double precision);
  /// The ends of the segment of all points of the candidate with the texture coordinate of the point, off by at most
  /// `precision` or what doubles round. Both are one point where the candidate has an area in the texture; it must have
  /// more than one coordinate.
  [[nodiscard]] std::array<Eigen::Vector3d, 2> ends_of_fibre(std::uint32_t candidate, const Node& node,
                                                             double precision);
  /// The point and that nearest point, rounded to doubles.
  [[nodiscard]] TextureWitness witness(std::uint32_t candidate, const Node& node);
  /// The point in space.
  [[nodiscard]] NearPoint near_position(const Node& node) const;
  /// The area of the polygon as a share of that of A.
  [[nodiscard]] Approximate share(const Polygon& polygon);
  /// Rounded weights of sum 1.
  [[nodiscard]] static std::array<double, 3> rounded(const Node& node);

 private:
  using ExactWeights = std::array<mpz_class, 3>;
  struct LineData {
    std::array<Approximate, 3> at;  ///< its values at the corners of A
    std::uint32_t candidate = 0;    ///< the candidate it belongs to
    std::uint32_t number = 0;       ///< its number among the lines of the candidate
    /// The texture coordinates at its ends if it is an edge of a triangle with an area in the texture; else null.
    std::array<const Eigen::Vector2d*, 2> ends{};
    const ExactWeights* exact = nullptr;  ///< `at` in integers, once asked for
  };
  /// By axis and corner of A: the vector from the candidate, continued as a plane, to A at equal texture coordinates.
  using Offsets = std::array<std::array<Approximate, 3>, 3>;
  struct Candidate {
    const ChartTriangle* triangle = nullptr;
    std::array<Line, 4> lines{};
    std::uint8_t line_count = 0;
    std::optional<Offsets> offsets;  ///< once asked for
  };

  /// Whether the point lies on the line by construction: it was made of the line, of an equal edge of another triangle,
  /// or of an end of the line. These are the commonest cases of points on lines, which doubles cannot decide.
  [[nodiscard]] bool lies_on(const Node& node, const LineData& line) const;
  [[nodiscard]] const ExactWeights& exact(Line line);
  [[nodiscard]] ExactWeights exact(const Node& node);
  Line add_line(const Weights& at, ExactWeights exact);
  [[nodiscard]] Node crossing(Line line, Line other);
  void set_sides(const Polygon& polygon, Line line);
  void cut_by_sides(const Polygon& polygon, Line line, Polygon& result);
  [[nodiscard]] Offsets offsets_at_corners(const Candidate& candidate) const;
  [[nodiscard]] Bounds near_distance(Candidate& candidate, const Node& node);
  [[nodiscard]] std::array<NearPoint, 2> near_fibre(const Candidate& candidate, const Node& node) const;
  [[nodiscard]] Bounds exact_distance(const Candidate& candidate, const Node& node);
  struct Fibre;
  [[nodiscard]] Fibre fibre(const Candidate& candidate, const Node& node);

  ExactUnits units_;
  const ChartTriangle* a_ = nullptr;
  std::vector<LineData> lines_;
  std::deque<ExactWeights> exact_;  ///< of lines and points
  std::vector<Candidate> candidates_;
  std::vector<std::uint32_t> spanning_;
  std::vector<std::uint32_t> candidate_of_;  ///< by number of a triangle: valid where the candidate is that triangle
  Polygon whole_, clipped_;
  std::vector<int> sides_;  ///< by corner of a polygon
};

/// Bounds of the distance between two points.
[[nodiscard]] Bounds distance_bounds(const Eigen::Vector3d& x, const Eigen::Vector3d& y);

/// The chart of a triangle and the order of its corners in the texture, decided exactly.
[[nodiscard]] ChartTriangle chart_triangle(const TexturedTriangle& triangle, const ExactUnits& units);

}  // namespace meshbound
