// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "meshbound/triangle_mesh.h"
#include "verify/numbers.h"
#include "verify/pieces.h"
#include "verify/work.h"

namespace meshbound::verify {

/// Parity proofs. Let Q be a piece, drawn in a little towards its middle, and P a set of
/// triangles of the other mesh, both seen along the normal of the source triangle. If
///
///   1. what P has straight above or below Q is at most `limit` away from the plane of Q, and
///   2. no edge that an odd number of triangles of P have is seen across Q, and
///   3. a corner of Q is encircled by these edges an odd number of times,
///
/// then each point of Q has a point of P straight above or below it: crossing an edge changes the number of triangles
/// of P above a point by the number that have this edge, so by 2 it changes the count modulo 2 nowhere on Q, and by 3
/// that count is odd. Nothing is assumed of the mesh: it may fold or cross itself, and have any borders.
///
/// Drawing in costs tolerance / 1024, so `limit` is 1023 / 1024 of the tolerance. P grows from a seed over the edges
/// that are not clear of Q; any P is as good, as all three conditions are checked for what has grown.
class ParityCheck {
 public:
  /// `mesh` and `work`, which counts what is done here, must outlive this. What costs too much is no proof.
  ParityCheck(const TriangleMesh& mesh, double tolerance, Work& work);

  /// Whether P, grown from `seed`, proves that the piece of `triangle` is within the tolerance.
  [[nodiscard]] bool proves(const Corners& triangle, PieceCorners& corners, const Piece& piece, std::uint32_t seed);

 private:
  static constexpr std::uint32_t no_edge = 0xffffffff;
  struct Edge {
    std::uint32_t low = 0, high = 0;   ///< vertices, by their representatives
    std::uint32_t begin = 0, end = 0;  ///< triangles that have it: `users_[begin ... end)`
  };
  /// A point in the view: x and y along the sides of the source triangle, h along its normal, scaled by their lengths.
  template <class Number>
  struct Seen {
    Number x, y, h;
  };
  template <class Number>
  struct View {
    Vec<Number> origin, x_axis, y_axis, z_axis;
    Number squared_limit;              ///< of h
    std::vector<Seen<Number>> window;  ///< Q, counter-clockwise; h is 0
  };

  void find_edges();
  /// Counts a decision by rationals about the piece and something else of so many `bits`.
  void count_exact(std::uint64_t bits);
  /// For decisions that intervals cannot make: about an edge, a triangle, or the window alone.
  [[nodiscard]] const View<Exact>& exact_view(const Edge& edge);
  [[nodiscard]] const View<Exact>& exact_view(std::uint32_t triangle);
  [[nodiscard]] const View<Exact>& exact_view();
  template <class Number, class CornerAt>
  [[nodiscard]] View<Number> make_view(const CornerAt& corner_at) const;
  template <class Number, class CornerAt>
  [[nodiscard]] bool drawn_in_enough(const CornerAt& corner_at) const;
  template <class Number>
  [[nodiscard]] Seen<Number> see(const View<Number>& view, std::uint32_t vertex) const;
  template <class Number>
  [[nodiscard]] bool heights_hold(const View<Number>& view, std::uint32_t triangle) const;
  template <class Number>
  [[nodiscard]] bool is_clear(const View<Number>& view, const Edge& edge) const;
  template <class Number>
  [[nodiscard]] std::optional<bool> crosses_ray(const View<Number>& view, const Edge& edge) const;
  [[nodiscard]] bool draw_in(const PieceCorners& corners, const Piece& piece);
  [[nodiscard]] bool grow(std::uint32_t seed);

  const TriangleMesh& mesh_;
  double tolerance_;
  Work& work_;
  std::vector<std::array<std::uint32_t, 3>> edges_of_;  ///< by triangle; `no_edge` where two of its corners coincide
  std::vector<Edge> edges_;
  std::vector<std::uint32_t> users_;

  // The proof at work.
  const Corners* triangle_ = nullptr;
  PieceCorners* corners_ = nullptr;
  const Piece* piece_ = nullptr;
  double scale_ = 1;     ///< of the view, a power of two: its coordinates are of size 1
  double drawn_in_ = 0;  ///< share of the way to the middle, a power of two
  View<Interval> rough_;
  std::optional<View<Exact>> exact_;
  std::uint64_t piece_bits_ = 0;  ///< of its corners and those of the source triangle; 0: not asked for yet
  std::vector<std::uint32_t> patch_, visited_;
  std::uint32_t round_ = 0;
};

}  // namespace meshbound::verify
