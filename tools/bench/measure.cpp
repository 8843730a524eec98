// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure.h"

#include <CGAL/version.h>
#include <stdlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <thread>

#include "processor_time.h"

namespace meshbound::bench {
namespace {

double process_cpu_seconds() { return processor_seconds(CLOCK_PROCESS_CPUTIME_ID); }

std::string processor_name() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  }
  return "unknown processor";
}

std::string today() {
  const std::time_t now = std::time(nullptr);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%d", std::gmtime(&now));
  return text.data();
}

}  // namespace

Stopwatch::Stopwatch() : wall_(std::chrono::steady_clock::now()), cpu_(process_cpu_seconds()) {}

Times Stopwatch::elapsed() const {
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - wall_;
  return {wall.count(), process_cpu_seconds() - cpu_};
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double geometric_mean(const std::vector<double>& values) {
  if (values.empty()) return 0;
  double sum = 0;
  for (const double value : values) sum += std::log(value);
  return std::exp(sum / static_cast<double>(values.size()));
}

double fitted_exponent(const std::vector<double>& x, const std::vector<double>& y) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double u = std::log(x[i]), v = std::log(y[i]);
    sx += u, sy += v, sxx += u * u, sxy += u * v;
  }
  const auto n = static_cast<double>(x.size());
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

void interleave(const std::vector<Contestant>& contestants, std::size_t rounds, double seconds) {
  std::vector<double> used(contestants.size(), 0);
  for (std::size_t round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < contestants.size(); ++i) {
      if (used[i] >= seconds) continue;
      const double took = contestants[i]();
      used[i] = took < 0 ? seconds : used[i] + took;
    }
  }
}

std::string machine_line() {
  std::array<double, 1> load{};
  const bool known = getloadavg(load.data(), 1) == 1;
  std::array<char, 400> line{};
  std::snprintf(line.data(), line.size(), "%s, %u threads, GCC %s, CGAL %s, %s, load average %.1f",
                processor_name().c_str(), std::thread::hardware_concurrency(), __VERSION__, CGAL_VERSION_STR,
                today().c_str(), known ? load[0] : 0.0);
  return line.data();
}

}  // namespace meshbound::bench
