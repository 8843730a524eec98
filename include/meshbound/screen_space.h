// SPDX-License-Identifier: MIT
/// From what a viewer can see to how far a level of detail may be from its original.
///
///     tolerance = pixels * 2 * distance * tan(fov / 2) / screen_height
///
/// At depth `distance` a perspective view shows 2 * distance * tan(fov / 2) model units over the height of the screen,
/// so a length of `tolerance` parallel to the screen covers `pixels` of it there. `distance` is measured along the view
/// axis, to the nearest point of the model: what lies behind covers less. Away from the axis, by an angle a, a
/// displacement across the line of sight covers up to 1 / cos(a) times as many.
#pragma once
#include <span>
#include <vector>

#include "meshbound/error.h"

namespace meshbound {

/// What a view is drawn on, in the direction of its height.
struct Screen {
  double height_pixels = 1080;        ///< of the whole height
  double vertical_field_of_view = 1;  ///< the whole angle from the lower to the upper edge, radians, below pi
};

/// The tolerance, in the unit of `view_distance`, at which a deviation covers at most `pixels` when the model is seen
/// from there. Rounded to nearest. Throws `InvalidInput` unless all are positive and finite and the angle is below pi.
/// This and the functions below are pure, O(1) for each distance, and safe to call from several threads.
[[nodiscard]] double screen_space_tolerance(const Screen& screen, double pixels, double view_distance);

/// `screen_space_tolerance` for several distances, in their order.
[[nodiscard]] std::vector<double> screen_space_tolerances(const Screen& screen, double pixels,
                                                          std::span<const double> view_distances);

/// The inverse: the distance from which on a level of this tolerance may be shown. Throws as above; a tolerance of 0
/// may be shown from anywhere: 0.
[[nodiscard]] double min_view_distance(const Screen& screen, double pixels, double tolerance);

}  // namespace meshbound
