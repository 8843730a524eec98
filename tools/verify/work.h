// SPDX-License-Identifier: MIT
/// What checking a proof costs, and how much of it is accepted: a few forged bytes must not cost hours.
#pragma once
#include <gmpxx.h>

#include <cstdint>

#include "verify/numbers.h"

namespace meshbound::verify {

/// The size of a rational: the bits of its numerator and of its denominator.
inline std::uint64_t bits_of(const Exact& x) {
  return mpz_sizeinbase(x.get_num_mpz_t(), 2) + mpz_sizeinbase(x.get_den_mpz_t(), 2);
}
/// The bits that doubles have as rationals.
inline std::uint64_t bits_of(const Eigen::Ref<const Eigen::VectorXd>& numbers) {
  std::uint64_t bits = 0;
  for (const double x : numbers) bits += bits_of(Exact(x));
  return bits;
}
inline std::uint64_t bits_of(const Vec<Exact>& p) { return bits_of(p.x) + bits_of(p.y) + bits_of(p.z); }

/// Counts what checking a proof costs. The unit is a clip of a polygon by a line that intervals decide, about 0.1 us.
class Work {
 public:
  /// What is accepted grows with the `size` of the proof in bytes plus the number of triangles of both meshes.
  Work(std::uint64_t limit_per_unit, std::uint64_t size) : limit_(min_limit + limit_per_unit * size) {}

  void add_clip() { ++done_; }
  /// Counts a triangle that a parity proof looks at through a window of so many `sides`, decided by intervals.
  void add_seen_triangle(std::uint64_t sides) { done_ += seen_side * sides; }
  /// Counts triangles that are only asked whether they were seen already.
  void add_known_triangles(std::uint64_t count) { done_ += count; }
  /// Counts a decision by rationals that together have `bits`.
  void add_exact(std::uint64_t bits) { done_ += 1 + bits / bits_per_unit; }
  [[nodiscard]] bool is_too_much() const { return done_ > limit_; }
  [[nodiscard]] std::uint64_t done() const { return done_; }

 private:
  static constexpr std::uint64_t min_limit = 65536;  ///< small proofs may cost some milliseconds, whatever their size
  /// Decisions about points in a texture take about 0.05 us for 64 bits: 10 us with 12,200 bits of operands.
  static constexpr std::uint64_t bits_per_unit = 64;
  static constexpr std::uint64_t seen_side = 4;  ///< a triangle and its edges take about 2 us with four sides
  std::uint64_t done_ = 0, limit_;
};

}  // namespace meshbound::verify
