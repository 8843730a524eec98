// SPDX-License-Identifier: MIT
/// Point-triangle distances in exact integer arithmetic: the oracle for the engine's rounding, with which it shares no
/// code. Triangles may be degenerate (a segment or a point).
#pragma once
#include <gmpxx.h>

#include <Eigen/Core>
#include <array>

#include "meshbound/mesh_view.h"

namespace meshbound::reference {

/// A length, known by its square: numerator / denominator * 4^exponent, exactly.
class ExactLength {
 public:
  ExactLength(mpz_class squared_numerator, mpz_class squared_denominator, long exponent);

  /// Sign of (this - length), exactly. `length` must be finite and not negative.
  [[nodiscard]] int compare(double length) const;
  [[nodiscard]] bool operator<(const ExactLength& other) const;

  /// The nearest double, up to a few units in the last place.
  [[nodiscard]] double approximate() const;

 private:
  mpz_class numerator_;
  mpz_class denominator_;
  long exponent_;
};

using Corners = std::array<Eigen::Vector3d, 3>;

[[nodiscard]] Corners corners(const MeshView& mesh, std::size_t triangle);
[[nodiscard]] ExactLength exact_distance(const Eigen::Vector3d& point, const Corners& triangle);

/// To the nearest of all triangles: O(n).
[[nodiscard]] ExactLength exact_distance(const Eigen::Vector3d& point, const MeshView& mesh);

}  // namespace meshbound::reference
