// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>

#include "deviation/measure_points.h"
#include "deviation/rounded_point.h"
#include "meshbound/deviation_map.h"
#include "meshbound/error.h"
#include "meshbound/mesh_summary.h"
#include "meshbound/transform.h"

namespace meshbound {
namespace {

/// Areas of the triangles in units of the squared diagonal, so that they neither overflow nor underflow for triangles
/// that count.
std::vector<double> relative_areas(const MeshView& mesh) {
  const double diagonal = bounding_box_diagonal(mesh);
  std::vector<double> areas(mesh.triangle_count(), 0.0);
  if (!(diagonal > 0)) return areas;
  for (std::size_t f = 0; f < areas.size(); ++f) {
    const Triangle t = mesh.triangle(f);
    const Eigen::Vector3d a = mesh.vertex(t[0]);
    const Eigen::Vector3d ab = (mesh.vertex(t[1]) - a) / diagonal, ac = (mesh.vertex(t[2]) - a) / diagonal;
    areas[f] = ab.cross(ac).norm() / 2;
  }
  return areas;
}

/// Point `i` of the R2 sequence, folded into the triangle of barycentric coordinates.
RoundedPoint point_inside(const MeshView& mesh, const Triangle& t, std::size_t i) {
  constexpr double plastic = 1.32471795724474602596;  // the real root of x^3 = x + 1
  const auto fraction = [&](double step) {
    const double x = 0.5 + static_cast<double>(i) * step;
    return x - std::floor(x);
  };
  double u = fraction(1 / plastic), v = fraction(1 / (plastic * plastic));
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  return rounded_point({mesh.vertex(t[0]), mesh.vertex(t[1]), mesh.vertex(t[2])}, u, v);
}

/// Points as doubles hold them, and how far each is from the surface at most.
struct Samples {
  std::vector<Eigen::Vector3d> points;
  std::vector<double> errors;

  void add(const RoundedPoint& point) {
    points.push_back(point.position);
    errors.push_back(point.error);
  }
};

/// `count` points at equal steps of area along the list of triangles; none if the mesh has no area.
Samples points_on(const MeshView& mesh, std::size_t count) {
  const std::vector<double> areas = relative_areas(mesh);
  double total = 0;
  for (const double area : areas) total += area;
  Samples samples;
  if (!(total > 0)) return samples;
  samples.points.reserve(count);
  samples.errors.reserve(count);
  double passed = 0;
  for (std::size_t f = 0; f < areas.size(); ++f) {
    passed += areas[f];
    const auto found = [&] { return samples.points.size(); };
    const auto wanted = [&] { return (static_cast<double>(found()) + 0.5) / static_cast<double>(count) * total; };
    while (found() < count && wanted() < passed) samples.add(point_inside(mesh, mesh.triangle(f), found()));
  }
  return samples;
}

/// Sums are taken of distances divided by the largest one, whose squares neither overflow nor underflow.
void fill_averages(std::vector<double> distances, DeviationStatistics& statistics) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  statistics.samples = distances.size();
  if (distances.empty()) {
    statistics.mean = statistics.root_mean_square = statistics.percentile_95 = statistics.largest_sample = unknown;
    return;
  }
  const double largest = *std::max_element(distances.begin(), distances.end());
  const double unit = largest > 0 ? largest : 1;
  double sum = 0, squares = 0;
  for (const double distance : distances) {
    const double share = distance / unit;
    sum += share;
    squares += share * share;
  }
  const auto count = static_cast<double>(distances.size());
  statistics.mean = unit * (sum / count);
  statistics.root_mean_square = unit * std::sqrt(squares / count);
  statistics.largest_sample = largest;
  const auto rank = distances.begin() + static_cast<std::ptrdiff_t>(std::ceil(0.95 * count)) - 1;
  std::nth_element(distances.begin(), rank, distances.end());
  statistics.percentile_95 = *rank;
}

void fill_histogram(const std::vector<double>& distances, std::size_t bins, DeviationStatistics& statistics) {
  statistics.histogram.assign(bins, 0);
  for (const double distance : distances) {
    if (distance > statistics.scale) {
      ++statistics.beyond_scale;
    } else {
      const double bin = std::ceil(distance / statistics.scale * static_cast<double>(bins)) - 1;
      ++statistics.histogram[std::min(bins - 1, static_cast<std::size_t>(std::max(0.0, bin)))];
    }
  }
}

}  // namespace

DeviationStatistics deviation_statistics(const MeshView& mesh, const Bvh& other, const DeviationSampling& sampling,
                                         const DeviationOptions& options) {
  validate(mesh);
  if (sampling.samples == 0 || sampling.bins == 0 || !(sampling.scale > 0) || !std::isfinite(sampling.scale))
    throw InvalidInput("statistics of deviations need at least one sample and one bin, and a scale of more than 0");
  if (!(sampling.max_distance >= 0)) throw InvalidInput("the largest distance of a deviation is at least 0");
  const Samples samples = points_on(mesh, sampling.samples);
  std::vector<double> distances(samples.points.size());
  measure_points(samples.points, other, options, [&](std::size_t i, const ClosestPoint& found) {
    const Bounds distance = widened(found.distance, samples.errors[i]);
    const bool is_beyond = distance.lower > sampling.scale;
    const double upper = std::min(distance.upper, sampling.max_distance);
    distances[i] = is_beyond ? upper : std::min(upper, sampling.scale);
  });
  DeviationStatistics statistics;
  statistics.scale = sampling.scale;
  fill_histogram(distances, sampling.bins, statistics);
  fill_averages(std::move(distances), statistics);
  return statistics;
}

}  // namespace meshbound
