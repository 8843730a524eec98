// SPDX-License-Identifier: MIT
#include "meshbound/screen_space.h"

#include <cmath>
#include <numbers>

#include "meshbound/error.h"

namespace meshbound {
namespace {

bool is_positive(double x) { return std::isfinite(x) && x > 0; }

/// Model units that a pixel covers at distance 1.
double pixel_size(const Screen& screen, double pixels) {
  if (!is_positive(pixels)) throw InvalidInput("the number of pixels must be positive");
  if (!is_positive(screen.height_pixels)) throw InvalidInput("the height of the screen must be a positive number");
  const double angle = screen.vertical_field_of_view;
  if (!is_positive(angle) || angle >= std::numbers::pi)
    throw InvalidInput("the vertical field of view must lie between 0 and 180 degrees");
  return pixels * 2 * std::tan(angle / 2) / screen.height_pixels;
}

}  // namespace

double screen_space_tolerance(const Screen& screen, double pixels, double view_distance) {
  const double size = pixel_size(screen, pixels);
  if (!is_positive(view_distance)) throw InvalidInput("a view distance must be a positive length");
  const double tolerance = size * view_distance;
  if (!std::isfinite(tolerance)) throw InvalidInput("a view distance is too large for doubles");
  return tolerance;
}

std::vector<double> screen_space_tolerances(const Screen& screen, double pixels,
                                            std::span<const double> view_distances) {
  std::vector<double> tolerances;
  for (const double distance : view_distances) tolerances.push_back(screen_space_tolerance(screen, pixels, distance));
  return tolerances;
}

double min_view_distance(const Screen& screen, double pixels, double tolerance) {
  const double size = pixel_size(screen, pixels);
  if (!(tolerance >= 0) || !std::isfinite(tolerance)) throw InvalidInput("the tolerance must be a length, 0 or more");
  return tolerance / size;
}

}  // namespace meshbound
