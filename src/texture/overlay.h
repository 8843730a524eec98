// SPDX-License-Identifier: MIT
#pragma once
#include <gmpxx.h>

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "meshbound/bounds.h"
#include "meshbound/texture_deviation.h"
#include "texture/approximate.h"
#include "texture/exact_length.h"

namespace meshbound {

/// What a triangle covers in the texture.
enum class Chart : std::uint8_t { Area, Segment, Point };

/// A triangle with what is known of its texture coordinates from the start.
struct ChartTriangle {
  const TexturedTriangle* source = nullptr;
  Chart chart = Chart::Area;
  bool turned = false;                            ///< the coordinates go round clockwise
  std::array<std::uint8_t, 3> along = {0, 1, 2};  ///< a segment: its first, middle and last corner in the texture
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

  struct Node {
    static constexpr Line is_corner = ~Line{0}, is_given = ~Line{0} - 1;
    Line first = 0;                       ///< a line through the point; or the number of a corner
    Line second = is_corner;              ///< another one
    Weights weights;                      ///< times one positive number
    std::array<double, 3> given{};        ///< `weights` of a point that is given by them
    const Eigen::Vector2d* at = nullptr;  ///< its texture coordinate, where a corner of a triangle has it; else null
  };
  struct PolygonCorner {
    Node node;
    Line to_next = 0;  ///< the line that the edge to the next corner lies on
  };
  /// Convex, its corners in their order; may be a segment or a point.
  using Polygon = std::vector<PolygonCorner>;

  explicit Overlay(const ExactUnits& units) : units_(units) {}

  /// Begins anew with this triangle.
  void begin(const ChartTriangle& a);
  /// Adds a candidate, unless all of A is known to lie beyond one of its lines. Its number is that of the candidates
  /// before it. All triangles must outlive their use.
  void add(const ChartTriangle& b);
  [[nodiscard]] const ChartTriangle& triangle() const { return *a_; }
  [[nodiscard]] std::uint32_t candidates() const { return static_cast<std::uint32_t>(candidates_.size()); }
  [[nodiscard]] const ChartTriangle& candidate(std::uint32_t c) const { return *candidates_[c].triangle; }

  /// The whole triangle A.
  [[nodiscard]] Polygon whole() const;
  [[nodiscard]] std::span<const Line> lines_of(std::uint32_t candidate) const;
  /// The line where the weight of `corner` is `numerator` / 2^40.
  [[nodiscard]] Line add_level(std::size_t corner, std::int64_t numerator);
  /// The point with weights in this proportion: none negative, one positive.
  [[nodiscard]] static Node given(const std::array<double, 3>& weights);

  /// The side of the line that the point lies on: 1 inside, 0 on it, -1.
  [[nodiscard]] int side(Line line, const Node& node);
  /// What is inside the line, or on it; with `flip` outside of it or on it.
  void clip(const Polygon& polygon, Line line, bool flip, Polygon& result);
  /// What the candidate covers of the polygon.
  void clip(Polygon& polygon, std::uint32_t candidate);
  [[nodiscard]] bool covers(std::uint32_t candidate, const Node& node);

  /// From the point to the nearest point of the candidate, which must cover it, with the same texture coordinate. The
  /// interval is made as narrow as doubles allow where it would be wider than `precision`.
  [[nodiscard]] Bounds distance(std::uint32_t candidate, const Node& node, double precision);
  /// The point and that nearest point, rounded.
  [[nodiscard]] TextureWitness witness(std::uint32_t candidate, const Node& node);
  /// The share of the triangle that is the polygon.
  [[nodiscard]] Approximate share(const Polygon& polygon);
  /// Rounded weights of sum 1.
  [[nodiscard]] static std::array<double, 3> rounded(const Node& node);

 private:
  using ExactWeights = std::array<mpz_class, 3>;
  struct LineData {
    std::array<Approximate, 3> at;  ///< the corners of A
    std::uint32_t candidate = 0;    ///< that it belongs to
    std::uint32_t number = 0;       ///< among the lines of the candidate
    /// Texture coordinates that it joins where it is the edge of a triangle with an area in the texture; else null.
    std::array<const Eigen::Vector2d*, 2> ends{};
    std::unique_ptr<ExactWeights> exact;  ///< `at`, once it was asked for
  };
  struct Candidate {
    const ChartTriangle* triangle;
    std::array<Line, 4> lines;
    std::uint8_t line_count;
  };

  /// Whether the point is made of the line itself, of the same edge of another triangle, or of one of its ends: the
  /// commonest cases of points on lines, where doubles cannot tell.
  [[nodiscard]] bool lies_on(const Node& node, const LineData& line) const;
  [[nodiscard]] const ExactWeights& exact(Line line);
  [[nodiscard]] ExactWeights exact(const Node& node);
  [[nodiscard]] Node crossing(Line line, Line other);
  [[nodiscard]] Bounds near_distance(const Candidate& candidate, const Node& node) const;
  [[nodiscard]] Bounds exact_distance(const Candidate& candidate, const Node& node);
  struct Fibre;
  [[nodiscard]] Fibre fibre(const Candidate& candidate, const Node& node);

  ExactUnits units_;
  const ChartTriangle* a_ = nullptr;
  std::vector<LineData> lines_;
  std::vector<Candidate> candidates_;
  Polygon clipped_;
  std::vector<int> sides_;
};

/// What is known of the texture coordinates of a triangle, exactly.
[[nodiscard]] ChartTriangle chart_triangle(const TexturedTriangle& triangle, const ExactUnits& units);

}  // namespace meshbound
