// SPDX-License-Identifier: MIT
#include "simplify/local_deviation.h"

#include <algorithm>
#include <cmath>

namespace meshbound {
namespace {

/// Enough to see the shape of a neighbourhood; more only cost time.
constexpr std::size_t most_samples = 192;

}  // namespace

void LocalDeviation::set_faces(std::span<const std::array<Vec3, 3>> faces) {
  faces_.resize((faces.size() + 3) / 4);
  const auto put = [](Vec<Double4>& four, std::size_t lane, Vec3 one) {
    four.x[lane] = one.x;
    four.y[lane] = one.y;
    four.z[lane] = one.z;
  };
  for (std::size_t i = 0; i < 4 * faces_.size(); ++i) {
    const auto& c = faces[std::min(i, faces.size() - 1)];
    put(faces_[i / 4].a, i % 4, c[0]);
    put(faces_[i / 4].ab, i % 4, c[1] - c[0]);
    put(faces_[i / 4].ac, i % 4, c[2] - c[0]);
  }
}

double LocalDeviation::squared_distance(Vec3 p) const {
  const Vec<Double4> four{broadcast4(p.x), broadcast4(p.y), broadcast4(p.z)};
  Double4 best = broadcast4(HUGE_VAL);
  for (const CornerTriangle<Double4>& faces : faces_)
    best = minimum(best, closest_on_triangle(faces, four).squared_distance);
  return std::min(std::min(best[0], best[1]), std::min(best[2], best[3]));
}

void LocalDeviation::begin(double tolerance, std::span<const std::uint32_t> originals,
                           std::span<const std::array<Vec3, 3>> faces) {
  squared_tolerance_ = tolerance * tolerance;
  samples_.clear();
  set_faces(faces);
  if (faces_.empty()) return;
  ++round_;
  for (const std::uint32_t t : originals) {
    for (const std::uint32_t v : triangles_[t]) {
      if (seen_[v] == round_) continue;
      seen_[v] = round_;
      samples_.push_back(vertices_[v]);
    }
  }
  if (samples_.size() > most_samples) {
    const std::size_t stride = (samples_.size() + most_samples - 1) / most_samples;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < samples_.size(); i += stride) samples_[kept++] = samples_[i];
    samples_.resize(kept);
  }
  // Triangles that reach over the rim of the change have corners that other faces answer for.
  std::erase_if(samples_, [&](Vec3 p) { return squared_distance(p) > squared_tolerance_; });
}

double LocalDeviation::of(std::span<const std::array<Vec3, 3>> faces, Proximity& original, std::uint32_t hint,
                          double enough) {
  set_faces(faces);
  if (faces_.empty()) return 0;
  double sum = 0;
  const auto add = [&](double squared) {
    const double relative = squared / squared_tolerance_;
    sum += relative * relative * relative;
  };
  double worst = 0;
  for (Vec3& p : samples_) {
    const double squared = squared_distance(p);
    add(squared);
    // Those that decide come first the next time.
    if (squared > worst) {
      worst = squared;
      std::swap(p, samples_.front());
    }
    if (sum >= enough) return sum;
  }
  const auto add_point = [&](Vec3 p) {
    const double distance = original.upper_distance({p.x, p.y, p.z}, hint);
    add(distance * distance);
    return sum < enough;
  };
  middles_.clear();
  for (const auto& c : faces) {
    if (!add_point((1.0 / 3) * (c[0] + c[1] + c[2]))) return sum;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 middle = 0.5 * (c[i] + c[(i + 1) % 3]);
      const auto same = [&](Vec3 p) { return p.x == middle.x && p.y == middle.y && p.z == middle.z; };
      if (std::none_of(middles_.begin(), middles_.end(), same)) {
        middles_.push_back(middle);  // of the rim, which stays, unless it comes again
      } else if (!add_point(middle)) {
        return sum;
      }
    }
  }
  return sum;
}

}  // namespace meshbound
