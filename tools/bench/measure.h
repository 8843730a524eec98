// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <chrono>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace meshbound::bench {

/// Seconds. `cpu` is of the whole process, all of its threads: what a shared machine disturbs least.
struct Times {
  double wall = 0;
  double cpu = 0;
};

/// Runs from its construction.
class Stopwatch {
 public:
  Stopwatch();
  [[nodiscard]] Times elapsed() const;

 private:
  std::chrono::steady_clock::time_point wall_;
  double cpu_;
};

/// The median of a sequence that is not empty; the lower of the two middle ones when their number is even.
[[nodiscard]] double median(std::vector<double> values);

/// The geometric mean of positive values; 0 when there are none.
[[nodiscard]] double geometric_mean(const std::vector<double>& values);

/// Slope of the least-squares line through (log x, log y): the exponent of a power law. At least two points.
[[nodiscard]] double fitted_exponent(const std::vector<double>& x, const std::vector<double>& y);

/// What one program has to run, several times: returns the seconds it took, or a negative number to end its turns.
using Contestant = std::function<double()>;

/// Gives every contestant its turn, round after round, so that a disturbance of the machine meets all of them: each
/// once at least, then until it has had `rounds` turns or used `seconds` of its own.
void interleave(const std::vector<Contestant>& contestants, std::size_t rounds, double seconds);

/// Processor, threads, compiler, CGAL version, date and load of the machine, in one line.
[[nodiscard]] std::string machine_line();

}  // namespace meshbound::bench
